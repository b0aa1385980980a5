#include "core/mistakes/arm_search.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "core/campaign/row_names.h"
#include "core/identification/warnings.h"
#include "core/io/units.h"
#include "core/mistakes/arm_mistakes.h"
#include "core/mistakes/remarks.h"
#include "core/numerics/parallel.h"
#include "core/numerics/resampling.h"
#include "core/robot/kinematics.h"

namespace stiffscope::mistakes {

namespace {

/// A cure leaves at most this share of what the readings missed the arm by.
constexpr double kMends = 0.25;
/// Cures whose misfits differ by less mend equally well: masses and geometry errors move them by as much.
constexpr double kArmAsWell = 1.3;

using Tables = std::vector<SourceTable>;

bool holds(const Tables& tables, SourceTable table) {
  return std::find(tables.begin(), tables.end(), table) != tables.end();
}

Tables tablesOf(const ReadingsOfDay& day) {
  Tables tables;
  for (const SourceTable table : kSourceTables) {
    if (std::any_of(day.unloaded.begin(), day.unloaded.end(),
                    [&](const UnloadedReading& reading) { return reading.table == table; }))
      tables.push_back(table);
  }
  return tables;
}

/// All sets of tables, the whole first.
std::vector<Tables> setsOf(const Tables& tables) {
  std::vector<Tables> sets;
  for (unsigned set = (1U << tables.size()) - 1; set > 0; --set) {
    Tables some;
    for (std::size_t k = 0; k < tables.size(); ++k) {
      if ((set >> k & 1U) != 0) some.push_back(tables[k]);
    }
    sets.push_back(std::move(some));
  }
  return sets;
}

std::vector<std::string> filesOf(const campaign::Campaign& campaign, const Tables& tables, bool of_angles) {
  std::vector<std::string> files;
  for (const SourceTable table : tables)
    files.push_back(of_angles ? fileOfAngles(campaign, table) : fileOfPoints(campaign, table));
  return files;
}

const char* columnsOf(const ArmMistake& mistake) {
  if (mistake.points) return "x_mm, y_mm, z_mm";
  return mistake.targets.empty() ? "q1_deg to q6_deg" : "target";
}

std::vector<std::string> namesOf(const campaign::Campaign& campaign) {
  std::vector<std::string> names;
  for (const campaign::Target& target : campaign.targets) names.push_back(target.id);
  return names;
}

class Search {
 public:
  Search(const campaign::Campaign& campaign, const ReadingsOfDay& day)
      : campaign_(campaign), day_(day), tables_(tablesOf(day)), sets_(setsOf(tables_)) {}

  ArmSearch run() {
    found_.fit = fitNominal(day_);
    if (!found_.fit.done) return std::move(found_);
    found_.contradicts = found_.fit.typical > identification::kMissedGeometry || aTableIsFarOff();
    searchLabels();
    if (found_.fit.rms > kSuspicious) {
      table_ = armMistakes(day_, namesOf(campaign_));
      if (labelled_) searchExchangedSweeps();
      if (found_.cures.empty()) searchTables();
      if (found_.cures.empty()) searchGroups();
      if (found_.cures.empty()) searchZeros();
      if (found_.cures.empty()) searchOrigins();
      if (found_.cures.empty()) searchTableScales();
      if (found_.cures.empty()) searchStations();
      if (found_.cures.empty()) searchPairs();
    }
    if (found_.cures.empty()) searchScale();
    if (found_.cures.empty()) searchBase();
    return std::move(found_);
  }

 private:
  struct Trial {
    const ArmMistake* mistake = nullptr;
    const ArmMistake* second = nullptr;
    Tables tables, second_tables;
    double rms = 0.0;
    int things() const { return mistake->things + (second != nullptr ? second->things : 0); }
  };

  bool mends(double rms) const { return rms < kMends * found_.fit.rms && rms < identification::kMissedGeometry; }

  static ReadingsOfDay with(const ReadingsOfDay& day, const ArmMistake& mistake, const Tables& tables) {
    return takenBack(
        day, mistake, [&](const UnloadedReading& reading) { return holds(tables, reading.table); },
        [&](int) { return holds(tables, SourceTable::loading); });
  }

