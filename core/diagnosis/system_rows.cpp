#include "core/diagnosis/system_rows.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

#include "core/effects/gravity_equilibrium.h"
#include "core/identification/load_case.h"
#include "core/numerics/parallel.h"
#include "core/robot/geometric_stiffness.h"
#include "core/robot/wrench.h"
#include "metrology/linear_algebra.h"
#include "metrology/rigid_motion.h"

namespace stiffscope::diagnosis {

namespace {

std::vector<std::map<int, const campaign::State*>> statesOf(const campaign::Campaign& campaign) {
  std::vector<std::map<int, const campaign::State*>> states(campaign.pose_ids.size());
  for (const campaign::State& state : campaign.states->rows)
    states[static_cast<std::size_t>(state.pose)][state.step] = &state;
  return states;
}

/// `posture`: of the case, unloaded.
Eigen::Matrix3d cellAxes(const campaign::LoadCell& cell, const frames::LoadingGeometry& geometry,
                         const identification::LoadCase& one, const robot::ArmPosture& posture) {
  Eigen::Matrix3d axes;
  for (int k = 0; k < 3; ++k) {
    const Vector6d unit = Vector6d::Unit(k);
    axes.col(k) =
        identification::cellWrench(cell, geometry, posture, one.flange_unloaded, one.flange_loaded, unit).force;
  }
  return axes;
}

/// The wrench as the corrections have it.
robot::Wrench corrected(const robot::Wrench& read, const effects::ArmState& state, const effects::Corrections& by,
                        const effects::LinearizationPoint& at) {
  robot::Wrench wrench = read;
  const Eigen::Matrix3d turn =
      metrology::motionAbout(Eigen::Vector3d::Zero(),
                             (Vector6d() << state.cell_axes * by.cell_turn, Eigen::Vector3d::Zero()).finished())
          .linear();
  wrench.force = turn * read.force;
  wrench.moment = turn * read.moment;
  wrench.point += state.flange.linear() * by.load_point;
  if (state.loaded) {
    const Eigen::Vector3d weight = by.missing_weight * at.down;
    wrench.force += state.cell_axes * by.cell_force + weight;
    wrench.moment += (state.flange.linear() * at.load_offset).cross(weight);
  }
  return wrench;
}

/// Whether readings say where the instrument stood: several stations, or one that a rail's arm sees from elsewhere with
/// the carriage at zero.
bool saysStandpoints(const campaign::Campaign& campaign) {
  return !campaign.stations.empty() || campaign.robot.rail.has_value();
}

/// Of a reading of `point` from a station; both points in R0.
ReadFrom standpoint(const campaign::Campaign& campaign, const Eigen::Isometry3d& r0_from_points, int station,
                    const Eigen::Vector3d& from, const Eigen::Vector3d& point) {
  const Eigen::Matrix3d turn = r0_from_points.linear();
  return {from,
          turn * campaign::stationCovariance(campaign, station, r0_from_points.inverse() * point) * turn.transpose()};
}

class LoadingRowMaker {
 public:
  LoadingRowMaker(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry,
                  const effects::LinearizationPoint& at, const effects::Corrections& corrections,
                  const identification::LoadReadings& readings,
                  const std::vector<std::map<int, const campaign::State*>>& states)
      : campaign_(campaign),
        geometry_(geometry),
        at_(at),
        corrections_(corrections),
        states_(states),
        cases_(campaign, readings, geometry) {}

  std::vector<SystemRows> run(std::size_t first, std::size_t end) const {
    std::vector<SystemRows> rows;
    for (std::size_t pose = first; pose < end; ++pose) {
      const std::vector<identification::LoadCase> cases = cases_.ofPose(pose);
      if (cases.empty()) continue;
      const std::vector<int> targets = commonTargets(cases);
      double largest = 0.0;
      for (const identification::LoadCase& one : cases) largest = std::max(largest, one.wrench.force.norm());
      if (targets.empty() || largest <= 0.0) continue;
      rows.push_back(rowsOf(static_cast<int>(pose), cases, targets, largest));
    }
    return rows;
  }

