#include "core/campaign/check_campaign.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <set>

#include "core/campaign/stated_balancer.h"
#include "core/io/input_error.h"
#include "core/io/units.h"
#include "core/numerics/parallel.h"

namespace stiffscope::campaign {

namespace {

std::string shown(const Campaign& campaign, const std::string& table_file) {
  return (campaign.folder / table_file).string();
}

constexpr std::size_t kBlock = 1 << 15;

std::size_t blocksOf(std::size_t rows) { return (rows + kBlock - 1) / kBlock; }

/// Calls work(block, from, to) for each block of rows from..to-1, on all cores.
template <class Work>
void inBlocks(std::size_t rows, const Work& work) {
  numerics::onAllCores(blocksOf(rows),
                       [&](std::size_t block) { work(block, block * kBlock, std::min(rows, (block + 1) * kBlock)); });
}

std::uint64_t loadState(int pose, int step) {
  return (static_cast<std::uint64_t>(pose) << 32) | static_cast<std::uint32_t>(step);
}

/// Those that a table has rows for, in ascending order.
std::vector<std::uint64_t> loadStates(const std::vector<State>& rows) {
  std::vector<std::uint64_t> states(rows.size());
  inBlocks(rows.size(), [&](std::size_t, std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) states[i] = loadState(rows[i].pose, rows[i].step);
  });
  if (!std::is_sorted(states.begin(), states.end())) std::sort(states.begin(), states.end());
  return states;
}

/// Looks up load states one after the other.
class StateSearch {
 public:
  explicit StateSearch(const std::vector<std::uint64_t>& states) : states_(states) {}

  /// Rows of readings follow those of states mostly: the state last found and the one behind it are looked at first.
  bool has(int pose, int step) {
    const std::uint64_t wanted = loadState(pose, step);
    for (std::size_t ahead = 0; ahead < 2; ++ahead) {
      if (last_ + ahead < states_.size() && states_[last_ + ahead] == wanted) {
        last_ += ahead;
        return true;
      }
    }
    const auto found = std::lower_bound(states_.begin(), states_.end(), wanted);
    last_ = static_cast<std::size_t>(found - states_.begin());
    return found != states_.end() && *found == wanted;
  }

