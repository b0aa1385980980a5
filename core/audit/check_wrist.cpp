#include "core/audit/redundancies.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/audit/checks.h"
#include "core/audit/remarks.h"
#include "core/audit/sag_doubt.h"
#include "core/campaign/row_names.h"
#include "core/frames/arm_parameters.h"
#include "core/identification/decoupled_partial_pose.h"
#include "core/identification/method_solution.h"
#include "core/numerics/distributions.h"
#include "core/preparation/finding.h"
#include "core/preparation/remarks.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::audit {

namespace {

constexpr Eigen::Index kCentre = 3;

/// One reading: radial distance less the model's, its derivatives, its standard deviation. The derivative by its
/// reflector's radius is 1, by the others' 0.
struct Row {
  double residual = 0.0, sd = 0.0;
  int target = 0;
  Eigen::RowVector3d by_centre;
  Eigen::RowVectorXd by_axes;  ///< four an axis of the wrist

  Eigen::RowVectorXd jacobian(Eigen::Index targets) const {
    Eigen::RowVectorXd all = Eigen::RowVectorXd::Zero(kCentre + targets + by_axes.size());
    all.head<kCentre>() = by_centre;
    all[kCentre + target] = 1.0;
    all.tail(by_axes.size()) = by_axes;
    return all;
  }
};

std::vector<Row> rowsOf(const AuditInput& input) {
  const campaign::WristSweep& sweep = *input.campaign.wrist_sweep;
  const frames::Frames& frames = input.frames;
  const robot::Robot& arm = frames.arm.arm;
  const frames::WristCentre& wrist = frames.wrist;
  const frames::PlacedArm placed(frames::sweptAxes(frames, arm.axes_in_base_at_zero));
  const int carrying = arm.armAxes(), of_wrist = 4 * robot::wristJointsOf(arm.joints());
  std::vector<Row> rows;
  rows.reserve(sweep.rows.size());
  for (std::size_t i = 0; i < sweep.rows.size(); ++i) {
    const campaign::WristReading& reading = sweep.rows[i];
    const auto& at_zero = frames.targets_in_r0_at_zero[static_cast<std::size_t>(reading.target)];
    if (!at_zero) continue;
    const Eigen::Vector3d from_centre = frames.arm.r0_from_points * input.rigid.wrist_sweep[i] - wrist.centre_in_r0;
    const robot::ArmPosture posture = robot::postureAt(arm, reading.q);
    const Eigen::Vector3d centre = posture.motion[static_cast<std::size_t>(carrying)] * wrist.centre_at_zero_in_r0;
    const Eigen::Vector3d modelled = posture.motion.back() * *at_zero;
    const Eigen::Vector3d radial = from_centre.normalized();
    const Eigen::Vector3d seen = frames.arm.r0_from_points.linear().transpose() * radial;
    Row row;
    row.residual = from_centre.norm() - (modelled - centre).norm();
    row.sd = std::sqrt(seen.dot(input.noise->covarianceAt(reading.point, reading.from) * seen));
    row.target = reading.target;
    row.by_centre = radial.transpose();
    // The wrist's axes do not move the centre.
    row.by_axes = (modelled - centre).normalized().transpose() *
                  frames::PlacedPosture(placed, posture).byAxes(modelled).rightCols(of_wrist);
    rows.push_back(row);
  }
  return rows;
}

/// Normal matrix of the prior on the axes.
Eigen::MatrixXd priorOf(const frames::Frames& frames, Eigen::Index targets) {
  const int axes = frames.arm.arm.axes(), carrying = frames.arm.arm.armAxes();
  const Eigen::Index at = kCentre + targets, size = at + 4 * (axes - carrying);
  Eigen::MatrixXd prior = Eigen::MatrixXd::Zero(size, size);
  for (int j = carrying; j < axes; ++j) {
    const Eigen::Index place = at + 4 * (j - carrying);
    prior.block<4, 4>(place, place) = frames.axes[static_cast<std::size_t>(j)].at_zero.covariance.inverse();
  }
  return prior;
}

/// The wrist sweep's readings as one linear least squares in the centre, the radii and the wrist's axes.
class WristFit {
 public:
  explicit WristFit(const AuditInput& input)
      : targets_(static_cast<Eigen::Index>(input.campaign.targets.size())),
        rows_(rowsOf(input)),
        prior_(priorOf(input.frames, targets_)),
        normal_(prior_) {
    dof_ = static_cast<int>(rows_.size()) - static_cast<int>(kCentre);
    for (const Row& row : rows_) {
      const Eigen::RowVectorXd jacobian = row.jacobian(targets_);
      normal_ += jacobian.transpose() * jacobian / (row.sd * row.sd);
    }
    for (Eigen::Index k = 0; k < targets_; ++k) {
      // A reflector that was not swept has no radius to find.
      if (normal_(kCentre + k, kCentre + k) == 0.0) {
        normal_(kCentre + k, kCentre + k) = 1.0;
      } else {
        --dof_;
      }
    }
  }