 private:
  static std::vector<int> commonTargets(const std::vector<identification::LoadCase>& cases) {
    std::map<int, std::size_t> seen;
    for (const identification::LoadCase& one : cases) {
      for (const identification::TargetMove& move : one.targets) ++seen[move.target];
    }
    std::vector<int> common;
    for (const auto& [target, count] : seen) {
      if (count == cases.size()) common.push_back(target);
    }
    return common;
  }

  static const identification::TargetMove& moveOf(const identification::LoadCase& one, int target) {
    return *std::find_if(one.targets.begin(), one.targets.end(),
                         [&](const identification::TargetMove& move) { return move.target == target; });
  }

  /// What the states of a posture have in common.
  struct Unloaded {
    JointMatrix stiffening;    ///< K_c of the own weight
    double compensator = 0.0;  ///< on joint 2
    JointVector q_sagged;      ///< of the case before
    robot::ArmPosture posture;
  };

  SystemRows rowsOf(int pose, const std::vector<identification::LoadCase>& cases, const std::vector<int>& targets,
                    double largest) const {
    const auto per_state = 3 * static_cast<Eigen::Index>(targets.size());
    const auto states = static_cast<Eigen::Index>(cases.size());
    SystemRows rows;
    rows.pose = pose;
    rows.displacement.resize(per_state * states);
    rows.by_compliance.resize(per_state * states, geometry_.arm.joints());
    const campaign::State* unloaded_state = stateOf(pose, 0);
    effects::ArmState rest = effects::gravityEquilibrium(
        geometry_, at_, cases.front().q, unloaded_state ? unloaded_state->carriage : campaign::kNotGiven);
    rest.pose = pose;
    rest.targets = targets;
    rest.time_s = timeOf(pose, 0);
    // The geometry's readings are without the moved instrument's motion as at the mean position of a rail's carriage.
    const Eigen::Isometry3d here = at_.withoutMovedInstrument(corrections_.frame, rest.carriage) *
                                   at_.withoutMovedInstrument(corrections_.frame).inverse();
    for (const int target : targets) rest.points.push_back(here * moveOf(cases.front(), target).unloaded);
    if (cases.front().flange_unloaded) rest.flange = *cases.front().flange_unloaded;
    rows.readings.resize(states + 1, static_cast<Eigen::Index>(targets.size()));
    for (Eigen::Index t = 0; t < rows.readings.cols(); ++t) {
      const int target = targets[static_cast<std::size_t>(t)];
      // Of displacements nobody states how many.
      rows.readings(0, t) = std::max(1, moveOf(cases.front(), target).unloaded_readings);
      for (Eigen::Index k = 0; k < states; ++k)
        rows.readings(k + 1, t) = std::max(1, moveOf(cases[static_cast<std::size_t>(k)], target).loaded_readings);
    }
    rows.states.reserve(cases.size() + 1);
    rows.states.push_back(rest);
    Unloaded unloaded{robot::geometricStiffness(rest.axes, rest.posture, geometry_.weight),
                      compensatorSlope(at_, rest.turned),
                      {},
                      {}};
    for (std::size_t k = 0; k < cases.size(); ++k) {
      if (unloaded.q_sagged.size() == 0 || unloaded.q_sagged != cases[k].q_sagged) {
        unloaded.q_sagged = cases[k].q_sagged;
        unloaded.posture = identification::unloadedPosture(geometry_.arm, cases[k]);
      }
      addState(cases[k], rest, unloaded, largest, static_cast<Eigen::Index>(k) * per_state, rows);
    }
    rows.states.front().cell_axes = rows.states[1].cell_axes;
    if (cases.front().absolute) addPosition(rest, rows);
    if (saysStandpoints(campaign_) && geometry_.r0_from_loading) {
      for (const int target : targets) {
        const identification::TargetMove& move = moveOf(cases.front(), target);
        rows.read_from.push_back(
            standpoint(campaign_, *geometry_.r0_from_loading, move.station, move.from, move.unloaded));
      }
    }
    return rows;
  }

