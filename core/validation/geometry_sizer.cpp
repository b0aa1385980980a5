#include "core/validation/effect_size.h"

#include <Eigen/QR>
#include <cmath>

#include "core/simulation/machine.h"
#include "core/simulation/rotation.h"
#include "core/validation/noise_free.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::validation {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kPlaceParameters = 6;

/// The arm with one of its axis parameters, four an axis, changed by `step` (m or rad): offset or tilt across axis, in
/// turns.
robot::Robot shifted(robot::Robot robot, int parameter, double step) {
  metrology::Line& axis = robot.axes_in_base_at_zero[static_cast<std::size_t>(parameter / 4)];
  const Eigen::Matrix3d across = simulation::frameAlong(axis.point, axis.direction).linear();
  const Vector3d way = step * across.col(parameter % 2);
  if (parameter % 4 < 2) {
    axis.point += way;
  } else {
    axis.direction = (simulation::rotationExp(way) * axis.direction).normalized();
  }
  return robot;
}

/// Columns that the others do not make, by rank of the columns at one length.
MatrixXd independent(const MatrixXd& columns) {
  constexpr double kSame = 1e-7;
  VectorXd lengths = columns.colwise().norm();
  lengths = (lengths.array() > 0.0).select(lengths, 1.0);
  const MatrixXd scaled = columns * lengths.cwiseInverse().asDiagonal();
  Eigen::ColPivHouseholderQR<MatrixXd> qr(scaled);
  qr.setThreshold(kSame);
  return (scaled * qr.colsPermutation()).leftCols(qr.rank());
}

MatrixXd orthonormal(const MatrixXd& independent_columns) {
  const Eigen::HouseholderQR<MatrixXd> qr(independent_columns);
  return qr.householderQ() * MatrixXd::Identity(independent_columns.rows(), independent_columns.cols());
}

/// Rows of the postures of one parity: fold 0 or 1.
std::vector<Index> rowsOf(const std::vector<int>& pose_of, int fold) {
  std::vector<Index> rows;
  for (std::size_t r = 0; r < pose_of.size(); ++r) {
    if (pose_of[r] % 2 != fold) continue;
    for (Index k = 0; k < 3; ++k) rows.push_back(3 * static_cast<Index>(r) + k);
  }
  return rows;
}

}  // namespace

GeometrySizer::GeometrySizer(const simulation::SimulationSpec& clean)
    : tracker_from_base_(clean.tracker.base_from_tracker.inverse()),
      true_noise_factor_(clean.tracker.true_noise_factor),
      geometry_(simulation::rigidGeometry(simulation::buildMachine(clean))) {
  for (const simulation::TrueTarget& target : clean.targets) on_flange_.push_back(target.position_in_flange);
  const campaign::Tracker& tracker = clean.tracker.declared;
  const auto means = stateMeans(withoutScatter(clean));
  sigma_.resize(3 * static_cast<Index>(means.size()));
  for (const auto& [key, mean] : means) {
    const Index row = 3 * static_cast<Index>(pose_of_.size());
    pose_of_.push_back(key[0]);
    target_of_.push_back(key[2]);
    sight_.push_back(sightAxes(tracker, mean.value()));
    sigma_.segment<3>(row) = sigmaAt(tracker, mean.value()) / std::sqrt(mean.count);
  }
  noise_ = rms(sigma_);
  const Misfits without = misfitsOf(clean);
  reference_ = without.misfit;
  const MatrixXd columns = columnsAt(without.q);
  columns_ = independent(columns);
  basis_ = orthonormal(columns_);
  frames_basis_ = orthonormal(independent(columns.rightCols(columns.cols() - axisParameters())));
  background_ = rms(leftOver(basis_, reference_)) / noise_;
  simulation::SimulationSpec nominal = clean;
  nominal.machine.geometry = {};
  geometry_background_ = rms(leftOver(frames_basis_, reference_ - misfitsOf(nominal).misfit));
}

GeometrySizer::Misfits GeometrySizer::misfitsOf(const simulation::SimulationSpec& spec) const {
  simulation::SimulationSpec exact = spec;
  exact.read_back_resolution = 0.0;  // rounding is noise, not effect
  const campaign::Campaign campaign = withoutScatter(exact);
  Misfits all{VectorXd(sigma_.size()), {}};
  for (const campaign::State& state : campaign.states->rows) all.q.push_back(state.q);
  std::size_t r = 0;
  for (const auto& [key, mean] : stateMeans(campaign)) {
    const Vector3d rigid = tracker_from_base_ * (armAt(geometry_, all.q[static_cast<std::size_t>(key[0])]).flange *
                                                 on_flange_[static_cast<std::size_t>(key[2])]);
    all.misfit.segment<3>(3 * static_cast<Index>(r)) = sight_[r].transpose() * (mean.value() - rigid);
    ++r;
  }
  return all;
}

