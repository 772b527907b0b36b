// The question of an evaluation and the scale to answer it.
#pragma once

#include <haptex/EvaluationTrial.h>

#include <QGroupBox>
#include <functional>

class QLabel;
class QPushButton;
class QSlider;

namespace haptex::nodes {

/// Hidden until a trial is shown. By Qt's thread.
class EvaluationBox : public QGroupBox {
 public:
  /// @param answer called with the number of the trial and the rating
  /// @param next   called when the person has had enough of a standard
  EvaluationBox(std::function<void(std::uint32_t, double)> answer, std::function<void()> next,
                QWidget* parent = nullptr);

  void show(const haptex::EvaluationTrial& trial);

 private:
  double rating() const;
  void showRating();

  haptex::EvaluationTrial trial_;
  QLabel* instruction_;
  QLabel* words_;
  QLabel* chosen_;
  QSlider* slider_;
  QPushButton* answer_;
  QPushButton* next_;
};

}  // namespace haptex::nodes
