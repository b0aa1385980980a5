#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/campaign/row_names.h"
#include "core/identification/warnings.h"
#include "core/io/units.h"
#include "core/mistakes/searched_arm.h"

namespace stiffscope::mistakes {

double missOfGroup(const NominalFit& fit, const ReadingsOfDay& day, int group) {
  double squares = 0.0, count = 0.0;
  for (const UnloadedReading& reading : day.unloaded) {
    if (reading.group != group) continue;
    squares += std::pow(fit.missOf(day, reading), 2);
    count += 1.0;
  }
  return count > 0.0 ? std::sqrt(squares / count) : 0.0;
}

const UnloadedReading& firstOf(const ReadingsOfDay& day, int group) {
  return *std::find_if(day.unloaded.begin(), day.unloaded.end(),
                       [&](const UnloadedReading& reading) { return reading.group == group; });
}

bool mendsGroup(const SearchedArm& arm, double after, double before) {
  constexpr double kAsOthers = 3.0, kLeast = 3e-3;  // m
  return after < kMends * before && after < std::max(kLeast, kAsOthers * arm.found.fit.typical);
}

Remark whereOfGroup(const campaign::Campaign& campaign, const UnloadedReading& first, const std::string& columns,
                    bool of_angles) {
  const std::string file = of_angles ? fileOfAngles(campaign, first.table) : fileOfPoints(campaign, first.table);
  if (first.pose >= 0) {
    std::size_t line = first.line;
    if (of_angles) {
      for (const campaign::State& row : campaign.states->rows) {
        if (row.pose == first.pose && row.step == 0) line = row.line;
      }
    }
    return Remark(RemarkId::at_pose_in, campaign::poseName(campaign, first.pose), columns,
                  campaign::rowName(file, line));
  }
  return Remark(RemarkId::at_sweep_of, first.axis + 1, columns, campaign::rowName(file, first.line));
}

namespace {

/// At most `share` of the groups; empty where more stand apart.
std::vector<int> groupsApart(const SearchedArm& arm, double share) {
  constexpr double kApart = 6.0, kLeast = 10e-3;  // times the median; m
  std::vector<int> apart;
  const double limit = std::max(kLeast, kApart * arm.found.fit.typical);
  for (int g = 0; g < arm.day.groups; ++g) {
    if (arm.found.fit.group_rms[static_cast<std::size_t>(g)] > limit) apart.push_back(g);
  }
  if (static_cast<double>(apart.size()) > share * arm.day.groups) apart.clear();
  return apart;
}

ReadingsOfDay backwards(ReadingsOfDay day, int group) {
  std::map<int, std::vector<UnloadedReading*>> by_target;
  for (UnloadedReading& reading : day.unloaded) {
    if (reading.group == group) by_target[reading.target].push_back(&reading);
  }
  for (auto& [target, rows] : by_target) {
    for (std::size_t i = 0; i < rows.size() / 2; ++i) std::swap(rows[i]->q, rows[rows.size() - 1 - i]->q);
  }
  return day;
}

void searchGroup(SearchedArm& arm, int group) {
  const UnloadedReading& first = firstOf(arm.day, group);
  const double before = missOfGroup(arm.found.fit, arm.day, group);
  const auto here = [group](const UnloadedReading& reading) { return reading.group == group; };
  const auto loads = [&](int pose) { return pose == first.pose; };
  std::vector<ArmCure> cures;
  const auto tryOne = [&](const ReadingsOfDay& day, Suspected suspected, int things) {
    const double after = missOfGroup(arm.found.fit, day, group);
    if (!mendsGroup(arm, after, before)) return;
    ArmCure cure;
    cure.suspected = std::move(suspected);
    cure.things = things;
    cure.rms = after;
    cure.pose = first.pose;
    cure.day = day;
    cures.push_back(std::move(cure));
  };
  for (const ArmMistake& mistake : arm.mistakes) {
    if (!mistake.of_one_group) continue;
    tryOne(takenBack(arm.day, mistake, here, loads),
           {mistake.id,
            whereOfGroup(arm.campaign, first, columnsOf(mistake, arm.day.robot.joints()), isOfAngles(mistake)),
            mistake.remedy(false),
            {}},
           mistake.things);
  }
  if (first.axis >= 0)
    tryOne(backwards(arm.day, group),
           {"row_order",
            whereOfGroup(arm.campaign, first, columnsOfAngles(arm.day.robot.joints()), true),
            Remark(RemarkId::angles_backwards, first.axis + 1),
            {}},
           1);
  if (cures.empty()) return;
  std::stable_sort(cures.begin(), cures.end(), [](const ArmCure& a, const ArmCure& b) { return a.rms < b.rms; });
  const double best = cures.front().rms;
  std::erase_if(cures, [&](const ArmCure& cure) { return cure.rms > kArmAsWell * best; });
  std::stable_sort(cures.begin(), cures.end(), [](const ArmCure& a, const ArmCure& b) { return a.things < b.things; });
  std::erase_if(cures, [&](const ArmCure& cure) { return cure.things > cures.front().things; });
  for (ArmCure& cure : cures) arm.add(std::move(cure), RemarkId::group_misses_arm, before);
}

/// The rigid motion in the base that brings a group's readings onto the model; empty where fewer than three reflectors
/// show it, or none does.
std::optional<Eigen::Isometry3d> motionOf(const SearchedArm& arm, int group) {
  std::vector<Eigen::Vector3d> from, to;
  for (const UnloadedReading& reading : arm.day.unloaded) {
    if (reading.group != group) continue;
    from.push_back(arm.found.fit.measuredPoint(reading));
    to.push_back(arm.found.fit.modelledPoint(arm.day, reading));
  }
  if (from.size() < 3) return std::nullopt;
  Eigen::Matrix3Xd measured(3, from.size()), modelled(3, from.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    measured.col(static_cast<Eigen::Index>(i)) = from[i];
    modelled.col(static_cast<Eigen::Index>(i)) = to[i];
  }
  const Eigen::Isometry3d motion(Eigen::umeyama(measured, modelled, false));
  const double left = std::sqrt((motion * measured - modelled).squaredNorm() / static_cast<double>(from.size()));
  if (!mendsGroup(arm, left, missOfGroup(arm.found.fit, arm.day, group))) return std::nullopt;
  return motion;
}

/// Of postures that stand apart, all by one rigid motion: the station, or the robot, moved before them.
bool searchMovedPostures(SearchedArm& arm, const std::vector<int>& apart) {
  constexpr double kAlike = 20e-3, kTurned = 0.5 * io::kDegree;  // m, rad: ten times what geometry errors make of it
  constexpr std::size_t kFew = 2;
  std::vector<int> poses;
  std::optional<Eigen::Isometry3d> first;
  for (const int group : apart) {
    const std::optional<Eigen::Isometry3d> motion = motionOf(arm, group);
    if (!motion || firstOf(arm.day, group).pose < 0) return false;
    if (!first) first = motion;
    const Eigen::Isometry3d between = first->inverse() * *motion;
    if (between.translation().norm() > kAlike || Eigen::AngleAxisd(between.linear()).angle() > kTurned) return false;
    poses.push_back(firstOf(arm.day, group).pose);
  }
  // All of them are a table from another station, which is sought on its own.
  std::vector<int> all;
  for (const UnloadedReading& reading : arm.day.unloaded) {
    if (reading.pose >= 0 && std::find(all.begin(), all.end(), reading.pose) == all.end()) all.push_back(reading.pose);
  }
  if (poses.size() < kFew || poses.size() == all.size()) return false;
  // In the frame of the points.
  const Eigen::Isometry3d moved = arm.found.fit.base_from_points.inverse() * *first * arm.found.fit.base_from_points;
  std::sort(poses.begin(), poses.end());
  ArmCure cure;
  cure.suspected = {
      "other_station",
      Remark(RemarkId::at_poses_in, campaign::poseName(arm.campaign, poses.front()),
             campaign::poseName(arm.campaign, poses.back()), std::string("x_mm, y_mm, z_mm"),
             fileOfPoints(arm.campaign, SourceTable::loading)),
      Remark(RemarkId::other_station, moved.translation().norm(), Eigen::AngleAxisd(moved.linear()).angle()),
      {}};
  cure.day = arm.day;
  const auto isMoved = [&](int pose) { return std::find(poses.begin(), poses.end(), pose) != poses.end(); };
  for (UnloadedReading& reading : cure.day.unloaded) {
    if (isMoved(reading.pose)) reading.point = moved * reading.point;
  }
  for (LoadedReading& reading : cure.day.loaded) {
    if (!isMoved(reading.pose)) continue;
    for (ReflectorMove& move : reading.moves) move.displacement = moved.linear() * move.displacement;
  }
  cure.rms = fitNominal(cure.day).rms;
  arm.add(std::move(cure));
  return true;
}

/// One posture that no usual mistake brings back, but a motion as a whole.
void searchMotion(SearchedArm& arm, int group) {
  const UnloadedReading& first = firstOf(arm.day, group);
  const std::optional<Eigen::Isometry3d> motion = first.pose >= 0 ? motionOf(arm, group) : std::nullopt;
  if (!motion) return;
  Eigen::Vector3d at = Eigen::Vector3d::Zero(), there = at;
  double count = 0.0;
  for (const UnloadedReading& reading : arm.day.unloaded) {
    if (reading.group != group) continue;
    at += arm.found.fit.measuredPoint(reading);
    there += arm.found.fit.modelledPoint(arm.day, reading);
    count += 1.0;
  }
  ArmCure cure;
  cure.suspected = {
      "other_station",
      whereOfGroup(arm.campaign, first, "x_mm, y_mm, z_mm", false),
      Remark(RemarkId::elsewhere, (there - at).norm() / count, Eigen::AngleAxisd(motion->linear()).angle()),
      {}};
  cure.pose = first.pose;
  cure.day = arm.day;
  cure.rms = arm.found.fit.typical;
  arm.add(std::move(cure), RemarkId::group_misses_arm, missOfGroup(arm.found.fit, arm.day, group));
}

/// Without the readings of one reflector at a posture, or in a table.
ReadingsOfDay withoutReflector(ReadingsOfDay day, int target, std::optional<int> pose,
                               std::optional<SourceTable> table) {
  std::erase_if(day.unloaded, [&](const UnloadedReading& one) {
    return one.target == target && (pose ? one.pose == *pose : one.table == table);
  });
  for (LoadedReading& reading : day.loaded) {
    if (pose ? reading.pose != *pose : table != SourceTable::loading) continue;
    std::erase_if(reading.moves, [&](const ReflectorMove& move) { return move.target == target; });
  }
  return day;
}

}  // namespace

void searchGroups(SearchedArm& arm) {
  if (searchLostRow(arm)) return;
  constexpr double kSome = 1.0 / 3.0, kMany = 0.6;  // of the groups
  if (searchMovedPostures(arm, groupsApart(arm, kMany))) return;
  const std::vector<int> apart = groupsApart(arm, kSome);
  if (apart.empty()) return;
  if (searchExchangedAngles(arm, apart)) return;
  for (const int group : apart) {
    if (searchRepeatedAngles(arm, group)) continue;
    const std::size_t before = arm.found.cures.size();
    searchGroup(arm, group);
    if (arm.found.cures.size() == before) searchMotion(arm, group);
  }
}

bool searchReadTwice(SearchedArm& arm) {
  constexpr double kOne = 2e-3, kShare = 0.05;  // m, nearer than any two stand; of the largest distance in that state,
                                                // which a unit shrinks as well
  constexpr double kOfStates = 0.9;             // of the states of a table
  using State = std::map<int, const UnloadedReading*>;  // by target
  std::map<std::pair<int, std::vector<double>>, State> states;
  for (const UnloadedReading& reading : arm.day.unloaded)
    states[{reading.group, std::vector<double>(reading.q.begin(), reading.q.end())}][reading.target] = &reading;
  struct Pair {
    double states = 0.0, near = 0.0, apart = 0.0;
  };
  std::map<std::pair<int, int>, std::pair<std::map<SourceTable, Pair>, std::map<int, Pair>>> pairs;
  for (const auto& [key, state] : states) {
    double largest = 0.0;
    std::map<std::pair<int, int>, double> apart;
    for (const auto& [a, first] : state) {
      for (const auto& [b, second] : state) {
        if (b <= a) continue;
        apart[{a, b}] = (first->point - second->point).norm();
        largest = std::max(largest, apart[{a, b}]);
      }
    }
    const UnloadedReading& any = *state.begin()->second;
    for (const auto& [names, distance] : apart) {
      const bool near = distance < std::min(kOne, kShare * largest);
      for (Pair* pair : {&pairs[names].first[any.table], &pairs[names].second[any.pose]}) {
        pair->states += 1.0;
        if (!near) continue;
        pair->near += 1.0;
        pair->apart = std::max(pair->apart, distance);
      }
    }
  }

  bool found = false;
  const auto take = [&](const std::pair<int, int>& names, Remark where, double apart, std::optional<int> pose,
                        std::optional<SourceTable> table) {
    const auto nameOf = [&](int target) {
      return campaign::targetName(arm.campaign, arm.day.campaign_target[static_cast<std::size_t>(target)]);
    };
    ArmCure cure;
    cure.suspected = {"reflectors_exchanged",
                      std::move(where),
                      Remark(RemarkId::reflector_twice, nameOf(names.first), nameOf(names.second), apart),
                      {}};
    cure.pose = pose;
    cure.rms = INFINITY;
    // Either may be the one that was not read: without it the others fit.
    for (const int absent : {names.first, names.second}) {
      ReadingsOfDay day = withoutReflector(arm.day, absent, pose, table);
      const double rms = fitNominal(day).rms;
      if (rms >= cure.rms) continue;
      cure.rms = rms;
      cure.day = std::move(day);
    }
    arm.add(std::move(cure));
    found = true;
  };
  for (const auto& [names, of] : pairs) {
    bool in_table = false;
    for (const auto& [table, pair] : of.first) {
      constexpr double kFew = 3.0;
      if (pair.near < kOfStates * pair.states || pair.near < kFew) continue;
      in_table = true;
      take(names,
           Remark(RemarkId::in_columns, std::string("target"),
                  std::vector<std::string>{fileOfPoints(arm.campaign, table)}),
           pair.apart, {}, table);
    }
    for (const auto& [pose, pair] : of.second) {
      if (in_table || pose < 0 || pair.near < 1.0) continue;
      const auto first = std::find_if(arm.day.unloaded.begin(), arm.day.unloaded.end(),
                                      [pose = pose](const UnloadedReading& one) { return one.pose == pose; });
      take(names, whereOfGroup(arm.campaign, *first, "target", false), pair.apart, pose, {});
    }
  }
  return found;
}

void searchExchangedSweeps(SearchedArm& arm) {
  const int joints = arm.campaign.robot.joints();
  for (int a = 0; a < joints; ++a) {
    for (int b = a + 1; b < joints; ++b) {
      ReadingsOfDay day = arm.day;
      std::map<int, std::array<std::vector<UnloadedReading*>, 2>> by_target;
      for (UnloadedReading& reading : day.unloaded) {
        if (reading.axis == a) by_target[reading.target][0].push_back(&reading);
        if (reading.axis == b) by_target[reading.target][1].push_back(&reading);
      }
      bool same = !by_target.empty();
      for (auto& [target, rows] : by_target) {
        same &= rows[0].size() == rows[1].size();
        for (std::size_t i = 0; same && i < rows[0].size(); ++i) std::swap(rows[0][i]->point, rows[1][i]->point);
      }
      if (!same) continue;
      const double rms = fitNominal(day).rms;
      if (!arm.mends(rms)) continue;
      ArmCure cure;
      cure.suspected = {"sweeps_exchanged",
                        Remark(RemarkId::in_columns, std::string("x_mm, y_mm, z_mm"),
                               std::vector<std::string>{arm.campaign.circle_sweeps->file}),
                        Remark(RemarkId::sweeps_exchanged, a + 1, b + 1),
                        {}};
      cure.rms = rms;
      cure.day = std::move(day);
      arm.add(std::move(cure));
      return;
    }
  }
}

bool searchLabels(SearchedArm& arm) {
  if (!arm.campaign.circle_sweeps) return true;
  const auto joints = static_cast<std::size_t>(arm.campaign.robot.joints());
  const JointVector infinite = JointVector::Constant(arm.campaign.robot.joints(), INFINITY);
  PerJoint<JointVector> least(joints, infinite), most(joints, -infinite);
  PerJoint<bool> swept(joints, false);
  PerJoint<std::size_t> lines(joints);
  for (const campaign::CircleReading& row : arm.campaign.circle_sweeps->rows) {
    const auto axis = static_cast<std::size_t>(row.axis);
    if (!swept[axis]) lines[axis] = row.line;
    least[axis] = least[axis].cwiseMin(row.q);
    most[axis] = most[axis].cwiseMax(row.q);
    swept[axis] = true;
  }
  std::vector<int> labels;
  std::size_t line = 0;
  for (std::size_t axis = 0; axis < joints; ++axis) {
    if (!swept[axis]) continue;
    Eigen::Index turns = 0;
    const JointVector range = most[axis] - least[axis];
    const double largest = range.maxCoeff(&turns);
    // A joint that is told with its neighbour turns as far as that.
    constexpr double kStill = 0.1;
    if (range[static_cast<Eigen::Index>(axis)] > kStill * largest) continue;
    if (labels.empty()) line = lines[axis];
    labels.push_back(static_cast<int>(axis) + 1);
    labels.push_back(static_cast<int>(turns) + 1);
  }
  if (labels.empty()) return true;
  // More than half of them is an order of joints, not one of labels.
  constexpr std::size_t kMost = 3;
  if (labels.size() / 2 > kMost || arm.found.fit.rms > identification::kMissedGeometry) return false;
  ArmCure cure;
  cure.suspected = {"sweeps_exchanged",
                    Remark(RemarkId::in_columns, std::string("axis"),
                           std::vector<std::string>{campaign::rowName(arm.campaign.circle_sweeps->file, line)}),
                    Remark(RemarkId::labels_exchanged, labels),
                    {}};
  cure.rms = arm.found.fit.rms;
  cure.day = arm.day;
  arm.add(std::move(cure));
  return false;
}

}  // namespace stiffscope::mistakes
