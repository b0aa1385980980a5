#include "core/identification/load_case.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "core/campaign/state_points.h"
#include "core/identification/remarks.h"
#include "core/io/input_error.h"
#include "core/numerics/parallel.h"
#include "metrology/registration.h"

namespace stiffscope::identification {

namespace {

const robot::LinkFrame& linkNamed(const robot::Robot& arm, const std::string& name) {
  for (const robot::LinkFrame& link : arm.links) {
    if (link.name == name) return link;
  }
  throw std::invalid_argument("the load cell names the link '" + name + "', which the robot does not have");
}

/// A link's place: with the flange as given for what is fixed to it, by the posture for the rest.
Eigen::Isometry3d placeOf(const robot::LinkFrame& link, const frames::LoadingGeometry& geometry,
                          const robot::ArmPosture& posture, const std::optional<Eigen::Isometry3d>& flange) {
  if (link.body == geometry.arm.axes() && flange) {
    return *flange * geometry.arm.base_from_flange_at_zero.inverse() * link.base_from_link_at_zero;
  }
  return posture.motion[static_cast<std::size_t>(link.body)] * link.base_from_link_at_zero;
}

}  // namespace

int bodyOfCellAxes(const campaign::LoadCell& cell, const frames::LoadingGeometry& geometry) {
  return linkNamed(geometry.arm, cell.axes_link ? *cell.axes_link : cell.parent).body;
}

robot::Wrench cellWrench(const campaign::LoadCell& cell, const frames::LoadingGeometry& geometry,
                         const robot::ArmPosture& posture, const std::optional<Eigen::Isometry3d>& flange_unloaded,
                         const std::optional<Eigen::Isometry3d>& flange_loaded, const Vector6d& reading) {
  const robot::LinkFrame& parent = linkNamed(geometry.arm, cell.parent);
  const Eigen::Matrix3d axes =
      cell.axes_link ? placeOf(linkNamed(geometry.arm, *cell.axes_link), geometry, posture, flange_loaded).linear()
                     : Eigen::Matrix3d(placeOf(parent, geometry, posture, flange_loaded).linear() *
                                       cell.parent_from_cell.linear());
  return {placeOf(parent, geometry, posture, flange_unloaded) * cell.parent_from_cell.translation(),
          axes * reading.head<3>(), axes * reading.tail<3>()};
}

LoadReadings::LoadReadings(const campaign::Campaign& campaign, std::vector<int> steps)
    : steps_(std::move(steps)),
      poses_(campaign.pose_ids.size()),
      targets_(campaign.targets.size()),
      states_((steps_.size() + 1) * poses_, nullptr),
      largest_force_(poses_, 0.0) {
  const auto asked = [&](int step) { return slot(step) <= steps_.size(); };
  const auto add = [&](const auto& row, const Eigen::Vector3d& value, std::vector<ReadingSum>& table) -> ReadingSum* {
    if (!asked(row.step)) return nullptr;
    ReadingSum& sum =
        table[at(static_cast<std::size_t>(row.pose), row.step) * targets_ + static_cast<std::size_t>(row.target)];
    sum.sum += value;
    ++sum.readings;
    return &sum;
  };
  const auto gatherStates = [&] {
    if (!campaign.states) return;
    for (const campaign::State& state : campaign.states->rows) {
      if (asked(state.step)) states_[at(static_cast<std::size_t>(state.pose), state.step)] = &state;
      double& largest = largest_force_[static_cast<std::size_t>(state.pose)];
      if (state.step != 0) largest = std::max(largest, state.wrench_in_cell.head<3>().norm());
    }
    loaded_ = loadedSteps(campaign);
    std::erase_if(loaded_, [&](int step) { return !asked(step); });
  };
  const auto gatherReadings = [&] {
    if (campaign.loading) {
      points_.resize(states_.size() * targets_);
      for (const campaign::LoadingReading& row : campaign.loading->rows) {
        ReadingSum* const sum = add(row, row.point, points_);
        if (sum != nullptr && sum->readings == 1) sum->station = row.station, sum->from = row.from;
      }
    }
    if (campaign.displacements) {
      differences_.resize(states_.size() * targets_);
      for (const campaign::Displacement& row : campaign.displacements->rows) add(row, row.displacement, differences_);
    }
  };
  numerics::onAllCores(
      2, [&](std::size_t i) { i == 0 ? gatherStates() : gatherReadings(); }, poses_ >= numerics::kWorthThreads);
}

bool LoadReadings::backAtZero(std::size_t pose, int step) const {
  const campaign::State* const own = state(pose, step);
  return own != nullptr && std::find(loaded_.begin(), loaded_.end(), step) != loaded_.end() &&
         own->wrench_in_cell.head<3>().norm() < campaign::kReturnShare * largestForce(pose);
}

std::size_t LoadReadings::slot(int step) const {
  if (step == 0) return 0;
  return 1 + static_cast<std::size_t>(std::find(steps_.begin(), steps_.end(), step) - steps_.begin());
}

std::span<const ReadingSum> LoadReadings::of(const std::vector<ReadingSum>& table, std::size_t pose, int step) const {
  if (table.empty()) return {};
  return {table.data() + at(pose, step) * targets_, targets_};
}

namespace {

io::InputPlace inFile(const campaign::Campaign& campaign, const std::string& file) {
  return {(campaign.folder / file).string(), 0, {}};
}

/// What whatLoadsLack found, as an error in the input.
const char* expectationOf(const Remark& lacking) {
  if (lacking.is(RemarkId::no_states)) {
    return "no 'states': joint angles and load-cell readings are needed to identify";
  }
  if (lacking.is(RemarkId::no_load_cell)) {
    return "no 'load_cell': where the measured wrench acts is needed to identify";
  }
  if (lacking.is(RemarkId::no_wrench)) {
    return "no wrench in 'states' (fx_n to mz_nm): force and moment of each load step are needed to identify";
  }
  return "no readings under load in 'loading' or 'displacements': they are needed to identify";
}

/// Whether load steps were read of which no wrench is given. No cell reads zero in every row.
bool lacksWrenches(const campaign::Campaign& campaign) {
  const std::vector<campaign::State>& states = campaign.states->rows;
  return std::any_of(states.begin(), states.end(), [](const campaign::State& state) { return state.step != 0; }) &&
         std::all_of(states.begin(), states.end(),
                     [](const campaign::State& state) { return state.wrench_in_cell.isZero(); });
}

}  // namespace

Remark whatLoadsLack(const campaign::Campaign& campaign) {
  if (!campaign.states) return Remark(RemarkId::no_states);
  if (!campaign.load_cell) return Remark(RemarkId::no_load_cell);
  if (!campaign.loading && !campaign.displacements) return Remark(RemarkId::no_readings_under_load);
  if (lacksWrenches(campaign)) return Remark(RemarkId::no_wrench);
  if (campaign::isUnloadedDay(campaign)) return Remark(RemarkId::no_readings_under_load);
  return {};
}

std::vector<int> loadSteps(const campaign::Campaign& campaign) {
  std::set<int> steps;
  if (campaign.states) {
    for (const campaign::State& state : campaign.states->rows) steps.insert(state.step);
  }
  steps.erase(0);
  return {steps.begin(), steps.end()};
}

std::map<int, double> meanForces(const campaign::Campaign& campaign) {
  if (!campaign.states) return {};
  struct Forces {
    double sum = 0.0;
    int count = 0;
  };
  std::map<int, Forces> forces;
  auto at = forces.end();
  for (const campaign::State& state : campaign.states->rows) {
    // A posture's steps follow one another in most tables.
    if (at != forces.end() && at->first != state.step) ++at;
    if (at == forces.end() || at->first != state.step) at = forces.try_emplace(state.step).first;
    at->second.sum += state.wrench_in_cell.head<3>().norm();
    ++at->second.count;
  }
  std::map<int, double> means;
  for (const auto& [step, force] : forces) means[step] = force.sum / force.count;
  return means;
}

std::vector<int> loadedSteps(const campaign::Campaign& campaign) {
  const std::map<int, double> forces = meanForces(campaign);
  double most = 0.0;
  for (const auto& [step, force] : forces) {
    if (step != 0) most = std::max(most, force);
  }
  std::vector<int> steps;
  for (const auto& [step, force] : forces) {
    if (step != 0 && most > 0.0 && force >= campaign::kReturnShare * most) steps.push_back(step);
  }
  return steps;
}

int chosenStep(const campaign::Campaign& campaign, const std::optional<int>& asked) {
  const Remark lacking = whatLoadsLack(campaign);
  if (!lacking.empty()) throw io::InputError(inFile(campaign, "campaign.xml"), "", expectationOf(lacking));
  if (asked) {
    const std::vector<int> steps = loadSteps(campaign);
    if (std::find(steps.begin(), steps.end(), *asked) == steps.end()) {
      throw io::InputError(inFile(campaign, campaign.states->file), std::to_string(*asked),
                           steps.empty()
                               ? "not a load step of this campaign, which has none"
                               : fmt::format("not a load step of this campaign, which has {}", fmt::join(steps, ", ")));
    }
    return *asked;
  }
  const auto heaviest = heaviestStep(campaign);
  if (!heaviest) throw io::InputError(inFile(campaign, campaign.states->file), "", "no load step has a force");
  return *heaviest;
}

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
    move.station = unloaded.station;
    move.from = r0_from_loading * unloaded.from;
  }
  return moves;
}