 private:
  const std::vector<std::uint64_t>& states_;
  std::size_t last_ = 0;
};

template <class Row>
void requireStates(const Campaign& campaign, const Table<Row>& table, const std::vector<std::uint64_t>& states) {
  inBlocks(table.rows.size(), [&](std::size_t, std::size_t from, std::size_t to) {
    StateSearch search(states);
    for (std::size_t i = from; i < to; ++i) {
      const Row& row = table.rows[i];
      if (search.has(row.pose, row.step)) continue;
      const std::string& pose = campaign.pose_ids[static_cast<std::size_t>(row.pose)];
      throw io::InputError({shown(campaign, table.file), row.line, "pose, step"}, fmt::format("{}, {}", pose, row.step),
                           fmt::format("expected a load state that {} has a row for", campaign.states->file));
    }
  });
}

void checkStatesCoverReadings(const Campaign& campaign) {
  if (!campaign.states) return;
  const std::vector<std::uint64_t> states = loadStates(campaign.states->rows);
  if (campaign.loading) requireStates(campaign, *campaign.loading, states);
  if (campaign.displacements) requireStates(campaign, *campaign.displacements, states);
}

void checkDisplacedTargetsHavePlaces(const Campaign& campaign) {
  const bool all_have = std::all_of(campaign.targets.begin(), campaign.targets.end(),
                                    [](const Target& target) { return target.position_in_flange.has_value(); });
  if (!campaign.displacements || all_have) return;
  for (const Displacement& row : campaign.displacements->rows) {
    const Target& target = campaign.targets[static_cast<std::size_t>(row.target)];
    if (target.position_in_flange) continue;
    throw io::InputError({shown(campaign, campaign.displacements->file), row.line, "target"}, target.id,
                         "expected a target whose place on the flange campaign.xml gives as x_mm, y_mm, z_mm");
  }
}

void warnOfPosesWithoutStepZero(const Campaign& campaign, std::vector<std::string>& warnings) {
  if (!campaign.loading) return;
  std::vector<bool> unloaded(campaign.pose_ids.size());
  for (const LoadingReading& row : campaign.loading->rows) {
    if (row.step == 0) unloaded[static_cast<std::size_t>(row.pose)] = true;
  }
  const LoadingReading* first = nullptr;
  std::size_t missing = 0;
  for (const LoadingReading& row : campaign.loading->rows) {
    if (unloaded[static_cast<std::size_t>(row.pose)]) continue;
    if (first == nullptr) first = &row;
    unloaded[static_cast<std::size_t>(row.pose)] = true;  // counted once
    ++missing;
  }
  if (first == nullptr) return;
  warnings.push_back(
      io::inputMessage({shown(campaign, campaign.loading->file), first->line, "pose"},
                       campaign.pose_ids[static_cast<std::size_t>(first->pose)],
                       fmt::format("no unloaded step 0, so no displacement; poses without one: {}", missing)));
}

void warnOfAnglesOutsideLimits(const Campaign& campaign, std::vector<std::string>& warnings) {
  if (!campaign.states) return;
  // Controllers and URDFs differ by a few degrees at the stops; more is a wrong column or a wrong robot.
  constexpr double kMargin = 5.0 * io::kDegree;
  struct Outside {
    const State* first = nullptr;
    std::size_t rows = 0;
  };
  const auto joints = static_cast<std::size_t>(campaign.robot.joints());
  PerJoint<double> lower, upper;
  for (const robot::JointLimits& limits : campaign.robot.limits) {
    lower.push_back(limits.lower - kMargin);
    upper.push_back(limits.upper + kMargin);
  }
  const std::vector<State>& states = campaign.states->rows;
  std::vector<PerJoint<Outside>> found(blocksOf(states.size()), PerJoint<Outside>(joints));
  inBlocks(states.size(), [&](std::size_t block, std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      for (std::size_t j = 0; j < joints; ++j) {
        const double q = states[i].q[static_cast<Eigen::Index>(j)];
        if (q >= lower[j] && q <= upper[j]) continue;
        Outside& outside = found[block][j];
        if (outside.rows++ == 0) outside.first = &states[i];
      }
    }
  });
  PerJoint<Outside> outside(joints);
  for (const auto& block : found) {
    for (std::size_t j = 0; j < joints; ++j) {
      if (outside[j].first == nullptr) outside[j].first = block[j].first;
      outside[j].rows += block[j].rows;
    }
  }
  for (std::size_t j = 0; j < joints; ++j) {
    const auto& [first, rows] = outside[j];
    const robot::JointLimits& limits = campaign.robot.limits[j];
    if (first == nullptr) continue;
    warnings.push_back(io::inputMessage(
        {shown(campaign, campaign.states->file), first->line, fmt::format("q{}_deg", j + 1)},
        fmt::format("{:.2f}", first->q[static_cast<Eigen::Index>(j)] / io::kDegree),
        fmt::format("more than 5 deg outside the limits of {} ({:.2f} to {:.2f} deg); rows like this: {}",
                    campaign.robot.joint_names[j], limits.lower / io::kDegree, limits.upper / io::kDegree, rows)));
  }
}

// Wind-up of a gear and the zero of an encoder are fractions of a degree: more is a sign, a gear ratio, a unit, or a
// wrist whose motors drive two joints.
void warnOfMotorSidesApart(const Campaign& campaign, std::vector<std::string>& warnings) {
  if (!campaign.states) return;
  for (Eigen::Index j = 0; j < campaign.robot.joints(); ++j) {
    const State* first = nullptr;
    std::size_t rows = 0;
    for (const State& state : campaign.states->rows) {
      if (!state.hasExtras() || !(std::abs(state.extras().motor_side[j] - state.q[j]) > kMotorSideApart)) continue;
      if (rows++ == 0) first = &state;
    }
    if (first == nullptr) continue;
    warnings.push_back(io::inputMessage(
        {shown(campaign, campaign.states->file), first->line, fmt::format("m{}_deg", j + 1)},
        fmt::format("{:.5f}", first->extras().motor_side[j] / io::kDegree),
        fmt::format("more than {:g} deg from q{}_deg ({:.5f}): not a motor's angle over the gear ratio, in the joint's "
                    "sense; rows like this: {}",
                    kMotorSideApart / io::kDegree, j + 1, first->q[j] / io::kDegree, rows)));
  }
}

