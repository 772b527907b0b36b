#include "haptex/nodes/rviz_plugin/evaluation_box.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSlider>
#include <QVBoxLayout>
#include <cmath>
#include <utility>

namespace haptex::nodes {
namespace {

constexpr int kPositions = 100;  // of the slider

}  // namespace

EvaluationBox::EvaluationBox(std::function<void(std::uint32_t, double)> answer,
                             std::function<void()> next, QWidget* parent)
    : QGroupBox("Evaluation", parent),
      instruction_(new QLabel(this)),
      words_(new QLabel(this)),
      chosen_(new QLabel(this)),
      slider_(new QSlider(Qt::Horizontal, this)),
      answer_(new QPushButton("Answer", this)),
      next_(new QPushButton("Next", this)) {
  instruction_->setWordWrap(true);
  instruction_->setTextFormat(Qt::PlainText);
  words_->setTextFormat(Qt::PlainText);
  slider_->setRange(0, kPositions);
  slider_->setValue(kPositions / 2);
  auto* buttons = new QHBoxLayout;
  buttons->addWidget(chosen_, 1);
  buttons->addWidget(answer_);
  buttons->addWidget(next_);
  auto* layout = new QVBoxLayout(this);
  layout->addWidget(instruction_);
  layout->addWidget(words_);
  layout->addWidget(slider_);
  layout->addLayout(buttons);
  connect(slider_, &QSlider::valueChanged, this, [this] { showRating(); });
  connect(answer_, &QPushButton::clicked, this,
          [this, answer = std::move(answer)] { answer(trial_.trial, rating()); });
  connect(next_, &QPushButton::clicked, this, [next = std::move(next)] { next(); });
  hide();
}

double EvaluationBox::rating() const {
  const double share = static_cast<double>(slider_->value()) / kPositions;
  return trial_.least_rating + share * (trial_.largest_rating - trial_.least_rating);
}

void EvaluationBox::showRating() { chosen_->setText(QString::number(rating(), 'g', 3)); }

void EvaluationBox::show(const haptex::EvaluationTrial& trial) {
  const bool is_new = trial.trial != trial_.trial;
  trial_ = trial;
  const bool awaited = trial.trial != 0;
  if (is_new) slider_->setValue(kPositions / 2);
  QString text = QString::fromStdString(trial.instruction);
  if (awaited) text = QString("%1 of %2: ").arg(trial.trial).arg(trial.trials) + text;
  if (trial.seconds_left > 0.0) text += QString(" (%1 s left)").arg(std::ceil(trial.seconds_left));
  instruction_->setText(text);
  words_->setText(QString("%1: %2    %3: %4")
                      .arg(trial.least_rating)
                      .arg(QString::fromStdString(trial.low_word))
                      .arg(trial.largest_rating)
                      .arg(QString::fromStdString(trial.high_word)));
  for (QWidget* widget : {static_cast<QWidget*>(words_), static_cast<QWidget*>(slider_),
                          static_cast<QWidget*>(answer_), static_cast<QWidget*>(chosen_)}) {
    widget->setVisible(awaited);
  }
  next_->setVisible(!awaited && trial.state != "END");
  showRating();
  setVisible(true);
}

}  // namespace haptex::nodes