/// base_from_flange from the reflectors: their places on the arm at zero brought onto where they are
/// measured.
std::optional<Eigen::Isometry3d> measuredFlange(const frames::LoadingGeometry& geometry,
                                                const std::vector<TargetMove>& moves, bool loaded) {
  std::vector<Eigen::Vector3d> at_zero, measured;
  at_zero.reserve(moves.size());
  measured.reserve(moves.size());
  for (const TargetMove& move : moves) {
    const auto& target = geometry.targets_at_zero[static_cast<std::size_t>(move.target)];
    if (!target) continue;
    at_zero.push_back(*target);
    measured.push_back(loaded ? move.loaded : move.unloaded);
  }
  // About the line of three that nearly stand on one it would be noise that turns the flange.
  if (metrology::nearlyOnOneLine(at_zero)) return std::nullopt;
  const metrology::RigidRegistration registration = metrology::registerRigid(at_zero, measured);
  if (!registration.determined) return std::nullopt;
  return registration.to_from_source * geometry.arm.base_from_flange_at_zero;
}

/// Displacements without absolute points: put on the model's place of the reflector.
std::vector<TargetMove> declaredMoves(const frames::LoadingGeometry& geometry, std::span<const ReadingSum> differences,
                                      const Eigen::Matrix3d& r0_from_table, const robot::ArmPosture& posture) {
  std::vector<TargetMove> moves;
  moves.reserve(differences.size());
  for (std::size_t k = 0; k < differences.size(); ++k) {
    const auto& target = geometry.targets_at_zero[k];
    if (!target || differences[k].readings == 0) continue;
    TargetMove& move = moves.emplace_back();
    move.target = static_cast<int>(k);
    move.unloaded = posture.motion.back() * *target;
    move.loaded = move.unloaded + r0_from_table * differences[k].sum;
  }
  return moves;
}

}  // namespace

