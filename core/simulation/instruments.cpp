#include "core/simulation/instruments.h"

#include <algorithm>
#include <cmath>

#include "core/numerics/random.h"
#include "core/simulation/rotation.h"

namespace stiffscope::simulation {

Vector6d loadWrenchInCell(const ElasticMachine& machine, const MachineState& state, const robot::LinkFrame& parent,
                          const campaign::LoadCell& cell, const Eigen::Vector3d& place_error) {
  const Eigen::Isometry3d base_from_cell = baseFromLink(machine, state, parent) * cell.parent_from_cell;
  const Eigen::Matrix3d cell_from_base = base_from_cell.linear().transpose();
  const Eigen::Vector3d arm = state.load_point_in_base - base_from_cell * place_error;
  const Eigen::Vector3d force = state.load_force_in_base - state.unread_force_in_base;
  Vector6d wrench;
  wrench << cell_from_base * force, cell_from_base * arm.cross(force);
  return wrench;
}

void addLoadCellErrors(const LoadCellSpec& cell, std::uint64_t noise_seed, campaign::States& states) {
  const Eigen::Matrix3d true_from_declared = rotationExp(cell.misalignment).transpose();
  numerics::RandomStream random(noise_seed, "load cell");
  for (campaign::State& state : states.rows) {
    Vector6d& wrench = state.wrench_in_cell;
    const bool loaded = !wrench.isZero(0.0);
    wrench.head<3>() = true_from_declared * wrench.head<3>();
    wrench.tail<3>() = true_from_declared * wrench.tail<3>();
    wrench *= 1.0 + cell.gain_error;
    if (loaded) wrench += cell.bias;
    wrench.head<3>() += cell.declared.force_sigma * random.normal3();
    wrench.tail<3>() += cell.declared.moment_sigma * random.normal3();
  }
}

void addEncoderErrors(const PerJoint<JointStiffness>& joints, std::uint64_t noise_seed, campaign::States& states) {
  numerics::RandomStream random(noise_seed, "encoders");
  for (campaign::State& state : states.rows) {
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const std::optional<JointGear>& gear = joints[i].gear;
      if (gear)
        state.extras().motor_side[static_cast<Eigen::Index>(i)] +=
            gear->encoder_offset + gear->encoder_sigma * random.normal();
    }
  }
}

namespace {

constexpr double kLongestDay = 200000.0;  ///< s; beyond it the walk stays where it is

Eigen::Isometry3d motionOf(const Vector6d& shift_and_turn) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = rotationExp(shift_and_turn.tail<3>());
  motion.translation() = shift_and_turn.head<3>();
  return motion;
}

}  // namespace

Station::Station(const SimulationSpec& spec)
    : spec_(spec.station),
      tracker_from_base_(spec.tracker.base_from_tracker.inverse()),
      station_(spec.tracker.declared.station) {
  still_ = spec_.ramp.isZero(0.0) && spec_.walk.isZero(0.0) && spec_.limit.isZero(0.0) && !spec_.tracker_moved &&
           spec_.scale == 0.0 && spec_.scale_per_second == 0.0 && spec_.scale_step == 0.0 && spec_.bending == 0.0 &&
           spec_.bending_per_m == 0.0;
  if (spec_.walk.isZero(0.0)) return;
  numerics::RandomStream random(noiseSeed(spec), "station walk");
  const int count = static_cast<int>(kLongestDay / spec_.knot_s) + 2;
  knots_.assign(1, Vector6d::Zero());
  for (int k = 1; k < count; ++k) {
    Vector6d draw;
    for (int i = 0; i < 6; ++i) draw[i] = random.normal();
    knots_.push_back(knots_.back() + std::sqrt(spec_.knot_s) * spec_.walk.cwiseProduct(draw));
  }
}

Vector6d Station::wandered(double time_s) const {
  return time_s * spec_.ramp - std::expm1(-time_s / spec_.limit_time) * spec_.limit + walked(time_s);
}

Vector6d Station::walked(double time_s) const {
  if (knots_.empty()) return Vector6d::Zero();
  const double at = std::clamp(time_s / spec_.knot_s, 0.0, static_cast<double>(knots_.size()) - 1.0);
  const std::size_t before = std::min(static_cast<std::size_t>(at), knots_.size() - 2);
  const double s = at - static_cast<double>(before);
  const Vector6d &from = knots_[before], &to = knots_[before + 1];
  if (!spec_.smooth) return (1.0 - s) * from + s * to;
  // A cubic whose slope at a knot is that between its neighbours.
  const Vector6d out = 0.5 * (to - knots_[before > 0 ? before - 1 : 0]);
  const Vector6d in = 0.5 * (knots_[std::min(before + 2, knots_.size() - 1)] - from);
  const double hold = s * s * (3.0 - 2.0 * s);
  return from + hold * (to - from) + s * (1.0 - s) * ((1.0 - s) * out - s * in);
}

