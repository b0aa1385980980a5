#include "core/comparison/change_causes.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "metrology/linear_algebra.h"
#include "metrology/tail_probability.h"

namespace stiffscope::comparison {

namespace {

/// Fits one cause after the other to one change, in parts of its covariance.
class Fitting {
 public:
  explicit Fitting(const FoundChange& found) : found_(found), lower_(choleskyLower(found.covariance)) {
    white_ = lower_.triangularView<Eigen::Lower>().solve(found.change);
  }

  /// `by`: the change by each unknown of the cause. Directions of it that the days do not see are no unknowns.
  CauseEvidence fit(ChangeCause cause, int axis, const Eigen::MatrixXd& by, const Eigen::MatrixXd* moves) const {
    CauseEvidence evidence{.cause = cause, .axis = axis};
    Eigen::MatrixXd columns = lower_.triangularView<Eigen::Lower>().solve(by);
    const Eigen::VectorXd lengths = columns.colwise().norm();
    for (Eigen::Index k = 0; k < columns.cols(); ++k) columns.col(k) /= std::max(1e-300, lengths[k]);
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
    constexpr double kSeen = 1e-5;
    qr.setThreshold(kSeen);
    qr.compute(columns);
    evidence.unknowns = static_cast<int>(qr.rank());
    const Eigen::VectorXd sizes = qr.solve(white_);
    const Eigen::VectorXd explained = columns * sizes;
    const double left = (white_ - explained).squaredNorm();
    evidence.chi2 = explained.squaredNorm();
    const int free = static_cast<int>(white_.size()) - evidence.unknowns;
    evidence.left_p = free > 0 ? metrology::fTail(left / free, free, found_.dof) : 1.0;
    evidence.bic = left + evidence.unknowns * std::log(found_.postures);
    if (by.cols() == 1) evidence.size = Uncertain{sizes[0] / lengths[0], 1.0 / lengths[0], found_.dof};
    if (moves != nullptr) {
      const Eigen::VectorXd change = lower_.triangularView<Eigen::Lower>() * explained;
      evidence.at_targets = std::sqrt(std::max(0.0, change.dot(*moves * change)));
    }
    return evidence;
  }

 private:
  const FoundChange& found_;
  Eigen::MatrixXd lower_;
  Eigen::VectorXd white_;
};

void sortByBic(std::vector<CauseEvidence>& causes) {
  std::stable_sort(causes.begin(), causes.end(),
                   [](const CauseEvidence& a, const CauseEvidence& b) { return a.bic < b.bic; });
}

}  // namespace

std::vector<CauseEvidence> causesOfMachine(const GeometryNumbers& numbers, const robot::Robot& arm,
                                           const std::vector<Eigen::Index>& seen, const FoundChange& found,
                                           const Eigen::MatrixXd& moves) {
  const Fitting fitting(found);
  std::vector<CauseEvidence> causes;
  const robot::ArmAxes& axes = arm.axes_in_base_at_zero;
  for (const Eigen::Index at : seen) {
    const GeometryNumber& number = numbers.machine()[static_cast<std::size_t>(at)];
    if (number.kind != NumberKind::joint_zero) continue;
    // Of axes that are one line, whose zeros are one number, the one that has a joint of its own.
    const int before = numbers.oneLineWith(number.axis);
    const int own = axes.jointOf(number.axis - 1) < 0 && before > 0 ? before : number.axis;
    const int joint = axes.jointOf(own - 1);
    if (joint < 0) continue;  // rods by themselves: that link
    CauseEvidence evidence = fitting.fit(ChangeCause::joint_zero, own, numbers.byJoint(arm, joint)(seen), &moves);
    evidence.joint = joint + 1;
    evidence.same_line = own == number.axis ? before : number.axis;
    causes.push_back(evidence);
  }
  const int last = arm.axes() - 1;
  for (int axis = 1; axis <= last; ++axis)
    causes.push_back(fitting.fit(ChangeCause::link, axis, numbers.byLink(arm, axis)(seen, Eigen::all), &moves));
  // Axis 1 alone is a bent link 1 with another base, the last axis alone a bent link before it with other reflectors.
  for (int axis = 2; axis <= last; ++axis)
    causes.push_back(fitting.fit(ChangeCause::axis, axis, numbers.byAxis(arm, axis)(seen, Eigen::all), &moves));
  causes.push_back(fitting.fit(ChangeCause::growth, 0, numbers.byGrowth(arm)(seen), &moves));
  sortByBic(causes);
  return causes;
}

std::vector<CauseEvidence> causesOfReflectors(const Eigen::VectorXd& by_turn, const robot::ArmAxes& axes,
                                              const FoundChange& found) {
  const Fitting fitting(found);
  const Eigen::Index size = found.change.size();
  const auto last_axis = static_cast<int>(axes.size());
  std::vector<CauseEvidence> causes{
      fitting.fit(ChangeCause::turn_about_last, last_axis, by_turn, nullptr),
      fitting.fit(ChangeCause::reflectors, 0, Eigen::MatrixXd::Identity(size, size), nullptr)};
  causes.front().joint = axes.jointOf(last_axis - 1) + 1;
  sortByBic(causes);
  return causes;
}

}  // namespace stiffscope::comparison
