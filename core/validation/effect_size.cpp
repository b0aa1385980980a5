#include "core/validation/effect_size.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/simulation/carriage.h"
#include "core/simulation/rotation.h"
#include "core/validation/noise_free.h"

namespace stiffscope::validation {

namespace {

using Eigen::Index;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Calls use(row of table or state, target, point, readings averaged) for every unloaded reading: sweeps, wrist sweep,
/// then step 0. The row has `q` and `rail`.
template <class Use>
Index forUnloaded(const campaign::Campaign& campaign, const Use& use) {
  Index before_loading = 0;
  if (campaign.circle_sweeps) {
    for (const campaign::CircleReading& one : campaign.circle_sweeps->rows) use(one, one.target, one.point, 1);
    before_loading += static_cast<Index>(campaign.circle_sweeps->rows.size());
  }
  if (campaign.wrist_sweep) {
    for (const campaign::WristReading& one : campaign.wrist_sweep->rows) use(one, one.target, one.point, 1);
    before_loading += static_cast<Index>(campaign.wrist_sweep->rows.size());
  }
  std::map<int, const campaign::State*> unloaded;
  for (const campaign::State& state : campaign.states->rows) {
    if (state.step == 0) unloaded[state.pose] = &state;
  }
  for (const auto& [key, mean] : stateMeans(campaign)) {
    if (key[1] == 0) use(*unloaded.at(key[0]), key[2], mean.value(), mean.count);
  }
  return before_loading;
}

VectorXd unloadedPoints(const campaign::Campaign& campaign) {
  std::vector<double> values;
  forUnloaded(campaign, [&](const auto&, int, const Vector3d& point, int) {
    values.insert(values.end(), point.data(), point.data() + 3);
  });
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(values.size()));
}

/// By how much the carriage of a rail stands elsewhere than reported: rms per coordinate of what its stops miss along
/// the rail and its waves of this amplitude across it in two directions, m.
double carriageError(const simulation::RailSpec& rail) {
  return std::sqrt((rail.stop_sigma * rail.stop_sigma + rail.straightness * rail.straightness) / 3.0);
}

/// The same machine with nothing that gives but the springs of its joints, those shared by two of them, and between
/// bodies.
simulation::SimulationSpec springsAlone(simulation::SimulationSpec spec) {
  simulation::MachineSpec springs;
  for (const simulation::JointStiffness& joint : spec.machine.joints) springs.joints.push_back({joint.torsion, {}});
  springs.shared_springs = spec.machine.shared_springs;
  springs.link_springs = spec.machine.link_springs;
  springs.geometry = spec.machine.geometry;
  springs.mass_relative_sigma = spec.machine.mass_relative_sigma;
  springs.tool = spec.machine.tool;
  springs.base_tilt = spec.machine.base_tilt;
  springs.base_tilt_azimuth = spec.machine.base_tilt_azimuth;
  springs.base_tilt_declared = spec.machine.base_tilt_declared;
  spec.machine = springs;
  return spec;
}

}  // namespace

EffectSizer::EffectSizer(const simulation::SimulationSpec& clean)
    : base_from_tracker_(clean.tracker.base_from_tracker.linear()),
      station_in_base_(clean.tracker.base_from_tracker * clean.tracker.declared.station),
      true_noise_factor_(clean.tracker.true_noise_factor),
      geometry_(simulation::rigidGeometry(simulation::buildMachine(clean))),
      reference_(withoutScatter(clean)) {
  if (clean.nominal.rail) {
    rail_in_base_ = simulation::railAxes(clean).col(0);
    carriage_error_ = carriageError(clean.rail);
  }
  compliance_.resize(geometry_.joints());
  for (Index i = 0; i < compliance_.size(); ++i) {
    compliance_[i] = 1.0 / clean.machine.joints[static_cast<std::size_t>(i)].torsion.value();
  }
  undisturbed_ = deflections(reference_);
  const Deflections springs = deflections(withoutScatter(springsAlone(clean)));
  finite_ = springs.displacement - springs.columns * compliance_;
  const auto means = stateMeans(reference_);
  displacement_sigma_.resize(undisturbed_.displacement.size());
  Index row = 0;
  int pose = -1;
  for (const auto& [key, mean] : means) {
    if (key[1] == 0) continue;
    const MeanPoint& zero = means.at({key[0], 0, key[2]});
    displacement_sigma_.segment<3>(row) =
        std::sqrt(1.0 / mean.count + 1.0 / zero.count) * sigmaAt(*reference_.tracker, zero.value());
    row += 3;
    if (pose_ends_.empty() || key[0] != pose) pose_ends_.push_back(row);
    pose_ends_.back() = row;
    pose = key[0];
  }
  identifiable_ = identifiableBy(undisturbed_);
  background_ = whitened(leftOver(undisturbed_, undisturbed_.displacement - undisturbed_.columns * compliance_));
  designPositions();
  simulation::SimulationSpec nominal = clean;
  nominal.machine.geometry = {};
  geometry_background_ = positionsLeft(unloaded_ - unloadedPoints(withoutScatter(nominal)));
}