  void addState(const identification::LoadCase& one, const effects::ArmState& rest, const Unloaded& unloaded,
                double largest, Eigen::Index at_row, SystemRows& rows) const {
    effects::ArmState& state = rows.states.emplace_back(rest);
    state.step = one.step;
    state.time_s = timeOf(one.pose, one.step);
    state.loaded = one.wrench.force.norm() > campaign::kReturnShare * largest;
    state.cell_axes = cellAxes(*campaign_.load_cell, geometry_, one, unloaded.posture);
    state.load = corrected(one.wrench, state, corrections_, at_);
    state.load_torque = robot::jointTorque(rest.axes, state.load);
    // Springs' torque s = tau + K_c c s, and the Jacobian at the middle of the displacement (see
    // equations.h).
    JointMatrix change = robot::geometricStiffness(rest.axes, state.load) + unloaded.stiffening;
    change(1, 1) += unloaded.compensator;
    const Eigen::Index joints = change.rows();
    const JointMatrix system = JointMatrix::Identity(joints, joints) - change * at_.compliance.asDiagonal();
    const JointVector torque = solveLu(system, state.load_torque);
    const robot::ArmPosture middle =
        effects::movedPosture(geometry_.arm, rest.turned + 0.5 * at_.compliance.cwiseProduct(torque), rest.moved);
    const robot::ArmAxes middle_axes = robot::axesAt(geometry_.arm, middle);
    Eigen::Matrix<double, Eigen::Dynamic, 6> by_wrench(rest.rows(), 6);
    const Jacobian torque_to_wrench = robot::jacobianAt(rest.axes, state.load.point);
    for (std::size_t t = 0; t < rest.targets.size(); ++t) {
      const identification::TargetMove& move = moveOf(one, rest.targets[t]);
      const PointJacobian jacobian = robot::pointJacobianAt(middle_axes, 0.5 * (move.unloaded + move.loaded));
      const Eigen::Index row = at_row + 3 * static_cast<Eigen::Index>(t);
      rows.displacement.segment<3>(row) = move.displacement();
      rows.by_compliance.middleRows<3>(row) = jacobian * torque.asDiagonal();
      by_wrench.middleRows<3>(3 * static_cast<Eigen::Index>(t)) =
          jacobian * at_.compliance.asDiagonal() * torque_to_wrench.transpose();
    }
    rows.by_wrench.push_back(std::move(by_wrench));
  }

  void addPosition(const effects::ArmState& rest, SystemRows& rows) const {
    rows.position.resize(rest.rows());
    for (std::size_t t = 0; t < rest.targets.size(); ++t) {
      const auto& at_zero = geometry_.targets_at_zero[static_cast<std::size_t>(rest.targets[t])];
      if (!at_zero) {
        rows.position.resize(0);
        return;
      }
      rows.position.segment<3>(3 * static_cast<Eigen::Index>(t)) =
          rest.points[t] - rest.posture.motion.back() * *at_zero;
    }
    rows.sag_by_compliance = effects::byEachJoint(rest, rest.weight_torque);
  }

  const campaign::State* stateOf(int pose, int step) const {
    const auto& by_step = states_[static_cast<std::size_t>(pose)];
    const auto found = by_step.find(step);
    return found == by_step.end() ? nullptr : found->second;
  }

  double timeOf(int pose, int step) const {
    const campaign::State* state = stateOf(pose, step);
    return state == nullptr ? campaign::kNoTime : state->time_s;
  }

