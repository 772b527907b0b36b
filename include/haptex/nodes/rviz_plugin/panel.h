// The panel haptex/Panel of rviz.
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <haptex/ClothQuality.h>
#include <rviz/panel.h>

#include <QStringList>
#include <functional>
#include <string>

#include "haptex/nodes/rviz_plugin/background_subscriptions.h"
#include "haptex/nodes/rviz_plugin/service_calls.h"
#include "haptex/nodes/rviz_plugin/system_status.h"

class QComboBox;
class QDoubleSpinBox;
class QGroupBox;
class QLabel;
class QLayout;
class QLineEdit;
class QPushButton;
class QTimer;
class QVBoxLayout;

namespace haptex::nodes {

class ArrayView;
class EvaluationBox;
class ForceHistory;

/// Says why there is no force, or that all is well, shows figures, forces and arrays, and calls the
/// services of the nodes in rviz's namespace. Neither the master nor a service is waited for.
class Panel : public rviz::Panel {
 public:
  explicit Panel(QWidget* parent = nullptr);
  ~Panel() override;

 protected:
  void onInitialize() override;

 private:
  QGroupBox* addBox(const QString& title);
  /// @returns the button, which calls the service of the type
  template <typename Service>
  QPushButton* addAction(QLayout* layout, const QString& text, const std::string& service,
                         std::function<void(typename Service::Request&)> fill = {});
  template <typename Service>
  void call(const std::string& service, const typename Service::Request& request);

  void addStatus();
  void addEvaluation();
  void addDevice();
  void addCloth();
  void addFabric();
  void addQuality();
  void addRecording();
  void addArrays();

  void subscribe();
  void receive(const diagnostic_msgs::DiagnosticArray& diagnostics, const std::string& sender);
  void receive(const haptex::ClothQuality& quality);
  void refresh();
  void showStatus();
  void showAnswers();

  QVBoxLayout* layout_;
  QLabel* line_;
  QLabel* figures_;
  QLabel* answer_;
  QComboBox* fabric_;
  QComboBox* surface_;
  QComboBox* quality_;
  QDoubleSpinBox* budget_;
  QLabel* error_;
  QLineEdit* recording_;
  ForceHistory* history_;
  ArrayView* arrays_;
  EvaluationBox* evaluation_;
  QTimer* timer_;

  SystemStatus status_;
  ServiceCalls calls_;
  BackgroundSubscriptions subscriptions_;  // last: its callbacks use the members above
};

}  // namespace haptex::nodes
