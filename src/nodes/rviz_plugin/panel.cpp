#include "haptex/nodes/rviz_plugin/panel.h"

#include <geometry_msgs/WrenchStamped.h>
#include <haptex/AnswerTrial.h>
#include <haptex/Contact.h>
#include <haptex/EvaluationTrial.h>
#include <haptex/OperatingState.h>
#include <haptex/SetFabric.h>
#include <haptex/SetQuality.h>
#include <haptex/SetSurface.h>
#include <haptex/StartRecording.h>
#include <haptex/StepCloth.h>
#include <haptex/Tactile.h>
#include <ros/package.h>
#include <ros/this_node.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <QComboBox>
#include <QDir>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QGroupBox>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QScrollArea>
#include <QTimer>
#include <QVBoxLayout>
#include <cmath>

#include "haptex/nodes/rviz_plugin/array_view.h"
#include "haptex/nodes/rviz_plugin/evaluation_box.h"
#include "haptex/nodes/rviz_plugin/force_history.h"
#include "haptex/nodes/rviz_plugin/panel_texts.h"
#include "haptex/realtime/steady_clock.h"

namespace haptex::nodes {
namespace {

using base::Finger;
using base::kFingers;
using std_srvs::SetBool;
using std_srvs::Trigger;

constexpr int kPeriod = 100;            // ms, of what is shown
constexpr int kScrollBar = 20;          // pixels
constexpr double kMostBudget = 1000.0;  // ms
const char* const kByBudget = "as the budget allows";

QStringList fabricNames() {
  // Once: it looks into all directories of the workspace.
  static const std::string package = ros::package::getPath("haptex");
  const QDir directory(QString::fromStdString(package) + "/config/fabrics");
  QStringList names;
  for (const QString& file : directory.entryList({"*.yaml"}, QDir::Files, QDir::Name)) {
    names << file.left(file.size() - 5);
  }
  return names;
}

/// A list of fabrics; a path can be typed.
QComboBox* makeFabricBox(const QString& nothing_chosen) {
  auto* box = new QComboBox;
  box->setEditable(true);
  box->setInsertPolicy(QComboBox::NoInsert);
  box->addItems(fabricNames());
  box->setCurrentIndex(-1);
  box->lineEdit()->setPlaceholderText(nothing_chosen);
  box->setToolTip("A fabric of the package, or the path of a fabric file");
  return box;
}

double normOf(const geometry_msgs::Vector3& vector) {
  return std::hypot(vector.x, std::hypot(vector.y, vector.z));
}

/// Texts come from other processes.
QString shortened(const std::string& text) {
  return QString::fromStdString(text.size() > 600 ? text.substr(0, 600) + " ..." : text);
}

}  // namespace

Panel::Panel(QWidget* parent)
    : rviz::Panel(parent),
      line_(new QLabel),
      figures_(new QLabel),
      answer_(new QLabel),
      history_(new ForceHistory),
      arrays_(new ArrayView),
      timer_(new QTimer(this)) {
  auto* inside = new QWidget;
  layout_ = new QVBoxLayout(inside);
  layout_->setContentsMargins(4, 4, 4, 4);
  addStatus();
  addEvaluation();
  addDevice();
  addCloth();
  addFabric();
  addQuality();
  addRecording();
  addArrays();
  layout_->addStretch();
  auto* scroll = new QScrollArea;
  scroll->setWidgetResizable(true);
  scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  scroll->setWidget(inside);
  scroll->setMinimumWidth(inside->minimumSizeHint().width() + kScrollBar);
  auto* outside = new QVBoxLayout(this);
  outside->setContentsMargins(0, 0, 0, 0);
  outside->addWidget(scroll);
  connect(timer_, &QTimer::timeout, this, [this] { refresh(); });
}

Panel::~Panel() { subscriptions_.end(); }

void Panel::onInitialize() {
  subscribe();
  timer_->start(kPeriod);
}

QGroupBox* Panel::addBox(const QString& title) {
  auto* box = new QGroupBox(title);
  layout_->addWidget(box);
  return box;
}

template <typename Service>
void Panel::call(const std::string& service, const typename Service::Request& request) {
  const bool begun = calls_.call<Service>(service, request);
  answer_->setText(QString::fromStdString(
      service + (begun ? " ..." : ": the call before has not been answered yet")));
}

template <typename Service>
QPushButton* Panel::addAction(QLayout* layout, const QString& text, const std::string& service,
                              std::function<void(typename Service::Request&)> fill) {
  auto* button = new QPushButton(text);
  button->setToolTip(QString::fromStdString("Calls " + service));
  layout->addWidget(button);
  connect(button, &QPushButton::clicked, this, [this, service, fill = std::move(fill)] {
    typename Service::Request request;
    if (fill) fill(request);
    call<Service>(service, request);
  });
  return button;
}

void Panel::addStatus() {
  for (QLabel* label : {line_, figures_, answer_}) {
    label->setWordWrap(true);
    label->setTextFormat(Qt::PlainText);
    label->setTextInteractionFlags(Qt::TextSelectableByMouse);
  }
  line_->setMargin(6);
  line_->setObjectName("line");
  answer_->setObjectName("answer");
  figures_->setFont(QFont("Monospace", 8));
  layout_->addWidget(line_);
  layout_->addWidget(answer_);
  layout_->addWidget(history_);
  layout_->addWidget(figures_);
}

void Panel::addEvaluation() {
  evaluation_ = new EvaluationBox(
      [this](std::uint32_t trial, double rating) {
        AnswerTrial::Request request;
        request.trial = trial;
        request.rating = rating;
        call<AnswerTrial>("evaluation/answer", request);
      },
      [this] { call<Trigger>("evaluation/next", {}); });
  layout_->addWidget(evaluation_);
}

void Panel::addDevice() {
  auto* rows = new QVBoxLayout(addBox("Device and hand"));
  auto* device = new QHBoxLayout;
  auto* more = new QHBoxLayout;
  rows->addLayout(device);
  rows->addLayout(more);
  addAction<Trigger>(device, "Enable", "exoskeleton/enable");
  addAction<Trigger>(device, "Disable", "exoskeleton/disable");
  addAction<Trigger>(device, "Home", "exoskeleton/home");
  addAction<Trigger>(more, "Clear fault", "exoskeleton/clear_fault");
  addAction<SetBool>(more, "Grasp", "emulator/grasp",
                     [](SetBool::Request& request) { request.data = true; });
  addAction<SetBool>(more, "Let go", "emulator/grasp",
                     [](SetBool::Request& request) { request.data = false; });
}

void Panel::addCloth() {
  auto* row = new QHBoxLayout(addBox("Simulation"));
  addAction<SetBool>(row, "Pause", "cloth/pause",
                     [](SetBool::Request& request) { request.data = true; });
  addAction<StepCloth>(row, "Step", "cloth/step",
                       [](StepCloth::Request& request) { request.steps = 1; });
  addAction<SetBool>(row, "Run", "cloth/pause",
                     [](SetBool::Request& request) { request.data = false; });
  addAction<Trigger>(row, "Reset", "cloth/reset");
}

void Panel::addFabric() {
  auto* form = new QFormLayout(addBox("Fabric"));
  fabric_ = makeFabricBox("choose a fabric");
  surface_ = makeFabricBox("that of the fabric");
  form->addRow("all of it", fabric_);
  form->addRow("surface", surface_);
  connect(fabric_, QOverload<int>::of(&QComboBox::activated), this, [this] {
    SetFabric::Request request;
    request.fabric = fabric_->currentText().toStdString();
    call<SetFabric>("cloth/set_fabric", request);
  });
  connect(surface_, QOverload<int>::of(&QComboBox::activated), this, [this] {
    SetSurface::Request request;
    request.fabric = surface_->currentText().toStdString();
    call<SetSurface>("tactile/set_surface", request);
  });
}

void Panel::addQuality() {
  auto* form = new QFormLayout(addBox("Quality"));
  quality_ = new QComboBox;
  quality_->addItem(kByBudget);
  budget_ = new QDoubleSpinBox;
  budget_->setRange(0.0, kMostBudget);
  budget_->setSuffix(" ms a step");
  budget_->setSpecialValueText("none");
  auto* button = new QPushButton("Set");
  button->setToolTip("Calls cloth/set_quality");
  auto* row = new QHBoxLayout;
  row->addWidget(budget_, 1);
  row->addWidget(button);
  error_ = new QLabel("no quality is told: the scene's own settings run");
  error_->setWordWrap(true);
  error_->setTextFormat(Qt::PlainText);
  form->addRow("quality", quality_);
  form->addRow("budget", row);
  form->addRow(error_);
  connect(button, &QPushButton::clicked, this, [this] {
    SetQuality::Request request;
    if (quality_->currentIndex() > 0) request.quality = quality_->currentText().toStdString();
    request.budget_ms = budget_->value();
    call<SetQuality>("cloth/set_quality", request);
  });
}

void Panel::addRecording() {
  auto* row = new QHBoxLayout(addBox("Bag"));
  recording_ = new QLineEdit;
  recording_->setPlaceholderText("name");
  row->addWidget(recording_, 1);
  addAction<StartRecording>(row, "Record", "recording/start",
                            [this](StartRecording::Request& request) {
                              request.name = recording_->text().toStdString();
                            });
  addAction<Trigger>(row, "Stop", "recording/stop");
}

void Panel::addArrays() {
  auto* row = new QHBoxLayout(addBox("Tactile arrays, 40 and 320 Hz"));
  row->addWidget(arrays_);
}

void Panel::subscribe() {
  subscriptions_.addEvents<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", 50,
      [this](const ros::MessageEvent<const diagnostic_msgs::DiagnosticArray>& event) {
        receive(*event.getConstMessage(), event.getPublisherName());
      });
  subscriptions_.add<OperatingState>(
      "exoskeleton/operating_state", 1, [this](const OperatingStateConstPtr& message) {
        status_.hear(DeviceState{message->state, message->is_homed != 0, message->is_busy != 0,
                                 message->fault.substr(0, 400)},
                     realtime::steadyNow());
      });
  subscriptions_.add<ClothQuality>(
      "cloth/quality", 1, [this](const ClothQualityConstPtr& message) { receive(*message); });
  subscriptions_.add<EvaluationTrial>(
      "evaluation/trial", 1,
      [this](const EvaluationTrialConstPtr& message) { evaluation_->show(*message); });
  for (const Finger finger : kFingers) {
    const std::string name = base::name(finger);
    subscriptions_.add<Contact>(name + "/contact", 1,
                                [this, finger](const ContactConstPtr& message) {
                                  history_->setComputed(finger, normOf(message->force));
                                });
    subscriptions_.add<geometry_msgs::WrenchStamped>(
        name + "/measured_cf", 1,
        [this, finger](const geometry_msgs::WrenchStampedConstPtr& message) {
          history_->setMeasured(finger, normOf(message->wrench.force));
        });
    subscriptions_.add<Tactile>(
        name + "/tactile", 1,
        [this, finger](const TactileConstPtr& message) { arrays_->show(finger, *message); });
  }
  subscriptions_.begin();
}