// Angles in radians stay below 2 pi, and a campaign that keeps all joints within six degrees is rare.
template <class Row>
void warnOfRadians(const Campaign& campaign, const std::optional<Table<Row>>& table,
                   std::vector<std::string>& warnings) {
  constexpr std::size_t kFewestRows = 10;
  if (!table || table->rows.size() < kFewestRows) return;
  double largest = 0.0;
  for (const Row& row : table->rows) {
    largest = std::max(largest, row.q.cwiseAbs().maxCoeff() / io::kDegree);
    if (largest > 2.0 * std::numbers::pi) return;
  }
  if (largest == 0.0) return;
  warnings.push_back(io::inputMessage(
      {shown(campaign, table->file), 0, fmt::format("q1_deg..q{}_deg", campaign.robot.joints())}, "",
      fmt::format("no joint angle is larger than {:.3f} deg; were they written in radians?", largest)));
}

void warnOfCellWithoutPlace(const Campaign& campaign, std::vector<std::string>& warnings) {
  if (!campaign.states || campaign.load_cell) return;
  const bool loaded = std::any_of(campaign.states->rows.begin(), campaign.states->rows.end(),
                                  [](const State& state) { return !state.wrench_in_cell.isZero(); });
  if (!loaded) return;
  warnings.push_back(io::inputMessage({shown(campaign, campaign.states->file), 0, ""}, "",
                                      "no load_cell in campaign.xml says where these wrenches act"));
}

// A pose without one of its coordinates is none, and turns alone place nothing.
void checkToolPosesAreWhole(const Campaign& campaign) {
  if (!campaign.states) return;
  for (const State& row : campaign.states->rows) {
    if (!row.hasExtras()) continue;
    const StatedPose& stated = row.extras().tool_pose;
    const Eigen::Vector3d &position = stated.position, &rpy = stated.rpy;
    const bool some = !position.array().isNaN().all() || !rpy.array().isNaN().all();
    const bool whole = stated.hasPosition() && (stated.hasTurn() || rpy.array().isNaN().all());
    if (!some || whole) continue;
    throw io::InputError({shown(campaign, campaign.states->file), row.line, "px_mm..pr_deg"}, "",
                         "expected px_mm, py_mm and pz_mm, and all or none of pw_deg, pp_deg and pr_deg, or all blank");
  }
}

/// Where the carriage stood in the rows of one kind: whether all say so, and between which positions.
struct CarriageAt {
  bool given = true;
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  std::size_t line = 0;  ///< the first row that is elsewhere than the first

  template <class Row>
  void see(const std::vector<Row>& rows) {
    for (const Row& row : rows) {
      if (std::isnan(row.rail)) given = false;
      lowest = std::min(lowest, row.rail);
      highest = std::max(highest, row.rail);
      if (line == 0 && highest > lowest) line = row.line;
    }
  }
  bool moves() const { return highest > lowest; }
};

template <class Row>
void checkCarriage(const Campaign& campaign, const std::optional<Table<Row>>& table, CarriageAt& in_tracker_frame) {
  if (!table || table->rows.empty()) return;
  CarriageAt own;
  own.see(table->rows);
  if (campaign.robot.rail && !own.given) {
    throw io::InputError({shown(campaign, table->file), 1, "rail_mm"}, "",
                         fmt::format("expected a column rail_mm, the position of '{}': the arm stands on a rail",
                                     campaign.robot.rail->joint_name));
  }
  if (!campaign.robot.rail && own.given && own.moves()) {
    throw io::InputError({shown(campaign, table->file), own.line, "rail_mm"}, "",
                         "expected an arm that stands still: the URDF has no prismatic joint before the arm's joints");
  }
  if (table->frame == PointFrame::tracker) in_tracker_frame.see(table->rows);
}