MatrixXd GeometrySizer::columnsAt(const std::vector<JointVector>& q) const {
  const Index targets = static_cast<Index>(on_flange_.size());
  const int of_axes = axisParameters();
  MatrixXd columns = MatrixXd::Zero(sigma_.size(), of_axes + kPlaceParameters + 3 * targets);
  constexpr double kStep = 1e-5;  // m and rad: the third order is 1e-10 of the first
  for (int parameter = 0; parameter < of_axes; ++parameter) {
    const robot::Robot ahead = shifted(geometry_, parameter, kStep), behind = shifted(geometry_, parameter, -kStep);
    for (std::size_t r = 0; r < pose_of_.size(); ++r) {
      const JointVector& angles = q[static_cast<std::size_t>(pose_of_[r])];
      const Vector3d& point = on_flange_[static_cast<std::size_t>(target_of_[r])];
      const Vector3d change = armAt(ahead, angles).flange * point - armAt(behind, angles).flange * point;
      columns.block<3, 1>(3 * static_cast<Index>(r), parameter) =
          sight_[r].transpose() * tracker_from_base_.linear() * change / (2.0 * kStep);
    }
  }
  for (std::size_t r = 0; r < pose_of_.size(); ++r) {
    const Index row = 3 * static_cast<Index>(r);
    const Eigen::Isometry3d flange = armAt(geometry_, q[static_cast<std::size_t>(pose_of_[r])]).flange;
    const Vector3d point = flange * on_flange_[static_cast<std::size_t>(target_of_[r])];
    const Eigen::Matrix3d sight_from_base = sight_[r].transpose() * tracker_from_base_.linear();
    columns.block<3, 3>(row, of_axes) = sight_from_base;
    columns.block<3, 3>(row, of_axes + 3) = -sight_from_base * simulation::skew(point);
    columns.block<3, 3>(row, of_axes + kPlaceParameters + 3 * target_of_[r]) = sight_from_base * flange.linear();
  }
  return sigma_.cwiseInverse().asDiagonal() * columns;
}

VectorXd GeometrySizer::leftOver(const MatrixXd& basis, const VectorXd& gap) const {
  const VectorXd white = gap.cwiseQuotient(sigma_);
  return (white - basis * (basis.transpose() * white)).cwiseProduct(sigma_);
}

VectorXd GeometrySizer::leftHeldOut(const VectorXd& gap) const {
  const VectorXd white = gap.cwiseQuotient(sigma_);
  VectorXd left = white;
  for (const int fold : {0, 1}) {
    const std::vector<Index> held = rowsOf(pose_of_, fold), fitted = rowsOf(pose_of_, 1 - fold);
    const MatrixXd by = columns_(fitted, Eigen::all);
    const VectorXd found = leastSquaresSolution(by, white(fitted));
    left(held) -= columns_(held, Eigen::all) * found;
  }
  return left.cwiseProduct(sigma_);
}

double GeometrySizer::noiseHeldOut() const {
  // Of unit noise in both: 1 + x' (X' X)^-1 x for each row x that is held out.
  VectorXd variance = VectorXd::Ones(sigma_.size());
  for (const int fold : {0, 1}) {
    const std::vector<Index> held = rowsOf(pose_of_, fold), fitted = rowsOf(pose_of_, 1 - fold);
    const MatrixXd by = columns_(fitted, Eigen::all);
    const MatrixXd spread = columns_(held, Eigen::all) * pseudoInverse(by);
    variance(held) += spread.rowwise().squaredNorm();
  }
  return true_noise_factor_ * rms(variance.cwiseSqrt().cwiseProduct(sigma_));
}

EffectSize GeometrySizer::measure(const simulation::SimulationSpec& with) const {
  const VectorXd misfit = misfitsOf(with).misfit, gap = misfit - reference_;
  EffectSize size;
  size.positions = rms(leftOver(basis_, gap)) / noise_;
  size.geometry = rms(leftOver(frames_basis_, gap)) / std::hypot(noise_, geometry_background_);
  const double before = rms(leftHeldOut(misfit)), after = rms(leftHeldOut(reference_)), noise = noiseHeldOut();
  size.shrink = before > 0.0 ? 1.0 - after / before : 0.0;
  size.shrink_seen = 1.0 - std::hypot(after, noise) / std::hypot(before, noise);
  return size;
}

}  // namespace stiffscope::validation