  bool canBeIn(const ArmMistake& mistake, const Tables& tables) const {
    return tables.size() == tables_.size() ? mistake.of_all_tables || tables_.size() == 1 : mistake.of_some_tables;
  }

  ReadingsOfDay dayOf(const Trial& trial) const {
    ReadingsOfDay day = with(day_, *trial.mistake, trial.tables);
    return trial.second == nullptr ? day : with(day, *trial.second, trial.second_tables);
  }

  void screen(std::vector<Trial>& trials) const {
    numerics::onAllCores(trials.size(), [&](std::size_t i) { trials[i].rms = affineMisfit(dayOf(trials[i])); });
  }

  /// Those whose affine misfit leaves it open that they mend, fitted in full. Of shifted rows the one at the end has no
  /// right angles anywhere: they are judged without the worst group, which the affine misfit cannot leave out.
  void fitAll(std::vector<Trial>& trials) const {
    screen(trials);
    const auto shifts = [](const Trial& trial) { return trial.mistake->row != AnglesRow::own; };
    std::erase_if(trials, [&](const Trial& trial) {
      return !shifts(trial) && !mends(trial.rms / 3.0);  // no sag in it: thrice as lax
    });
    numerics::onAllCores(trials.size(), [&](std::size_t i) {
      const NominalFit fit = fitNominal(dayOf(trials[i]));
      trials[i].rms = shifts(trials[i]) ? fit.rmsButForWorst() : fit.rms;
    });
    std::erase_if(trials, [&](const Trial& trial) { return !mends(trial.rms); });
  }

  void searchTables() {
    std::vector<Trial> trials;
    for (const Tables& tables : sets_) {
      for (const ArmMistake& mistake : table_) {
        if (canBeIn(mistake, tables)) trials.push_back({&mistake, nullptr, tables, {}});
      }
    }
    fitAll(trials);
    keep(std::move(trials));
  }

  void searchPairs() {
    // The second is sought about those firsts that come nearest, and in the same tables or in all.
    constexpr std::size_t kFirsts = 12;
    std::vector<Trial> firsts;
    for (const Tables& tables : sets_) {
      for (const ArmMistake& mistake : table_) {
        if (!canBeIn(mistake, tables) || mistake.things > 2) continue;
        firsts.push_back({&mistake, nullptr, tables, {}});
      }
    }
    screen(firsts);
    std::stable_sort(firsts.begin(), firsts.end(), [](const Trial& a, const Trial& b) { return a.rms < b.rms; });
    if (firsts.size() > kFirsts) firsts.resize(kFirsts);
    std::vector<Trial> trials;
    for (const Trial& first : firsts) {
      for (const Tables& tables : sets_) {
        if (tables != first.tables && tables.size() != tables_.size()) continue;
        for (const ArmMistake& mistake : table_) {
          if (!canBeIn(mistake, tables) || &mistake == first.mistake || mistake.things > 3) continue;
          trials.push_back({first.mistake, &mistake, first.tables, tables});
        }
      }
    }
    fitAll(trials);
    keep(std::move(trials));
  }

  void keep(std::vector<Trial> trials) {
    if (trials.empty()) return;
    double best = INFINITY;
    for (const Trial& trial : trials) best = std::min(best, trial.rms);
    std::erase_if(trials, [&](const Trial& trial) { return trial.rms > kArmAsWell * best; });
    std::stable_sort(trials.begin(), trials.end(), [](const Trial& a, const Trial& b) {
      return std::pair(a.things(), -static_cast<int>(a.tables.size())) <
             std::pair(b.things(), -static_cast<int>(b.tables.size()));
    });
    constexpr std::size_t kMost = 12;
    if (trials.size() > kMost) trials.resize(kMost);
    for (Trial& trial : trials) {
      ArmCure cure;
      cure.things = trial.things();
      cure.rms = trial.rms;
      const auto one = [&](const ArmMistake& mistake, const Tables& tables) {
        return mistake.remedy(tables.size() == tables_.size());
      };
      cure.suspected.mistake = trial.mistake->id;
      cure.suspected.where = whereOf(*trial.mistake, trial.tables);
      cure.suspected.remedy = one(*trial.mistake, trial.tables);
      if (trial.second != nullptr) {
        cure.suspected.remedy =
            Remark(RemarkId::both, std::vector<Remark>{cure.suspected.remedy, one(*trial.second, trial.second_tables),
                                                       whereOf(*trial.second, trial.second_tables)});
      }
      cure.day = dayOf(trial);
      add(std::move(cure));
    }
  }

