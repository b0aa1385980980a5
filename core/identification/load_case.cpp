#include "core/identification/load_case.h"

#include <fmt/format.h>

#include "core/identification/cell_wrench.h"
#include "core/identification/load_step.h"
#include "core/parallel/on_all_cores.h"
#include "metrology/rigid_registration.h"

namespace stiffscope {

namespace {

std::vector<TargetMove> measuredMoves(const LoadReadings& readings, std::size_t pose, int step,
                                      const Eigen::Isometry3d& r0_from_loading) {
  std::vector<TargetMove> moves;
  if (step == 0) return moves;
  const auto before = readings.points(pose, 0), after = readings.points(pose, step);
  moves.reserve(before.size());
  for (std::size_t target = 0; target < before.size(); ++target) {
    const ReadingSum &unloaded = before[target], &loaded = after[target];
    if (unloaded.readings == 0 || loaded.readings == 0) continue;
    TargetMove& move = moves.emplace_back();
    move.target = static_cast<int>(target);
    move.unloaded = r0_from_loading * unloaded.mean();
    move.loaded = r0_from_loading * loaded.mean();
    move.unloaded_readings = unloaded.readings;
    move.loaded_readings = loaded.readings;
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

/// Displacements without absolute points: put on the model's place of the reflector.
std::vector<TargetMove> declaredMoves(const LoadingGeometry& geometry,
                                      std::span<const ReadingSum> differences,
                                      const Eigen::Matrix3d& r0_from_table, const ArmPosture& posture) {
  std::vector<TargetMove> moves;
  moves.reserve(differences.size());
  for (std::size_t k = 0; k < differences.size(); ++k) {
    const auto& target = geometry.targets_at_zero[k];
    if (!target || differences[k].readings == 0) continue;
    TargetMove& move = moves.emplace_back();
    move.target = static_cast<int>(k);
    move.unloaded = posture.motion[6] * *target;
    move.loaded = move.unloaded + r0_from_table * differences[k].sum;
  }
  return moves;
}

}  // namespace

ArmPosture unloadedPosture(const Robot& arm, const LoadCase& load_case) {
  return postureAt(arm, load_case.q_sagged);
}

const ArmAxes& jacobianAxes(const LoadCase& load_case) {
  return load_case.middle ? *load_case.middle : load_case.axes;
}

Eigen::Vector3d jacobianPoint(const LoadCase& load_case, const Eigen::Vector3d& unloaded,
                              const Eigen::Vector3d& loaded) {
  return load_case.middle ? Eigen::Vector3d(0.5 * (unloaded + loaded)) : unloaded;
}

std::optional<int> heaviestStep(const Campaign& campaign) {
  std::optional<int> heaviest;
  double most = 0.0;
  for (const auto& [step, mean] : meanForces(campaign)) {
    if (step != 0 && mean > most) most = mean, heaviest = step;
  }
  return heaviest;
}

std::vector<LoadCase> loadCases(const Campaign& campaign, const LoadReadings& readings,
                                const LoadingGeometry& geometry, int step,
                                std::vector<std::string>* left_out) {
  std::vector<LoadCase> cases;
  if (!campaign.states || !campaign.load_cell) return cases;
  const bool absolute = campaign.loading.has_value() && geometry.r0_from_loading.has_value();
  if (!absolute && (!campaign.displacements || !geometry.displacements_in_r0)) return cases;
  const int turns_with = bodyOfCellAxes(*campaign.load_cell, geometry);
  // Why a posture has no case; null where it has.
  const auto fill = [&](std::size_t pose, LoadCase& load_case) -> const char* {
    const State *unloaded = readings.state(pose, 0), *loaded = readings.state(pose, step);
    if (loaded == nullptr) return "no state of this load step";
    load_case.pose = static_cast<int>(pose);
    load_case.step = step;
    load_case.q = unloaded ? unloaded->q : loaded->q;
    load_case.servo = loaded->q - load_case.q;
    load_case.absolute = absolute;
    load_case.q_sagged = geometry.sagged(load_case.q);
    const ArmPosture posture = unloadedPosture(geometry.arm, load_case);
    load_case.axes = axesAt(geometry.arm, posture);
    if (absolute) {
      load_case.targets = measuredMoves(readings, pose, step, *geometry.r0_from_loading);
      load_case.flange_unloaded = measuredFlange(geometry, load_case.targets, false);
      load_case.flange_loaded = measuredFlange(geometry, load_case.targets, true);
    } else {
      load_case.targets =
          declaredMoves(geometry, readings.differences(pose, step), *geometry.displacements_in_r0, posture);
    }
    if (load_case.targets.empty()) return "no reflector was read both unloaded and in this load step";
    load_case.wrench = cellWrench(*campaign.load_cell, geometry, posture, load_case.flange_unloaded,
                                  load_case.flange_loaded, loaded->wrench_in_cell);
    load_case.wrench_unturned = load_case.wrench;
    load_case.wrench_turns_with = turns_with == 6 && load_case.flange_loaded ? 0 : turns_with;
    load_case.unturned = posture.motion[static_cast<std::size_t>(load_case.wrench_turns_with)].linear();
    return nullptr;
  };
  cases.resize(readings.poses());
  std::vector<const char*> lacking(cases.size());
  smallWorkOnAllCores(cases.size(), [&](std::size_t pose) { lacking[pose] = fill(pose, cases[pose]); });
  std::size_t kept = 0;
  for (std::size_t pose = 0; pose < cases.size(); ++pose) {
    if (lacking[pose] == nullptr) {
      if (kept != pose) cases[kept] = std::move(cases[pose]);
      ++kept;
    } else if (left_out) {
      left_out->push_back(fmt::format("pose {}: {}", campaign.pose_ids[pose], lacking[pose]));
    }
  }
  cases.resize(kept);
  return cases;
}

std::vector<LoadCase> loadCases(const Campaign& campaign, const LoadingGeometry& geometry, int step,
                                std::vector<std::string>* left_out) {
  return loadCases(campaign, LoadReadings(campaign, {step}), geometry, step, left_out);
}

}  // namespace stiffscope