bool Station::moved(const std::optional<double>& at_s, double time_s) const {
  return at_s ? time_s >= *at_s : loading_;
}

Eigen::Vector3d Station::bentUp(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d up = tracker_from_base_.linear().col(2), sight = point - station_;
  const double height = up.dot(sight), level = (sight - height * up).norm();
  return 0.5 * level * level * (spec_.bending + spec_.bending_per_m * height) * up;
}

Eigen::Vector3d Station::readFloor(const Eigen::Vector3d& point_in_base, double time_s) const {
  const Eigen::Vector3d point = tracker_from_base_ * point_in_base;
  if (still_) return point;
  Eigen::Isometry3d first_from_now = motionOf(wandered(time_s));
  if (spec_.tracker_moved && moved(spec_.tracker_moved_s, time_s))
    first_from_now = *spec_.tracker_moved * first_from_now;
  double scale = 1.0 + spec_.scale + spec_.scale_per_second * time_s;
  if (time_s >= spec_.scale_step_s) scale += spec_.scale_step;
  const Eigen::Vector3d seen = first_from_now.inverse() * point;
  return scale * (seen + bentUp(seen));
}

Eigen::Vector3d Station::readRobot(const Eigen::Vector3d& point_in_base, double time_s) const {
  if (spec_.robot_moved && moved(spec_.robot_moved_s, time_s))
    return readFloor(*spec_.robot_moved * point_in_base, time_s);
  return readFloor(point_in_base, time_s);
}

ReflectorSeats::ReflectorSeats(const SimulationSpec& spec, int posture)
    : targets_(spec.targets),
      slipped_(targets_.size(), false),
      rattled_(targets_.size(), false),
      shifts_(targets_.size(), Eigen::Vector3d::Zero()) {
  for (std::size_t t = 0; t < targets_.size(); ++t) {
    if (!targets_[t].motion || targets_[t].motion->kind != TargetMotion::Kind::rattling) continue;
    numerics::RandomStream random(noiseSeed(spec), "seat of " + targets_[t].id + " in " + std::to_string(posture));
    rattled_[t] = random.uniform() < 0.5;
  }
}

const std::vector<Eigen::Vector3d>& ReflectorSeats::under(const Eigen::Vector3d& force_in_flange, double time_s) {
  const double size = force_in_flange.norm();
  for (std::size_t t = 0; t < targets_.size(); ++t) {
    if (!targets_[t].motion) continue;
    const TargetMotion& motion = *targets_[t].motion;
    switch (motion.kind) {
      case TargetMotion::Kind::proportional:
        shifts_[t] = size / motion.at_force * motion.shift;
        break;
      case TargetMotion::Kind::compliant:
        shifts_[t] = motion.compliance * force_in_flange;
        break;
      case TargetMotion::Kind::slip:
        if (size >= motion.at_force) slipped_[t] = true;
        if (slipped_[t]) shifts_[t] = motion.shift;
        break;
      case TargetMotion::Kind::reseated:
        if (time_s >= motion.from_s) shifts_[t] = motion.shift;
        break;
      case TargetMotion::Kind::rattling:
        if (rattled_[t]) shifts_[t] = motion.shift;
        break;
    }
  }
  return shifts_;
}

namespace {

template <class Row>
void addToTable(const campaign::Tracker& tracker, double factor, numerics::RandomStream random,
                std::optional<campaign::Table<Row>>& table) {
  if (!table) return;
  for (Row& row : table->rows) row.point += trackerError(tracker, factor, row.point, random);
}

}  // namespace

Eigen::Vector3d trackerError(const campaign::Tracker& tracker, double factor, const Eigen::Vector3d& point,
                             numerics::RandomStream& random) {
  const Eigen::Vector3d sight = point - tracker.station;
  const double distance = sight.norm();
  const Eigen::Matrix3d axes = frameAlong(tracker.station, sight).linear();  // z along the line of sight
  const double along = tracker.range_fixed + tracker.range_per_m * distance;
  const double across = tracker.angle_fixed + tracker.angle_per_m * distance;
  const Eigen::Vector3d draw = random.normal3();
  return factor *
         (axes.col(2) * (along * draw[0]) + axes.col(0) * (across * draw[1]) + axes.col(1) * (across * draw[2]));
}

void addTrackerNoise(double factor, std::uint64_t noise_seed, campaign::Campaign& campaign) {
  const campaign::Tracker& tracker = campaign.tracker.value();
  addToTable(tracker, factor, {noise_seed, "tracker sweeps"}, campaign.circle_sweeps);
  addToTable(tracker, factor, {noise_seed, "tracker wrist"}, campaign.wrist_sweep);
  addToTable(tracker, factor, {noise_seed, "tracker rail"}, campaign.rail_sweep);
  addToTable(tracker, factor, {noise_seed, "tracker loading"}, campaign.loading);
  addToTable(tracker, factor, {noise_seed, "tracker nests"}, campaign.nests);
}

}  // namespace stiffscope::simulation