  const campaign::Campaign& campaign_;
  const frames::LoadingGeometry& geometry_;
  const effects::LinearizationPoint& at_;
  const effects::Corrections& corrections_;
  const std::vector<std::map<int, const campaign::State*>>& states_;
  identification::LoadCaseMaker cases_;
};

}  // namespace

double compensatorSlope(const effects::LinearizationPoint& at, const JointVector& turned) {
  double slope = 0.0;
  for (Eigen::Index k = 0; k + 1 < at.compensator.size(); k += 2) {
    const double n = static_cast<double>(k / 2 + 1);
    slope += n * (at.compensator[k] * std::cos(n * turned[1]) - at.compensator[k + 1] * std::sin(n * turned[1]));
  }
  return slope;
}

LoadingRows::LoadingRows(const campaign::Campaign& campaign)
    : campaign_(campaign), readings_(campaign, identification::loadSteps(campaign)), states_(statesOf(campaign)) {}

std::vector<SystemRows> LoadingRows::rows(const frames::LoadingGeometry& geometry,
                                          const effects::LinearizationPoint& at,
                                          const effects::Corrections& corrections, std::size_t first,
                                          std::size_t end) const {
  frames::LoadingGeometry shifted = geometry;
  if (shifted.r0_from_loading) {
    shifted.r0_from_loading = at.withoutMovedInstrument(corrections.frame) * *geometry.r0_from_loading;
  }
  return LoadingRowMaker(campaign_, shifted, at, corrections, readings_, states_).run(first, end);
}

std::vector<SystemRows> loadingRows(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry,
                                    const effects::LinearizationPoint& at, const effects::Corrections& corrections) {
  return LoadingRows(campaign).rows(geometry, at, corrections);
}

std::vector<SweepRows> sweepRows(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry,
                                 const Eigen::Isometry3d& r0_from_points, const effects::LinearizationPoint& at) {
  std::map<std::pair<int, std::string>, SweepRows> by_index;
  const auto add = [&](int axis, const auto& reading) {
    const auto& at_zero = geometry.targets_at_zero[static_cast<std::size_t>(reading.target)];
    if (!at_zero) return;
    SweepRows& rows = by_index[{axis, reading.index}];
    if (rows.state.points.empty()) rows.state.q = reading.q, rows.state.carriage = reading.carriage;
    rows.state.time_s = reading.time_s;
    rows.state.targets.push_back(reading.target);
    rows.state.points.push_back(r0_from_points * reading.point);
    if (saysStandpoints(campaign))
      rows.read_from.push_back(standpoint(campaign, r0_from_points, reading.station, r0_from_points * reading.from,
                                          rows.state.points.back()));
  };
  if (campaign.circle_sweeps) {
    for (const campaign::CircleReading& reading : campaign.circle_sweeps->rows) add(reading.axis, reading);
  }
  if (campaign.wrist_sweep) {
    for (const campaign::WristReading& reading : campaign.wrist_sweep->rows) add(campaign.robot.joints(), reading);
  }
  std::vector<SweepRows> all;
  all.reserve(by_index.size());
  for (auto& [key, rows] : by_index) all.push_back(std::move(rows));
  numerics::onAllCores(all.size(), [&](std::size_t i) {
    SweepRows& rows = all[i];
    effects::ArmState state = effects::gravityEquilibrium(geometry, at, rows.state.q, rows.state.carriage);
    state.time_s = rows.state.time_s;
    state.targets = std::move(rows.state.targets);
    state.points = std::move(rows.state.points);
    rows.state = std::move(state);
    rows.position.resize(rows.state.rows());
    for (std::size_t k = 0; k < rows.state.points.size(); ++k) {
      const auto& at_zero = geometry.targets_at_zero[static_cast<std::size_t>(rows.state.targets[k])];
      rows.position.segment<3>(3 * static_cast<Eigen::Index>(k)) =
          rows.state.points[k] - rows.state.posture.motion.back() * *at_zero;
    }
    rows.sag_by_compliance = effects::byEachJoint(rows.state, rows.state.weight_torque);
  });
  return all;
}

}  // namespace stiffscope::diagnosis