  Remark whereOf(const ArmMistake& mistake, const Tables& tables) const {
    if (mistake.robot_size != 1.0) return Remark(RemarkId::in_urdf);
    return Remark(RemarkId::in_columns, std::string(columnsOf(mistake)),
                  filesOf(campaign_, tables, !mistake.points && mistake.targets.empty()));
  }

  void add(ArmCure cure, RemarkId shows = RemarkId::misses_arm, std::optional<double> before = {}) {
    cure.suspected.before = before.value_or(found_.fit.rms);
    cure.suspected.after = cure.rms;
    cure.suspected.shown = Remark(shows, cure.suspected.before, cure.suspected.after);
    cure.fit = fitNominal(cure.day);
    found_.cures.push_back(std::move(cure));
  }

  /// Most of what one table has is far from the arm, whatever the others are.
  bool aTableIsFarOff() const {
    constexpr double kFar = 5.0 * identification::kMissedGeometry;
    for (const SourceTable table : tables_) {
      std::vector<double> groups;
      int last = -1;
      for (const UnloadedReading& reading : day_.unloaded) {
        if (reading.table != table || reading.group == last) continue;
        last = reading.group;
        groups.push_back(found_.fit.group_rms[static_cast<std::size_t>(last)]);
      }
      if (numerics::upperMedian(groups) > kFar) return true;
    }
    return false;
  }

  // One posture, or one sweep, apart from the others: the fit stands on these.

  std::vector<int> groupsApart() const {
    constexpr double kApart = 6.0, kLeast = 10e-3, kFew = 1.0 / 3.0;  // times the median; m; of the groups
    std::vector<int> apart;
    const double limit = std::max(kLeast, kApart * found_.fit.typical);
    for (int g = 0; g < day_.groups; ++g) {
      if (found_.fit.group_rms[static_cast<std::size_t>(g)] > limit) apart.push_back(g);
    }
    if (static_cast<double>(apart.size()) > kFew * day_.groups) apart.clear();
    return apart;
  }

  double missOfGroup(const ReadingsOfDay& day, int group) const {
    double squares = 0.0, count = 0.0;
    for (const UnloadedReading& reading : day.unloaded) {
      if (reading.group != group) continue;
      squares += std::pow(found_.fit.missOf(day, reading), 2);
      count += 1.0;
    }
    return count > 0.0 ? std::sqrt(squares / count) : 0.0;
  }

  const UnloadedReading& firstOf(int group) const {
    return *std::find_if(day_.unloaded.begin(), day_.unloaded.end(),
                         [&](const UnloadedReading& reading) { return reading.group == group; });
  }

  bool mendsGroup(double after, double before) const {
    constexpr double kAsOthers = 3.0, kLeast = 3e-3;  // m
    return after < kMends * before && after < std::max(kLeast, kAsOthers * found_.fit.typical);
  }

  Remark whereOfGroup(const UnloadedReading& first, const char* columns, bool of_angles) const {
    const std::string file = of_angles ? fileOfAngles(campaign_, first.table) : fileOfPoints(campaign_, first.table);
    if (first.pose >= 0) {
      std::size_t line = first.line;
      if (of_angles) {
        for (const campaign::State& row : campaign_.states->rows) {
          if (row.pose == first.pose && row.step == 0) line = row.line;
        }
      }
      return Remark(RemarkId::at_pose_in, campaign::poseName(campaign_, first.pose), std::string(columns),
                    campaign::rowName(file, line));
    }
    return Remark(RemarkId::at_sweep_of, first.axis + 1, std::string(columns), campaign::rowName(file, first.line));
  }

  void searchGroups() {
    const std::vector<int> apart = groupsApart();
    if (apart.empty()) return;
    if (searchExchangedAngles(apart)) return;
    for (const int group : apart) searchGroup(group);
  }