EffectSizer::Deflections EffectSizer::deflections(const campaign::Campaign& campaign) const {
  const auto means = stateMeans(campaign);
  const auto reference = stateMeans(reference_);
  std::map<std::array<int, 2>, const campaign::State*> states;
  for (const campaign::State& state : campaign.states->rows) states[{state.pose, state.step}] = &state;
  std::size_t count = 0;
  for (const auto& one : means) count += one.first[1] > 0 ? 1 : 0;
  const Index rows = 3 * static_cast<Index>(count);
  Deflections all{VectorXd(rows), Eigen::MatrixXd(rows, geometry_.joints())};
  Index row = 0;
  for (const auto& [key, mean] : means) {
    if (key[1] == 0) continue;
    const Vector3d zero = reference.at({key[0], 0, key[2]}).value();
    const Eigen::Matrix3d sight = sightAxes(*campaign.tracker, zero);
    all.displacement.segment<3>(row) = sight.transpose() * (mean.value() - means.at({key[0], 0, key[2]}).value());
    const campaign::State& state = *states.at({key[0], key[1]});
    const ArmNow arm = armAt(geometry_, state.q);
    const Eigen::Isometry3d cell = arm.flange * campaign.load_cell->parent_from_cell;
    const Vector3d force = cell.linear() * state.wrench_in_cell.head<3>();
    const Vector3d moment = cell.linear() * state.wrench_in_cell.tail<3>();
    // The point in base_link as the rigid arm would have it, its carriage at zero: what the reference's station saw.
    const Vector3d point =
        base_from_tracker_ * (zero - reference_.tracker->station) + station_in_base_ - travel(state.rail);
    const auto axes = static_cast<Index>(arm.axes.size());
    Eigen::Matrix3Xd moves(3, axes);
    VectorXd torques(axes);
    for (Index i = 0; i < axes; ++i) {
      const metrology::Line& axis = arm.axes[static_cast<std::size_t>(i)];
      torques[i] = axis.direction.dot(moment + (cell.translation() - axis.point).cross(force));
      moves.col(i) = sight.transpose() * base_from_tracker_.transpose() * axis.direction.cross(point - axis.point);
    }
    const auto& couplings = geometry_.axes_in_base_at_zero.couplings;
    const Eigen::MatrixXd turns =
        couplings ? Eigen::MatrixXd(couplings->turns) : Eigen::MatrixXd(Eigen::MatrixXd::Identity(axes, axes));
    all.columns.middleRows<3>(row) = moves * turns * (turns.transpose() * torques).asDiagonal();
    row += 3;
  }
  return all;
}

Vector3d EffectSizer::travel(double carriage) const {
  return std::isnan(carriage) ? Vector3d::Zero() : Vector3d(carriage * rail_in_base_);
}

std::vector<Index> EffectSizer::identifiableBy(const Deflections& of) const {
  std::vector<Index> joints;
  for (Index i = 0; i < compliance_.size(); ++i) {
    if (whitened(of.columns.col(i) * compliance_[i]) > 1.0) joints.push_back(i);
  }
  return joints;
}

VectorXd EffectSizer::leftOver(const Deflections& of, const VectorXd& gap) const {
  if (identifiable_.empty()) return gap;
  const Eigen::MatrixXd columns = of.columns(Eigen::all, identifiable_);
  const VectorXd weight = displacement_sigma_.cwiseInverse();
  const VectorXd change = (weight.asDiagonal() * columns).eval().colPivHouseholderQr().solve(weight.cwiseProduct(gap));
  return gap - columns * change;
}