void Panel::receive(const diagnostic_msgs::DiagnosticArray& diagnostics,
                    const std::string& sender) {
  const base::Time now = realtime::steadyNow();
  const double stamp = diagnostics.header.stamp.toSec();
  for (const diagnostic_msgs::DiagnosticStatus& status : diagnostics.status) {
    const std::string name = statusOfNamespace(status.name, ros::this_node::getNamespace());
    if (!name.empty()) status_.hear(name, diagnosisOf(status, stamp, sender), now);
  }
}

void Panel::receive(const haptex::ClothQuality& quality) {
  error_->setText(shortened(qualityText(quality)));
  QStringList names{kByBudget};
  for (const std::string& name : quality.qualities) names << shortened(name);
  QStringList shown;
  for (int i = 0; i < quality_->count(); ++i) shown << quality_->itemText(i);
  if (names == shown) return;
  quality_->clear();
  quality_->addItems(names);
  budget_->setValue(std::isfinite(quality.budget_ms) ? quality.budget_ms : 0.0);
}

void Panel::refresh() {
  subscriptions_.callAvailable();
  if (!isVisible()) return;
  history_->add(realtime::steadyNow());
  showStatus();
  showAnswers();
}

void Panel::showStatus() {
  const base::Time now = realtime::steadyNow();
  const StatusLine line = status_.line(now);
  const char* colour = line.mood == StatusLine::Mood::kWell        ? "#d8f0d8"
                       : line.mood == StatusLine::Mood::kAttention ? "#fdf0c8"
                                                                   : "#f8d4d0";
  const QString style = QString("background: %1; color: black;").arg(colour);
  if (line_->styleSheet() != style) line_->setStyleSheet(style);
  line_->setText(shortened(line.text));
  QString figures;
  for (const Figure& figure : status_.figures(now)) {
    if (!figures.isEmpty()) figures += "\n";
    figures += QString::fromStdString(figure.name + ": " + figure.value);
  }
  figures_->setText(figures);
}

void Panel::showAnswers() {
  for (const Answer& answer : calls_.answers()) {
    answer_->setText(
        shortened((answer.success ? "" : "Refused, ") + answer.service + ": " + answer.message));
    answer_->setStyleSheet(answer.success ? "" : "color: #a01010;");
  }
  const std::string waiting = calls_.waiting();
  if (!waiting.empty()) answer_->setText(shortened(waiting));
}

}  // namespace haptex::nodes
