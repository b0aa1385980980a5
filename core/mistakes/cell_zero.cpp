#include "core/mistakes/cell_zero.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/mistakes/spring_fit.h"
#include "core/numerics/distributions.h"
#include "core/preparation/finding.h"
#include "core/robot/kinematics.h"
#include "metrology/rigid_motion.h"

namespace stiffscope::mistakes {

namespace {

constexpr int kConstant = 6, kLine = 6, kWeight = 4, kAll = kConstant + kLine + kWeight;

using Design = Eigen::Matrix<double, 6, kAll>;

struct Row {
  Design design = Design::Zero();  ///< in parts of the noise
  Vector6d shown;                  ///< likewise
};

/// Sum of squares with the constant, and the other parts where they are taken.
class Fit {
 public:
  Fit(const std::vector<Row>& rows, bool line, bool weight) {
    std::vector<int> taken;
    for (int k = 0; k < kAll; ++k) {
      const bool of_line = k >= kConstant && k < kConstant + kLine, of_weight = k >= kConstant + kLine;
      if ((!of_line || line) && (!of_weight || weight)) taken.push_back(k);
    }
    const auto count = static_cast<Eigen::Index>(taken.size());
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(count, count);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
    for (const Row& row : rows) {
      Eigen::MatrixXd design(6, count);
      for (Eigen::Index k = 0; k < count; ++k) design.col(k) = row.design.col(taken[static_cast<std::size_t>(k)]);
      normal += design.transpose() * design;
      right += design.transpose() * row.shown;
    }
    // Postures that turn the cell little do not tell a weight from the constant.
    constexpr double kRidge = 1e-9;
    normal.diagonal() *= 1.0 + kRidge;
    const Eigen::VectorXd solution = normal.ldlt().solve(right);
    for (Eigen::Index k = 0; k < count; ++k) found_[taken[static_cast<std::size_t>(k)]] = solution[k];
    for (const Row& row : rows) chi2_ += (row.shown - row.design * found_).squaredNorm();
  }

  double chi2() const { return chi2_; }
  const Eigen::Matrix<double, kAll, 1>& found() const { return found_; }

 private:
  Eigen::Matrix<double, kAll, 1> found_ = Eigen::Matrix<double, kAll, 1>::Zero();
  double chi2_ = 0.0;
};

}  // namespace

Eigen::Vector3d gravityInCell(const campaign::Campaign& campaign, const robot::Robot& robot,
                              const Eigen::Vector3d& gravity_in_base, const JointVector& q) {
  const CellReading declared = asDeclared(*campaign.load_cell);
  const robot::ArmPosture posture = robot::postureAt(robot, q);
  const std::string& link = declared.axes_link ? *declared.axes_link : declared.parent;
  Eigen::Matrix3d axes = robot::flangeAt(robot, posture).linear();
  for (const robot::LinkFrame& frame : robot.links) {
    if (frame.name == link)
      axes = posture.motion[static_cast<std::size_t>(frame.body)].linear() * frame.base_from_link_at_zero.linear();
  }
  if (!declared.axes_link) axes = axes * declared.parent_from_cell.linear();
  return axes.transpose() * gravity_in_base;
}

CellZero cellZero(const campaign::Campaign& campaign) {
  CellZero zero;
  const campaign::LoadCell& cell = *campaign.load_cell;
  if (cell.force_sigma <= 0.0 || cell.moment_sigma <= 0.0) return zero;
  Vector6d sigma;
  sigma << Eigen::Vector3d::Constant(cell.force_sigma), Eigen::Vector3d::Constant(cell.moment_sigma);
  std::vector<const campaign::State*> unloaded;
  for (const campaign::State& state : campaign.states->rows) {
    if (state.step == 0) unloaded.push_back(&state);
  }
  if (unloaded.size() < 2) return zero;
  const auto [first, last] = std::minmax_element(unloaded.begin(), unloaded.end(),
                                                 [](const auto* a, const auto* b) { return a->time_s < b->time_s; });
  const bool timed =
      std::all_of(unloaded.begin(), unloaded.end(), [](const auto* one) { return std::isfinite(one->time_s); }) &&
      (*last)->time_s > (*first)->time_s;
  const double span = timed ? (*last)->time_s - (*first)->time_s : 0.0;  // s
  std::vector<Row> rows(unloaded.size());
  double forces = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const campaign::State& state = *unloaded[i];
    Design& design = rows[i].design;
    design.leftCols<kConstant>().setIdentity();
    if (timed) design.middleCols<kLine>(kConstant).diagonal().setConstant((state.time_s - (*first)->time_s) / span);
    const Eigen::Vector3d gravity = gravityInCell(campaign, campaign.robot, campaign.gravity_in_base, state.q);
    design.block<3, 1>(0, kConstant + kLine) = gravity;
    design.block<3, 3>(3, kConstant + kLine + 1) = -metrology::crossMatrix(gravity);
    design = sigma.cwiseInverse().asDiagonal() * design;
    rows[i].shown = state.wrench_in_cell.cwiseQuotient(sigma);
    forces += state.wrench_in_cell.head<3>().squaredNorm();
  }
  const int readings = static_cast<int>(rows.size());
  zero.chi2 = Fit(rows, false, false).chi2();
  zero.dof = zero.chi2 > 0.0 ? 6 * (readings - 1) : 0;
  zero.before = zero.after = zero.dof > 0 ? std::sqrt(zero.chi2 / zero.dof) : 0.0;
  constexpr int kEnough = 8;
  constexpr double kScatters = 2.0;
  if (readings < kEnough || zero.before <= kScatters) return zero;

  const Fit both(rows, timed, true);
  const double scale = std::max(1.0, both.chi2() / (6 * readings - kAll));
  const auto standsOut = [&](double without, int unknowns) {
    const double explained = without - both.chi2();
    return explained > scale * numerics::chiSquareLimit(preparation::kLevel, unknowns) && explained > both.chi2();
  };
  zero.drifts = timed && standsOut(Fit(rows, false, true).chi2(), kLine);
  zero.weighs = standsOut(Fit(rows, timed, false).chi2(), kWeight);
  if (!zero.drifts && !zero.weighs) return zero;
  const Fit fit(rows, zero.drifts, zero.weighs);
  zero.chi2 = fit.chi2();
  zero.dof = 6 * (readings - 1) - (zero.drifts ? kLine : 0) - (zero.weighs ? kWeight : 0);
  zero.after = std::sqrt(zero.chi2 / zero.dof);
  zero.drift_force = fit.found().segment<3>(kConstant).norm();
  zero.drift_moment = fit.found().segment<3>(kConstant + 3).norm();
  constexpr double kHour = 3600.0;
  zero.hours = span / kHour;
  zero.mass = fit.found()[kConstant + kLine];
  double left = 0.0;
  for (const Row& row : rows) {
    const Vector6d rest = row.shown - row.design * fit.found();
    left += cell.force_sigma * cell.force_sigma * rest.head<3>().squaredNorm();
  }
  zero.force = std::sqrt(forces / readings);
  zero.force_left = std::sqrt(left / readings);
  return zero;
}

}  // namespace stiffscope::mistakes