/// Where the reflectors went as much farther than rail_mm says as another unit would explain, that unit; else empty.
std::string otherUnitOf(const RailSweep& sweep) {
  struct Stops {
    const RailReading *lowest = nullptr, *highest = nullptr;
  };
  std::map<int, Stops> by_target;
  for (const RailReading& row : sweep.rows) {
    Stops& stops = by_target[row.target];
    if (stops.lowest == nullptr || row.rail < stops.lowest->rail) stops.lowest = &row;
    if (stops.highest == nullptr || row.rail > stops.highest->rail) stops.highest = &row;
  }
  double stated = 0.0, went = 0.0;
  for (const auto& [target, stops] : by_target) {
    const double span = stops.highest->rail - stops.lowest->rail;
    if (span <= stated) continue;
    stated = span;
    went = (stops.highest->point - stops.lowest->point).norm();
  }
  struct Unit {
    const char* name;
    double millimetres;
  };
  constexpr std::array<Unit, 2> kUnits{{{"metres", 1000.0}, {"inches", 25.4}}};
  constexpr double kNear = 0.05;  // rails travel as reported to a few per mille
  for (const Unit& unit : kUnits) {
    if (stated > 0.0 && std::abs(went / (unit.millimetres * stated) - 1.0) < kNear)
      return fmt::format("; the reflectors went {:.1f} mm, as if these were {}", went / io::kMillimetre, unit.name);
  }
  return {};
}

/// The line along which the carriage goes is by the farthest stops.
void checkRailSweep(const Campaign& campaign, const RailSweep& sweep) {
  std::set<double> stops;
  for (const RailReading& row : sweep.rows) stops.insert(row.rail);
  constexpr std::size_t kFewestStops = 3;  // of a line through two stops nothing tells whether it is straight
  constexpr double kShortest = 0.1;        // m; 10 um at both ends then turn it by 0.1 mrad
  if (stops.size() >= kFewestStops && *stops.rbegin() - *stops.begin() >= kShortest) return;
  throw io::InputError(
      {shown(campaign, sweep.file), 0, "rail_mm"}, "",
      fmt::format("expected at least {} positions of the carriage over 100 mm or more; there are {} "
                  "over {:.1f} mm{}",
                  kFewestStops, stops.size(),
                  stops.empty() ? 0.0 : (*stops.rbegin() - *stops.begin()) / io::kMillimetre, otherUnitOf(sweep)));
}

void checkRail(const Campaign& campaign, std::vector<std::string>& warnings) {
  CarriageAt arm;
  checkCarriage(campaign, campaign.circle_sweeps, arm);
  checkCarriage(campaign, campaign.wrist_sweep, arm);
  // What the states' rows say holds for the readings of the loading.
  CarriageAt of_states;
  checkCarriage(campaign, campaign.states, of_states);
  if (campaign.loading && campaign.loading->frame == PointFrame::tracker && campaign.states)
    arm.see(campaign.states->rows);
  if (!campaign.robot.rail) {
    if (!campaign.rail_sweep) return;
    throw io::InputError({shown(campaign, campaign.rail_sweep->file), 0, "rail_sweep"}, "",
                         "expected an arm on a rail: the URDF has no prismatic joint before the arm's joints");
  }
  const robot::Rail& rail = *campaign.robot.rail;
  if (arm.moves() && !campaign.rail_sweep) {
    throw io::InputError({(campaign.folder / "campaign.xml").string(), 0, "rail_sweep"}, "",
                         fmt::format("expected a rail_sweep, which shows how the carriage goes in the tracker's frame: "
                                     "the arm was read at {:.1f} to {:.1f} mm of '{}'",
                                     arm.lowest / io::kMillimetre, arm.highest / io::kMillimetre, rail.joint_name));
  }
  if (campaign.rail_sweep) checkRailSweep(campaign, *campaign.rail_sweep);
  constexpr double kMargin = 0.01;  // m; beyond the stops is another unit or another zero
  CarriageAt seen = arm;
  if (campaign.states) seen.see(campaign.states->rows);
  if (seen.lowest < rail.lower - kMargin || seen.highest > rail.upper + kMargin) {
    warnings.push_back(io::inputMessage(
        {shown(campaign, campaign.states ? campaign.states->file : "campaign.xml"), 0, "rail_mm"}, "",
        fmt::format("the carriage stands at {:.1f} to {:.1f} mm, outside the limits of '{}' ({:.1f} to {:.1f} mm)",
                    seen.lowest / io::kMillimetre, seen.highest / io::kMillimetre, rail.joint_name,
                    rail.lower / io::kMillimetre, rail.upper / io::kMillimetre)));
  }
}