  void searchGroup(int group) {
    const UnloadedReading& first = firstOf(group);
    const double before = missOfGroup(day_, group);
    const auto here = [group](const UnloadedReading& reading) { return reading.group == group; };
    const auto loads = [&](int pose) { return pose == first.pose; };
    std::vector<ArmCure> cures;
    const auto tryOne = [&](const ReadingsOfDay& day, Suspected suspected, int things) {
      const double after = missOfGroup(day, group);
      if (!mendsGroup(after, before)) return;
      ArmCure cure;
      cure.suspected = std::move(suspected);
      cure.things = things;
      cure.rms = after;
      cure.pose = first.pose;
      cure.day = day;
      cures.push_back(std::move(cure));
    };
    for (const ArmMistake& mistake : table_) {
      if (!mistake.of_one_group) continue;
      const bool of_angles = !mistake.points && mistake.targets.empty();
      tryOne(takenBack(day_, mistake, here, loads),
             {mistake.id, whereOfGroup(first, columnsOf(mistake), of_angles), mistake.remedy(false), {}},
             mistake.things);
    }
    if (first.axis >= 0)
      tryOne(backwards(group),
             {"row_order",
              whereOfGroup(first, "q1_deg to q6_deg", true),
              Remark(RemarkId::angles_backwards, first.axis + 1),
              {}},
             1);
    if (cures.empty()) return;
    std::stable_sort(cures.begin(), cures.end(), [](const ArmCure& a, const ArmCure& b) { return a.rms < b.rms; });
    const double best = cures.front().rms;
    std::erase_if(cures, [&](const ArmCure& cure) { return cure.rms > kArmAsWell * best; });
    std::stable_sort(cures.begin(), cures.end(),
                     [](const ArmCure& a, const ArmCure& b) { return a.things < b.things; });
    std::erase_if(cures, [&](const ArmCure& cure) { return cure.things > cures.front().things; });
    for (ArmCure& cure : cures) add(std::move(cure), RemarkId::group_misses_arm, before);
  }

  ReadingsOfDay backwards(int group) const {
    ReadingsOfDay day = day_;
    std::map<int, std::vector<UnloadedReading*>> by_target;
    for (UnloadedReading& reading : day.unloaded) {
      if (reading.group == group) by_target[reading.target].push_back(&reading);
    }
    for (auto& [target, rows] : by_target) {
      for (std::size_t i = 0; i < rows.size() / 2; ++i) std::swap(rows[i]->q, rows[rows.size() - 1 - i]->q);
    }
    return day;
  }

  bool searchExchangedAngles(const std::vector<int>& apart) {
    for (std::size_t a = 0; a < apart.size(); ++a) {
      for (std::size_t b = a + 1; b < apart.size(); ++b) {
        const UnloadedReading first = firstOf(apart[a]), second = firstOf(apart[b]);
        if (first.pose < 0 || second.pose < 0) continue;
        ReadingsOfDay day = day_;
        for (UnloadedReading& reading : day.unloaded) {
          if (reading.pose == first.pose) reading.q = second.q;
          if (reading.pose == second.pose) reading.q = first.q;
        }
        for (LoadedReading& reading : day.loaded) {
          if (reading.pose == first.pose)
            reading.q = second.q;
          else if (reading.pose == second.pose)
            reading.q = first.q;
        }
        const double before = missOfGroup(day_, apart[a]);
        const double after = std::max(missOfGroup(day, apart[a]), missOfGroup(day, apart[b]));
        if (!mendsGroup(after, before)) continue;
        ArmCure cure;
        cure.suspected = {"row_order",
                          whereOfGroup(first, "q1_deg to q6_deg", true),
                          Remark(RemarkId::angles_exchanged, campaign::poseName(campaign_, first.pose),
                                 campaign::poseName(campaign_, second.pose)),
                          {}};
        cure.rms = after;
        cure.pose = first.pose;
        cure.day = std::move(day);
        add(std::move(cure), RemarkId::group_misses_arm, before);
        return true;
      }
    }
    return false;
  }

  // Sweeps.

