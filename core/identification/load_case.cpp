#include "core/identification/load_case.h"

#include <fmt/format.h>

#include <map>

#include "core/identification/cell_wrench.h"
#include "metrology/rigid_registration.h"

namespace stiffscope {

namespace {

/// Sums of the readings of one state, by target.
struct StateReadings {
  std::map<int, std::pair<Eigen::Vector3d, int>> by_target;
};

/// Readings of the asked step and of step 0, by pose.
struct PoseReadings {
  StateReadings unloaded, loaded;
};

std::vector<PoseReadings> gatherPoints(const Campaign& campaign, int step) {
  std::vector<PoseReadings> poses(campaign.pose_ids.size());
  for (const LoadingReading& reading : campaign.loading->rows) {
    if (reading.step != 0 && reading.step != step) continue;
    PoseReadings& pose = poses[static_cast<std::size_t>(reading.pose)];
    auto& sums = (reading.step == 0 ? pose.unloaded : pose.loaded).by_target;
    const auto place = sums.try_emplace(reading.target, Eigen::Vector3d::Zero(), 0).first;
    place->second.first += reading.point;
    ++place->second.second;
  }
  return poses;
}

std::vector<TargetMove> measuredMoves(const PoseReadings& readings,
                                      const Eigen::Isometry3d& r0_from_loading) {
  std::vector<TargetMove> moves;
  for (const auto& [target, unloaded] : readings.unloaded.by_target) {
    const auto loaded = readings.loaded.by_target.find(target);
    if (loaded == readings.loaded.by_target.end()) continue;
    TargetMove move;
    move.target = target;
    move.unloaded = r0_from_loading * (unloaded.first / unloaded.second);
    move.loaded = r0_from_loading * (loaded->second.first / loaded->second.second);
    move.unloaded_readings = unloaded.second;
    move.loaded_readings = loaded->second.second;
    moves.push_back(move);
  }
  return moves;
}

/// base_from_flange from the reflectors: their places on the arm at zero brought onto where they are
/// measured.
std::optional<Eigen::Isometry3d> measuredFlange(const LoadingGeometry& geometry,
                                                const std::vector<TargetMove>& moves, bool loaded) {
  std::vector<Eigen::Vector3d> at_zero, measured;
  for (const TargetMove& move : moves) {
    const auto& target = geometry.targets_at_zero[static_cast<std::size_t>(move.target)];
    if (!target) continue;
    at_zero.push_back(*target);
    measured.push_back(loaded ? move.loaded : move.unloaded);
  }
  const RigidRegistration registration = registerRigid(at_zero, measured);
  if (!registration.determined) return std::nullopt;
  return registration.to_from_source * geometry.arm.base_from_flange_at_zero;
}

using PoseDisplacements = std::vector<std::vector<const Displacement*>>;

PoseDisplacements gatherDisplacements(const Campaign& campaign, int step) {
  PoseDisplacements poses(campaign.pose_ids.size());
  for (const Displacement& row : campaign.displacements->rows) {
    if (row.step == step) poses[static_cast<std::size_t>(row.pose)].push_back(&row);
  }
  return poses;
}

/// Displacements without absolute points: put on the model's place of the reflector.
std::vector<TargetMove> declaredMoves(const LoadingGeometry& geometry,
                                      const std::vector<const Displacement*>& rows,
                                      const Eigen::Matrix3d& r0_from_table, const ArmPosture& posture) {
  std::vector<TargetMove> moves;
  for (const Displacement* row : rows) {
    const auto& target = geometry.targets_at_zero[static_cast<std::size_t>(row->target)];
    if (!target) continue;
    TargetMove move;
    move.target = row->target;
    move.unloaded = posture.motion[6] * *target;
    move.loaded = move.unloaded + r0_from_table * row->displacement;
    moves.push_back(move);
  }
  return moves;
}

struct PoseStates {
  const State* unloaded = nullptr;
  const State* loaded = nullptr;
};

std::vector<PoseStates> gatherStates(const Campaign& campaign, int step) {
  std::vector<PoseStates> states(campaign.pose_ids.size());
  for (const State& state : campaign.states->rows) {
    if (state.step == 0) states[static_cast<std::size_t>(state.pose)].unloaded = &state;
    if (state.step == step) states[static_cast<std::size_t>(state.pose)].loaded = &state;
  }
  return states;
}

}  // namespace

const ArmPosture& jacobianPosture(const LoadCase& load_case) {
  return load_case.middle ? *load_case.middle : load_case.posture;
}

Eigen::Vector3d jacobianPoint(const LoadCase& load_case, const Eigen::Vector3d& unloaded,
                              const Eigen::Vector3d& loaded) {
  return load_case.middle ? Eigen::Vector3d(0.5 * (unloaded + loaded)) : unloaded;
}

std::optional<int> heaviestStep(const Campaign& campaign) {
  if (!campaign.states) return std::nullopt;
  std::map<int, std::pair<double, int>> force_by_step;
  for (const State& state : campaign.states->rows) {
    if (state.step == 0) continue;
    auto& [sum, count] = force_by_step[state.step];
    sum += state.wrench_in_cell.head<3>().norm();
    ++count;
  }
  std::optional<int> heaviest;
  double most = 0.0;
  for (const auto& [step, force] : force_by_step) {
    const double mean = force.first / force.second;
    if (mean > most) most = mean, heaviest = step;
  }
  return heaviest;
}

std::vector<LoadCase> loadCases(const Campaign& campaign, const LoadingGeometry& geometry, int step,
                                std::vector<std::string>* left_out) {
  std::vector<LoadCase> cases;
  if (!campaign.states || !campaign.load_cell) return cases;
  const bool absolute = campaign.loading.has_value() && geometry.r0_from_loading.has_value();
  if (!absolute && (!campaign.displacements || !geometry.displacements_in_r0)) return cases;
  const std::vector<PoseStates> states = gatherStates(campaign, step);
  const std::vector<PoseReadings> readings =
      absolute ? gatherPoints(campaign, step) : std::vector<PoseReadings>();
  const PoseDisplacements differences = absolute ? PoseDisplacements() : gatherDisplacements(campaign, step);
  const Eigen::Matrix3d r0_from_table = geometry.displacements_in_r0.value_or(Eigen::Matrix3d::Identity());
  const auto leaveOut = [&](std::size_t pose, const char* reason) {
    if (left_out) left_out->push_back(fmt::format("pose {}: {}", campaign.pose_ids[pose], reason));
  };
  for (std::size_t pose = 0; pose < states.size(); ++pose) {
    const auto& [unloaded, loaded] = states[pose];
    if (loaded == nullptr) {
      leaveOut(pose, "no state of this load step");
      continue;
    }
    LoadCase load_case;
    load_case.pose = static_cast<int>(pose);
    load_case.step = step;
    load_case.q = unloaded ? unloaded->q : loaded->q;
    load_case.servo = loaded->q - load_case.q;
    load_case.absolute = absolute;
    load_case.q_sagged = geometry.sagged(load_case.q);
    load_case.posture = postureAt(geometry.arm, load_case.q_sagged);
    if (absolute) {
      load_case.targets = measuredMoves(readings[pose], *geometry.r0_from_loading);
      load_case.flange_unloaded = measuredFlange(geometry, load_case.targets, false);
      load_case.flange_loaded = measuredFlange(geometry, load_case.targets, true);
    } else {
      load_case.targets = declaredMoves(geometry, differences[pose], r0_from_table, load_case.posture);
    }
    if (load_case.targets.empty()) {
      leaveOut(pose, "no reflector was read both unloaded and in this load step");
      continue;
    }
    load_case.wrench = cellWrench(*campaign.load_cell, geometry, load_case.posture, load_case.flange_unloaded,
                                  load_case.flange_loaded, loaded->wrench_in_cell);
    load_case.wrench_unturned = load_case.wrench;
    const int turning = bodyOfCellAxes(*campaign.load_cell, geometry);
    load_case.wrench_turns_with = turning == 6 && load_case.flange_loaded ? 0 : turning;
    cases.push_back(std::move(load_case));
  }
  return cases;
}

}  // namespace stiffscope