  const std::vector<Row>& rows() const { return rows_; }
  int dof() const { return dof_; }

  /// What the fit leaves of the residuals of `rows`, which may be those under another sag, and of the axes by their own
  /// sweeps: one number a reading and four an axis, all in parts of their standard deviations.
  Eigen::VectorXd left(const std::vector<Row>& rows) const {
    Eigen::VectorXd right = Eigen::VectorXd::Zero(normal_.rows());
    for (std::size_t i = 0; i < rows_.size(); ++i)
      right += rows_[i].jacobian(targets_).transpose() * rows[i].residual / (rows_[i].sd * rows_[i].sd);
    const Eigen::VectorXd found = solveSymmetric(normal_, right);
    const auto readings = static_cast<Eigen::Index>(rows_.size());
    const Eigen::Index axes = normal_.rows() - kCentre - targets_;
    Eigen::VectorXd all(readings + axes);
    for (Eigen::Index i = 0; i < readings; ++i) {
      const Row& row = rows_[static_cast<std::size_t>(i)];
      all[i] = (rows[static_cast<std::size_t>(i)].residual - row.jacobian(targets_).dot(found)) / row.sd;
    }
    all.tail(axes) = choleskyLower(prior_.bottomRightCorner(axes, axes)).transpose() * found.tail(axes);
    return all;
  }

 private:
  Eigen::Index targets_;
  std::vector<Row> rows_;
  Eigen::MatrixXd prior_, normal_;
  int dof_ = 0;
};

/// What of chi2 a sag explains that is off by no more than it is uncertain.
double explainedInWrist(const AuditInput& input, const WristFit& fit, const Eigen::VectorXd& left) {
  std::vector<Eigen::VectorXd> moved;
  for (const AuditInput& other : underOtherSags(input)) {
    const std::vector<Row> rows = rowsOf(other);
    if (rows.size() == fit.rows().size()) moved.push_back(fit.left(rows));
  }
  return explainedBySag(left, moved);
}

}  // namespace

WristResiduals wristResiduals(const AuditInput& input) {
  const WristFit fit(input);
  const Eigen::VectorXd left = fit.left(fit.rows());
  WristResiduals result;
  result.dof = fit.dof();
  result.chi2 = left.squaredNorm();
  double farthest = -1.0;
  Eigen::Index at = 0;
  for (const campaign::WristReading& reading : input.campaign.wrist_sweep->rows) {
    if (!input.frames.targets_in_r0_at_zero[static_cast<std::size_t>(reading.target)]) continue;
    const double sigmas = std::abs(left[at]), off = sigmas * fit.rows()[static_cast<std::size_t>(at)].sd;
    ++at;
    result.rms += off * off;
    if (sigmas > farthest) farthest = sigmas, result.worst = reading.line;
  }
  result.rms = result.dof > 0 ? std::sqrt(result.rms / result.dof) : 0.0;
  // Asked only where noise alone does not do.
  if (result.dof > 0 && result.chi2 > numerics::chiSquareLimit(preparation::kLevel, result.dof))
    result.chi2 -= explainedInWrist(input, fit, left);
  return result;
}