  /// Readings of the sweeps of two axes exchanged, each under the other's angles.
  void searchExchangedSweeps() {
    for (int a = 0; a < 6; ++a) {
      for (int b = a + 1; b < 6; ++b) {
        ReadingsOfDay day = day_;
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
        if (!mends(rms)) continue;
        ArmCure cure;
        cure.suspected = {"sweeps_exchanged",
                          Remark(RemarkId::in_columns, std::string("x_mm, y_mm, z_mm"),
                                 std::vector<std::string>{campaign_.circle_sweeps->file}),
                          Remark(RemarkId::sweeps_exchanged, a + 1, b + 1),
                          {}};
        cure.rms = rms;
        cure.day = std::move(day);
        add(std::move(cure));
        return;
      }
    }
  }

  /// Sweeps whose label names another axis than the one that turns.
  void searchLabels() {
    if (!campaign_.circle_sweeps) return;
    std::array<Vector6d, 6> least, most;
    std::array<bool, 6> swept{};
    for (std::size_t k = 0; k < 6; ++k) least[k].setConstant(INFINITY), most[k].setConstant(-INFINITY);
    std::array<std::size_t, 6> lines{};
    for (const campaign::CircleReading& row : campaign_.circle_sweeps->rows) {
      const auto axis = static_cast<std::size_t>(row.axis);
      if (!swept[axis]) lines[axis] = row.line;
      least[axis] = least[axis].cwiseMin(row.q);
      most[axis] = most[axis].cwiseMax(row.q);
      swept[axis] = true;
    }
    std::vector<int> labels;
    std::size_t line = 0;
    for (std::size_t axis = 0; axis < 6; ++axis) {
      if (!swept[axis]) continue;
      Eigen::Index turns = 0;
      const Vector6d range = most[axis] - least[axis];
      const double largest = range.maxCoeff(&turns);
      // A joint that is told with its neighbour turns as far as that.
      constexpr double kStill = 0.1;
      if (range[static_cast<Eigen::Index>(axis)] > kStill * largest) continue;
      if (labels.empty()) line = lines[axis];
      labels.push_back(static_cast<int>(axis) + 1);
      labels.push_back(static_cast<int>(turns) + 1);
    }
    labelled_ = labels.empty();
    // More than half of them is an order of joints, not one of labels.
    constexpr std::size_t kMost = 3;
    if (labels.empty() || labels.size() / 2 > kMost || found_.fit.rms > identification::kMissedGeometry) return;
    ArmCure cure;
    cure.suspected = {"sweeps_exchanged",
                      Remark(RemarkId::in_columns, std::string("axis"),
                             std::vector<std::string>{campaign::rowName(campaign_.circle_sweeps->file, line)}),
                      Remark(RemarkId::labels_exchanged, labels),
                      {}};
    cure.rms = found_.fit.rms;
    cure.day = day_;
    add(std::move(cure));
  }

  // What has a size of its own.

  /// A joint's zero, in all tables or in one.
  void searchZeros() {
    std::optional<ArmCure> best;
    for (const Tables& tables : sets_) {
      if (tables.size() > 1 && tables.size() < tables_.size()) continue;
      for (int joint = 0; joint < 6; ++joint) {
        const auto shifted = [&](double by) {
          ArmMistake mistake;
          mistake.angles = [joint, by](Vector6d& q) { q[joint] += by; };
          return with(day_, mistake, tables);
        };
        const auto misfit = [&](double by) { return affineMisfit(shifted(by)); };
        const double by = snapped(leastOver(misfit), shifted);
        constexpr double kLeastShift = 2.0 * io::kDegree;  // smaller ones are a machine's, not a convention's
        if (std::abs(by) < kLeastShift) continue;
        ReadingsOfDay day = shifted(by);
        const double rms = fitNominal(day).rms;
        if (!mends(rms) || (best && rms >= best->rms)) continue;
        best.emplace();
        ArmMistake angles;
        angles.angles = [](Vector6d&) {};
        best->suspected = {"joint_zero",
                           whereOf(angles, tables),
                           Remark(RemarkId::shift_zero, joint + 1, by, tables.size() == tables_.size()),
                           {}};
        best->rms = rms;
        best->day = std::move(day);
      }
    }
    if (best) add(std::move(*best));
  }