robot::ArmPosture unloadedPosture(const robot::Robot& arm, const LoadCase& load_case) {
  return robot::postureAt(arm, load_case.q_sagged);
}

const robot::ArmAxes& jacobianAxes(const LoadCase& load_case) {
  return load_case.middle ? *load_case.middle : load_case.axes;
}

Eigen::Vector3d jacobianPoint(const LoadCase& load_case, const Eigen::Vector3d& unloaded,
                              const Eigen::Vector3d& loaded) {
  return load_case.middle ? Eigen::Vector3d(0.5 * (unloaded + loaded)) : unloaded;
}

std::optional<int> heaviestStep(const campaign::Campaign& campaign) {
  std::optional<int> heaviest;
  double most = 0.0;
  for (const auto& [step, mean] : meanForces(campaign)) {
    if (step != 0 && mean > most) most = mean, heaviest = step;
  }
  return heaviest;
}

LoadCase caseOfState(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry,
                     const campaign::State& first, const campaign::State& state) {
  LoadCase load_case;
  load_case.pose = state.pose;
  load_case.step = state.step;
  load_case.q = first.q;
  load_case.servo = state.q - first.q;
  load_case.q_sagged = geometry.sagged(load_case.q);
  const robot::ArmPosture posture = unloadedPosture(geometry.arm, load_case);
  load_case.axes = robot::axesAt(geometry.arm, posture);
  const Vector6d reading = state.step == 0 ? Vector6d(Vector6d::Zero()) : state.wrench_in_cell;
  load_case.wrench = cellWrench(*campaign.load_cell, geometry, posture, std::nullopt, std::nullopt, reading);
  load_case.wrench_unturned = load_case.wrench;
  load_case.wrench_turns_with = bodyOfCellAxes(*campaign.load_cell, geometry);
  load_case.unturned = posture.motion[static_cast<std::size_t>(load_case.wrench_turns_with)].linear();
  return load_case;
}

/// Of the posture of the case before.
struct LoadCaseMaker::UnloadedArm {
  std::optional<JointVector> q;  ///< empty: of none yet
  JointVector sagged;
  robot::ArmPosture posture;
  robot::ArmAxes axes;
  boost::container::small_vector<int, kFewReflectors> targets;  ///< by which the flange is measured
  std::optional<Eigen::Isometry3d> flange;
};

LoadCaseMaker::LoadCaseMaker(const campaign::Campaign& campaign, const LoadReadings& readings,
                             const frames::LoadingGeometry& geometry)
    : campaign_(campaign), readings_(readings), geometry_(geometry) {
  if (!campaign.states || !campaign.load_cell) return;
  absolute_ = campaign.loading.has_value() && geometry.r0_from_loading.has_value();
  any_ = absolute_ || (campaign.displacements && geometry.displacements_in_r0);
  if (any_) turns_with_ = bodyOfCellAxes(*campaign.load_cell, geometry);
}