// Of one reflector in one posture all states have to be from one station: a displacement is else that of its pose, too.
void checkPosesAreOfOneStation(const Campaign& campaign) {
  if (campaign.stations.size() < 2) return;
  if (!campaign.tracker) {
    throw io::InputError({shown(campaign, "campaign.xml"), 0, "tracker"}, "",
                         "expected a tracker with its noise: nests join stations by it");
  }
  if (!campaign.loading) return;
  std::vector<const LoadingReading*> first(campaign.pose_ids.size() * campaign.targets.size(), nullptr);
  for (const LoadingReading& row : campaign.loading->rows) {
    const LoadingReading*& before =
        first[static_cast<std::size_t>(row.pose) * campaign.targets.size() + static_cast<std::size_t>(row.target)];
    if (before == nullptr) before = &row;
    if (before->station == row.station) continue;
    throw io::InputError(
        {shown(campaign, campaign.loading->file), row.line, "station"},
        campaign.stations[static_cast<std::size_t>(row.station)].id,
        fmt::format("expected all readings of reflector {} in pose {} from one station; line {} has it from '{}'",
                    campaign.targets[static_cast<std::size_t>(row.target)].id,
                    campaign.pose_ids[static_cast<std::size_t>(row.pose)], before->line,
                    campaign.stations[static_cast<std::size_t>(before->station)].id));
  }
}

using Check = void (*)(const Campaign&, std::vector<std::string>&);

// In the order of their errors and warnings.
constexpr Check kChecks[] = {
    [](const Campaign& campaign, std::vector<std::string>&) { checkDisplacedTargetsHavePlaces(campaign); },
    checkRail,
    warnOfPosesWithoutStepZero,
    warnOfAnglesOutsideLimits,
    warnOfMotorSidesApart,
    [](const Campaign& campaign, std::vector<std::string>& warnings) {
      warnOfRadians(campaign, campaign.circle_sweeps, warnings);
    },
    [](const Campaign& campaign, std::vector<std::string>& warnings) {
      warnOfRadians(campaign, campaign.wrist_sweep, warnings);
    },
    [](const Campaign& campaign, std::vector<std::string>& warnings) {
      warnOfRadians(campaign, campaign.states, warnings);
    },
    warnOfCellWithoutPlace};

}  // namespace

void requireStationsWherePointsAre(const Campaign& campaign, const std::vector<std::string>& names) {
  const auto refuse = [&](const auto& table, const char* expected) {
    const auto named =
        std::find_if(table.rows.begin(), table.rows.end(), [](const auto& row) { return row.station > 0; });
    if (named == table.rows.end()) return;
    throw io::InputError({shown(campaign, table.file), named->line, "station"},
                         names[static_cast<std::size_t>(named->station)], expected);
  };
  const auto inTrackerFrame = [&](const auto& table) {
    if (table && table->frame == PointFrame::base_link)
      refuse(*table, "expected no station in a table whose frame is base_link: its points do not depend on one");
  };
  inTrackerFrame(campaign.circle_sweeps);
  inTrackerFrame(campaign.wrist_sweep);
  inTrackerFrame(campaign.loading);
  inTrackerFrame(campaign.nests);
  if (campaign.displacements)
    refuse(*campaign.displacements,
           "expected no station beside displacements: they are differences, which nests do not join");
}

void checkCampaign(const Campaign& campaign, std::vector<std::string>& warnings) {
  checkPosesAreOfOneStation(campaign);
  checkStatesCoverReadings(campaign);
  checkToolPosesAreWhole(campaign);
  for (const Check& check : kChecks) check(campaign, warnings);
  checkBalancers(campaign, warnings);
}

}  // namespace stiffscope::campaign