  /// A right angle where one is near.
  template <class Shifted>
  static double snapped(double by, const Shifted& shifted) {
    constexpr double kRight = 90.0 * io::kDegree, kNear = 4.0 * io::kDegree;
    const double right = kRight * std::round(by / kRight);
    if (right == 0.0 || std::abs(by - right) > kNear) return by;
    return fitNominal(shifted(right)).rms < kArmAsWell * fitNominal(shifted(by)).rms ? right : by;
  }

  /// Where a function of an angle is least: a round in steps of 15 deg, then thirds of the steps about the least.
  template <class Function>
  static double leastOver(const Function& of) {
    constexpr double kStep = 15.0 * io::kDegree;
    double best = 0.0, value = of(0.0);
    for (int k = -11; k <= 12; ++k) {
      const double at = k * kStep, there = k == 0 ? value : of(at);
      if (there < value) value = there, best = at;
    }
    for (double step = kStep / 3.0; step > 1e-5; step /= 3.0) {
      for (const double at : {best - 2.0 * step, best - step, best + step, best + 2.0 * step}) {
        const double there = of(at);
        if (there < value) value = there, best = at;
      }
    }
    return best;
  }

  /// Everything from a joint on, moved by a rigid motion about where its axis stands at zero.
  static void moveFrom(std::size_t joint, const Eigen::Vector3d& shift, const Eigen::Matrix3d& turn,
                       robot::Robot& robot) {
    const Eigen::Vector3d at = robot.axes_in_base_at_zero[joint].point;
    const auto moved = [&](const Eigen::Vector3d& p) { return Eigen::Vector3d(at + shift + turn * (p - at)); };
    const auto carry = [&](Eigen::Isometry3d& frame) {
      const Eigen::Vector3d place = moved(frame.translation());
      frame.linear() = turn * frame.linear();
      frame.translation() = place;
    };
    for (std::size_t j = joint; j < 6; ++j) {
      robot.axes_in_base_at_zero[j].point = moved(robot.axes_in_base_at_zero[j].point);
      robot.axes_in_base_at_zero[j].direction = turn * robot.axes_in_base_at_zero[j].direction;
    }
    carry(robot.base_from_flange_at_zero);
    for (robot::LinkFrame& link : robot.links) {
      if (link.body > static_cast<int>(joint)) carry(link.base_from_link_at_zero);
    }
    for (std::size_t body = joint + 1; body < robot.bodies.size(); ++body)
      robot.bodies[body].com_in_base_at_zero = moved(robot.bodies[body].com_in_base_at_zero);
  }

  /// The origin of one joint in the URDF: turned by right angles, or shifted.
  void searchOrigins() {
    std::vector<ArmCure> cures;
    for (std::size_t joint = 1; joint < 6; ++joint) {
      for (int axis = 0; axis < 3; ++axis) {
        for (const double degrees : {90.0, -90.0, 180.0}) {
          ReadingsOfDay day = day_;
          moveFrom(joint, Eigen::Vector3d::Zero(),
                   Eigen::AngleAxisd(degrees * io::kDegree, Eigen::Vector3d::Unit(axis)).toRotationMatrix(), day.robot);
          keepOrigin(std::move(day), Remark(RemarkId::origin_turned, joint + 1, axis, degrees * io::kDegree), cures);
        }
      }
      const Eigen::Vector3d shift = bestShift(joint);
      if (shift.norm() < 0.5 * identification::kMissedGeometry) continue;
      ReadingsOfDay day = day_;
      moveFrom(joint, shift, Eigen::Matrix3d::Identity(), day.robot);
      keepOrigin(std::move(day),
                 Remark(RemarkId::origin_off, joint + 1, std::vector<double>(shift.begin(), shift.end())), cures);
    }
    if (cures.empty()) return;
    std::stable_sort(cures.begin(), cures.end(), [](const ArmCure& a, const ArmCure& b) { return a.rms < b.rms; });
    const double best = cures.front().rms;
    for (ArmCure& cure : cures) {
      if (cure.rms <= kArmAsWell * best) add(std::move(cure));
    }
  }