namespace {

/// A remark that names the wrist's first and last joint after `its` other values.
template <class Id, class... Values>
Remark ofWrist(const AuditInput& input, Id id, Values... its) {
  const int joints = input.campaign.robot.joints();
  return Remark(id, its..., robot::armJointsOf(joints) + 1, joints);
}

preparation::AuditCheck sphereCheck(const AuditInput& input) {
  const WristResiduals left = wristResiduals(input);
  preparation::AuditCheck check;
  check.id = "wrist_sphere";
  if (left.dof <= 0) return preparation::notTestable(check.id, Remark(MissingId::few_wrist_readings));
  check.value = std::sqrt(left.chi2 / left.dof);
  check.limit = std::sqrt(numerics::chiSquareLimit(preparation::kLevel, left.dof) / left.dof);
  check.limit_source = preparation::byChance(ofWrist(input, LimitId::chi_square_held_axes, left.dof));
  const auto says = [&](std::vector<Remark> more) {
    return Remark(RemarkId::wrist_residuals, input.frames.wrist.spheres.rms, left.rms, *check.value, std::move(more));
  };
  check.message = says({});
  if (*check.value <= *check.limit) return check;
  check.verdict = preparation::AuditVerdict::warn;
  const std::string row = campaign::rowName(input.campaign.wrist_sweep->file, left.worst);
  check.where = Remark(preparation::RemarkId::at_name, row);
  check.message = says({Remark(RemarkId::wrist_reading_off, row)});
  return check;
}

/// Share of P_wrist's displacement that turning in the wrist's joints puts there; empty without loads, or where the
/// axes meet exactly.
std::optional<double> leakOf(const AuditInput& input) {
  identification::LoadedArm arm = input.arm;
  if (arm.wrist.empty()) return std::nullopt;
  const JointVector compliance = identification::sagCompliance(input.campaign, {}, arm);
  const double leak = identification::wristLeak(arm, input.frames.wrist.centre_at_zero_in_r0, compliance);
  return leak > 0.0 ? std::optional(leak) : std::nullopt;
}

preparation::AuditCheck missCheck(const AuditInput& input) {
  const frames::WristCentre& wrist = input.frames.wrist;
  const std::optional<double> leak = leakOf(input);
  preparation::AuditCheck check;
  check.id = "wrist_axes_meet";
  const frames::WristAxesMiss& worst = *std::max_element(
      wrist.misses.begin(), wrist.misses.end(),
      [](const frames::WristAxesMiss& a, const frames::WristAxesMiss& b) { return a.distance < b.distance; });
  check.value = worst.distance;
  const double bearable =
      leak ? *check.value * identification::kWristLeakBorne / *leak : identification::TrustLimits().position;
  check.limit = std::max(
      bearable, numerics::normalLimit(preparation::kLevel / static_cast<double>(wrist.misses.size())) * worst.sd);
  check.where = Remark(RemarkId::at_axes, worst.first + 1, worst.first + 2);
  check.limit_source = leak ? ofWrist(input, LimitId::leak_that_decoupling_bears) : Remark(LimitId::places_or_sweeps);
  std::vector<Remark> more;
  if (wrist.offset()) {
    check.value = wrist.apart;
    check.limit = frames::WristCentre::kOffsetWrist;
    check.limit_source = Remark(LimitId::centre_of_wrist);
    more.push_back(Remark(RemarkId::wrist_meets_apart, wrist.misses.front().first + 1, wrist.apart));
  }
  if (leak) more.push_back(ofWrist(input, RemarkId::wrist_leak, *leak));
  if (*check.value > *check.limit) {
    check.verdict = preparation::AuditVerdict::warn;
    more.push_back(Remark(RemarkId::decoupling_needs_one_point));
  }
  std::vector<double> figures;
  for (const frames::WristAxesMiss& miss : wrist.misses) figures.insert(figures.end(), {miss.distance, miss.sd});
  check.message =
      Remark(RemarkId::wrist_axes_miss, std::move(figures), std::move(more), wrist.misses.front().first + 1);
  return check;
}

}  // namespace

Findings checkWrist(const AuditInput& input) {
  const Remark not_swept = ofWrist(input, MissingId::wrist_axes_not_swept);
  const frames::WristCentre& wrist = input.frames.wrist;
  const auto& axes = input.frames.axes;
  const bool swept = std::all_of(axes.end() - robot::wristJointsOf(input.campaign.robot.joints()), axes.end(),
                                 [](const frames::MeasuredAxis& axis) { return axis.measured; });
  Findings findings;
  if (!wrist.measured) {
    findings.push_back(preparation::notTestable("wrist_sphere", wrist.reason));
  } else if (!swept) {
    findings.push_back(preparation::notTestable("wrist_sphere", not_swept));
  } else if (!input.noise) {
    findings.push_back(preparation::notTestable("wrist_sphere", Remark(MissingId::tracker_not_declared)));
  } else {
    findings.push_back(sphereCheck(input));
  }
  if (swept) {
    findings.push_back(missCheck(input));
  } else {
    findings.push_back(preparation::notTestable("wrist_axes_meet", not_swept));
  }
  return findings;
}

}  // namespace stiffscope::audit