VectorXd EffectSizer::leftHeldOut(const Deflections& of, const VectorXd& gap) const {
  // By these wrenches: a misread one may turn joints that the true one leaves alone, and who fits knows no
  // better.
  const std::vector<Index> joints = identifiableBy(of);
  if (joints.empty()) return gap;
  const VectorXd weight = displacement_sigma_.cwiseInverse();
  const Eigen::MatrixXd columns = of.columns(Eigen::all, joints);
  const Eigen::MatrixXd scaled = weight.asDiagonal() * columns;
  const VectorXd right = weight.cwiseProduct(gap);
  VectorXd left = gap;
  Index from = 0;
  for (const Index end : pose_ends_) {
    Eigen::MatrixXd others = scaled;
    VectorXd theirs = right;
    others.middleRows(from, end - from).setZero();
    theirs.segment(from, end - from).setZero();
    const VectorXd change = others.colPivHouseholderQr().solve(theirs);
    left.segment(from, end - from) -= columns.middleRows(from, end - from) * change;
    from = end;
  }
  return left;
}

double EffectSizer::whitened(const VectorXd& residual) const {
  return rms(residual.cwiseQuotient(displacement_sigma_));
}

void EffectSizer::designPositions() {
  unloaded_ = unloadedPoints(reference_);
  unloaded_sigma_.resize(unloaded_.size());
  const Index targets = static_cast<Index>(reference_.targets.size());
  Eigen::MatrixXd design = Eigen::MatrixXd::Zero(unloaded_.size(), 6 + 3 * targets);
  Index row = 0;
  const Index before = forUnloaded(reference_, [&](const auto& at, int target, const Vector3d& point, int readings) {
    const Vector3d sigma = sigmaAt(*reference_.tracker, point) / std::sqrt(readings);
    // One sigma for all three directions will do for what is a nuisance.
    unloaded_sigma_.segment<3>(row).setConstant(std::sqrt(sigma.squaredNorm() / 3.0));
    design.block<3, 3>(row, 0).setIdentity();
    design.block<3, 3>(row, 3) = -simulation::skew(point - base_from_tracker_.transpose() * travel(at.rail));
    design.block<3, 3>(row, 6 + 3 * target) = base_from_tracker_.transpose() * armAt(geometry_, at.q).flange.linear();
    row += 3;
  });
  first_of_step_0_ = 3 * before;
  const Index rest = unloaded_.size() - first_of_step_0_;
  position_noise_ = rms(unloaded_sigma_.tail(rest));
  nuisances_.compute(unloaded_sigma_.cwiseInverse().asDiagonal() * design);
}

double EffectSizer::positionsLeft(const VectorXd& difference) const {
  const VectorXd white = difference.cwiseQuotient(unloaded_sigma_);
  const Index columns = nuisances_.matrixQR().cols();
  VectorXd turned = nuisances_.householderQ().adjoint() * white;
  turned.head(columns).setZero();
  const VectorXd left = (nuisances_.householderQ() * turned).cwiseProduct(unloaded_sigma_);
  return rms(left.tail(left.size() - first_of_step_0_));
}

EffectSize EffectSizer::measure(const simulation::SimulationSpec& with) const {
  const campaign::Campaign campaign = withoutScatter(with);
  const Deflections disturbed = deflections(campaign);
  const VectorXd before = disturbed.displacement - disturbed.columns * compliance_;
  const VectorXd after = undisturbed_.displacement - undisturbed_.columns * compliance_;
  EffectSize size;
  size.deflection = whitened(leftOver(disturbed, before - after));
  const double rms_before = rms(leftHeldOut(disturbed, before - finite_)),
               rms_after = rms(leftHeldOut(undisturbed_, after - finite_));
  const double noise = true_noise_factor_ * rms(displacement_sigma_);
  size.shrink = rms_before > 0.0 ? 1.0 - rms_after / rms_before : 0.0;
  size.shrink_seen = 1.0 - std::hypot(rms_after, noise) / std::hypot(rms_before, noise);
  const double moved = positionsLeft(unloadedPoints(campaign) - unloaded_);
  size.nests = moved / position_noise_;
  size.positions = moved / std::hypot(position_noise_, geometry_background_, carriage_error_);
  return size;
}

}  // namespace stiffscope::validation