  void keepOrigin(ReadingsOfDay day, Remark remedy, std::vector<ArmCure>& cures) const {
    const double rms = fitNominal(day).rms;
    if (!mends(rms)) return;
    ArmCure cure;
    cure.suspected = {"robot_origin", Remark(RemarkId::in_urdf), std::move(remedy), {}};
    cure.rms = rms;
    cure.day = std::move(day);
    cures.push_back(std::move(cure));
  }

  /// The shift of a joint's origin that brings the readings nearest, by Gauss-Newton on the fit's residuals with
  /// differences for derivatives: the fit is nearly linear in it.
  Eigen::Vector3d bestShift(std::size_t joint) const {
    const auto misfit = [&](const Eigen::Vector3d& shift) {
      ReadingsOfDay day = day_;
      moveFrom(joint, shift, Eigen::Matrix3d::Identity(), day.robot);
      return std::pow(affineMisfit(day), 2);
    };
    // A sum of squares of what is linear in the shift is a quadratic form of it.
    constexpr double kStep = 0.1;  // m
    const double middle = misfit(Eigen::Vector3d::Zero());
    Eigen::Vector3d gradient;
    Eigen::Matrix3d curvature;
    std::array<double, 3> up{}, down{};
    for (int k = 0; k < 3; ++k) {
      up[static_cast<std::size_t>(k)] = misfit(kStep * Eigen::Vector3d::Unit(k));
      down[static_cast<std::size_t>(k)] = misfit(-kStep * Eigen::Vector3d::Unit(k));
      gradient[k] = (up[static_cast<std::size_t>(k)] - down[static_cast<std::size_t>(k)]) / (2.0 * kStep);
      curvature(k, k) =
          (up[static_cast<std::size_t>(k)] + down[static_cast<std::size_t>(k)] - 2.0 * middle) / (kStep * kStep);
    }
    for (int k = 0; k < 3; ++k) {
      for (int l = k + 1; l < 3; ++l) {
        const double both = misfit(kStep * (Eigen::Vector3d::Unit(k) + Eigen::Vector3d::Unit(l)));
        curvature(k, l) = curvature(l, k) =
            (both - up[static_cast<std::size_t>(k)] - up[static_cast<std::size_t>(l)] + middle) / (kStep * kStep);
      }
    }
    // Directions in which the readings do not see a shift stay where they are.
    const double ridge = 1e-3 * std::max(1e-12, curvature.diagonal().maxCoeff());
    curvature.diagonal().array() += ridge;
    return -curvature.ldlt().solve(gradient);
  }

  /// One table of another scale than the others.
  void searchTableScales() {
    if (tables_.size() < 2) return;
    for (const SourceTable table : tables_) {
      const auto scaled = [&](double by) {
        ArmMistake mistake;
        mistake.points = (1.0 + by) * Eigen::Matrix3d::Identity();
        return with(day_, mistake, {table});
      };
      // The sum of squares is a parabola in the scale.
      constexpr double kStep = 5e-3, kLeast = 3e-3, kMost = 0.1;
      const double middle = std::pow(found_.fit.rms, 2), up = std::pow(fitNominal(scaled(kStep)).rms, 2),
                   down = std::pow(fitNominal(scaled(-kStep)).rms, 2), curvature = up + down - 2.0 * middle;
      if (curvature <= 0.0) continue;
      const double by = 0.5 * kStep * (down - up) / curvature;
      if (std::abs(by) < kLeast || std::abs(by) > kMost) continue;
      ReadingsOfDay day = scaled(by);
      const double rms = fitNominal(day).rms;
      if (!mends(rms)) continue;
      ArmCure cure;
      cure.suspected = {
          "scale",
          Remark(RemarkId::in_columns, std::string("x_mm, y_mm, z_mm"), filesOf(campaign_, {table}, false)),
          Remark(RemarkId::table_scale_off, 1.0 / (1.0 + by) - 1.0),
          {}};
      cure.rms = rms;
      cure.day = std::move(day);
      add(std::move(cure));
      return;
    }
  }