Remark LoadCaseMaker::fill(std::size_t pose, int step, UnloadedArm& arm, LoadCase& load_case) const {
  const campaign::State *unloaded = readings_.state(pose, 0), *loaded = readings_.state(pose, step);
  if (loaded == nullptr) return Remark(RemarkId::no_state_of_step);
  load_case.pose = static_cast<int>(pose);
  load_case.step = step;
  load_case.q = unloaded ? unloaded->q : loaded->q;
  load_case.servo = loaded->q - load_case.q;
  load_case.absolute = absolute_;
  if (!arm.q || *arm.q != load_case.q) {
    arm.q = load_case.q;
    arm.sagged = geometry_.sagged(load_case.q);
    arm.posture = robot::postureAt(geometry_.arm, arm.sagged);
    arm.axes = robot::axesAt(geometry_.arm, arm.posture);
  }
  load_case.q_sagged = arm.sagged;
  load_case.axes = arm.axes;
  if (absolute_) {
    load_case.targets = measuredMoves(readings_, pose, step, *geometry_.r0_from_loading);
    boost::container::small_vector<int, kFewReflectors> targets;
    for (const TargetMove& move : load_case.targets) targets.push_back(move.target);
    if (arm.targets != targets) {
      arm.flange = measuredFlange(geometry_, load_case.targets, false);
      arm.targets = std::move(targets);
    }
    load_case.flange_unloaded = arm.flange;
    load_case.flange_loaded = measuredFlange(geometry_, load_case.targets, true);
  } else {
    load_case.targets =
        declaredMoves(geometry_, readings_.differences(pose, step), *geometry_.displacements_in_r0, arm.posture);
  }
  if (load_case.targets.empty()) return Remark(RemarkId::no_reflector_in_both_states);
  load_case.wrench = cellWrench(*campaign_.load_cell, geometry_, arm.posture, load_case.flange_unloaded,
                                load_case.flange_loaded, loaded->wrench_in_cell);
  load_case.wrench_unturned = load_case.wrench;
  load_case.wrench_turns_with = turns_with_ == geometry_.arm.axes() && load_case.flange_loaded ? 0 : turns_with_;
  load_case.unturned = arm.posture.motion[static_cast<std::size_t>(load_case.wrench_turns_with)].linear();
  return {};
}

Remark LoadCaseMaker::fill(std::size_t pose, int step, LoadCase& load_case) const {
  UnloadedArm arm;
  return fill(pose, step, arm, load_case);
}

std::vector<LoadCase> LoadCaseMaker::ofPose(std::size_t pose) const {
  std::vector<LoadCase> cases;
  if (!any_) return cases;
  cases.reserve(readings_.steps().size());
  UnloadedArm arm;
  for (const int step : readings_.steps()) {
    if (!fill(pose, step, arm, cases.emplace_back()).empty()) cases.pop_back();
  }
  return cases;
}

std::vector<LoadCase> loadCases(const campaign::Campaign& campaign, const LoadReadings& readings,
                                const frames::LoadingGeometry& geometry, int step,
                                std::vector<LeftOutPosture>* left_out) {
  const LoadCaseMaker maker(campaign, readings, geometry);
  std::vector<LoadCase> cases;
  if (!maker.any()) return cases;
  cases.resize(readings.poses());
  std::vector<Remark> lacking(cases.size());
  numerics::smallWorkOnAllCores(cases.size(), [&](std::size_t pose) {
    if (readings.backAtZero(pose, step)) {
      lacking[pose] = Remark(RemarkId::back_at_zero, readings.state(pose, step)->wrench_in_cell.head<3>().norm(),
                             readings.largestForce(pose));
    } else {
      lacking[pose] = maker.fill(pose, step, cases[pose]);
    }
  });
  std::size_t kept = 0;
  for (std::size_t pose = 0; pose < cases.size(); ++pose) {
    if (lacking[pose].empty()) {
      if (kept != pose) cases[kept] = std::move(cases[pose]);
      ++kept;
    } else if (left_out) {
      left_out->push_back({campaign.pose_ids[pose], std::move(lacking[pose])});
    }
  }
  cases.resize(kept);
  return cases;
}

std::vector<LoadCase> loadCases(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry, int step,
                                std::vector<LeftOutPosture>* left_out) {
  return loadCases(campaign, LoadReadings(campaign, {step}), geometry, step, left_out);
}

}  // namespace stiffscope::identification