  /// One table read from another station, or from another base: a rigid motion brings it to the others.
  void searchStations() {
    if (tables_.size() < 2) return;
    for (const SourceTable table : tables_) {
      ReadingsOfDay own = day_, others = day_;
      std::erase_if(own.unloaded, [&](const UnloadedReading& reading) { return reading.table != table; });
      std::erase_if(others.unloaded, [&](const UnloadedReading& reading) { return reading.table == table; });
      const NominalFit apart = fitNominal(own), rest = fitNominal(others);
      if (!apart.done || !rest.done || !mends(apart.rms) || !mends(rest.rms)) continue;
      // One motion for all reflectors of the table, and the reflectors where the others have them.
      const Eigen::Isometry3d moved = rest.base_from_points.inverse() * apart.base_from_points;
      ArmMistake mistake;
      ReadingsOfDay day = day_;
      for (UnloadedReading& reading : day.unloaded) {
        if (reading.table == table) reading.point = moved * reading.point;
      }
      if (table == SourceTable::loading) {
        for (LoadedReading& reading : day.loaded) {
          for (ReflectorMove& move : reading.moves) move.displacement = moved.linear() * move.displacement;
        }
      }
      const double rms = fitNominal(day).rms;
      if (!mends(rms)) continue;
      ArmCure cure;
      cure.suspected = {
          "other_station",
          Remark(RemarkId::in_files, std::vector<std::string>{fileOfPoints(campaign_, table)}),
          Remark(RemarkId::other_station, moved.translation().norm(), Eigen::AngleAxisd(moved.linear()).angle()),
          {}};
      cure.rms = rms;
      cure.day = std::move(day);
      add(std::move(cure));
      return;
    }
  }

  /// Points and URDF of one shape and another size.
  void searchScale() {
    constexpr double kLeast = 3e-3, kMendsScale = 0.5, kWorth = 1e-3;  // share; of the misfit; m
    if (found_.fit.rms < kWorth) return;
    const NominalFit scaled = fitNominal(day_, {.scale = true});
    if (std::abs(scaled.scale - 1.0) < kLeast || scaled.rms > kMendsScale * found_.fit.rms) return;
    ArmCure cure;
    cure.suspected = {"scale",
                      Remark(RemarkId::in_columns, std::string("x_mm, y_mm, z_mm"), filesOf(campaign_, tables_, false)),
                      Remark(RemarkId::scale_off, 1.0 / scaled.scale - 1.0),
                      {}};
    cure.day = day_;
    for (UnloadedReading& reading : cure.day.unloaded) reading.point *= scaled.scale;
    for (LoadedReading& reading : cure.day.loaded) {
      for (ReflectorMove& move : reading.moves) move.displacement *= scaled.scale;
    }
    cure.rms = scaled.rms;
    add(std::move(cure));
  }

  /// Points that are declared to be in base_link and are elsewhere.
  void searchBase() {
    const bool in_base = campaign_.loading         ? campaign_.loading->frame == campaign::PointFrame::base_link
                         : campaign_.circle_sweeps ? campaign_.circle_sweeps->frame == campaign::PointFrame::base_link
                                                   : false;
    if (!in_base || found_.contradicts) return;
    constexpr double kFar = 0.1, kTurned = 5.0 * io::kDegree;  // m, more than a base frame of another convention is off
    const Eigen::Isometry3d& base = found_.fit.base_from_points;
    const double off = base.translation().norm(), turn = Eigen::AngleAxisd(base.linear()).angle();
    if (off < kFar && turn < kTurned) return;
    ArmCure cure;
    cure.suspected = {"frame_declared",
                      Remark(RemarkId::in_attribute, std::string("frame"), filesOf(campaign_, tables_, false)),
                      Remark(RemarkId::not_in_base, off, turn),
                      {}};
    cure.rms = found_.fit.rms;
    cure.day = day_;
    add(std::move(cure));
  }

  const campaign::Campaign& campaign_;
  const ReadingsOfDay& day_;
  Tables tables_;
  std::vector<Tables> sets_;
  std::vector<ArmMistake> table_;
  bool labelled_ = true;  ///< each sweep under the axis that turns
  ArmSearch found_;
};

}  // namespace

ArmSearch searchArm(const campaign::Campaign& campaign, const ReadingsOfDay& day) {
  return Search(campaign, day).run();
}

}  // namespace stiffscope::mistakes
