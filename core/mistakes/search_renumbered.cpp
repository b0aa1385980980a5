#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>

#include "core/campaign/row_names.h"
#include "core/identification/warnings.h"
#include "core/io/units.h"
#include "core/mistakes/searched_arm.h"
#include "core/mistakes/spring_fit.h"
#include "core/robot/inverse_kinematics.h"
#include "core/robot/kinematics.h"
#include "metrology/registration.h"

namespace stiffscope::mistakes {

namespace {

/// Unloaded joint angles as a row of `states` has them.
struct AnglesOfPosture {
  int pose = 0;
  JointVector q;
};

/// One posture's readings of the day, by their places in ReadingsOfDay::unloaded.
struct ReadPosture {
  int pose = 0;
  std::vector<std::size_t> readings;
};

/// Turn and shift along its axis, both without sign, of the motion from one posture to another: the same in whatever
/// frame it is seen, so that neither base nor reflectors need be known.
struct Screw {
  double angle = 0.0, along = 0.0;  ///< rad, m
  std::size_t from = 0, to = 0;
};

std::optional<Screw> screwOf(const Eigen::Isometry3d& motion, std::size_t from, std::size_t to) {
  constexpr double kLeastTurn = 5.0 * io::kDegree;  // of a smaller one the axis is noise
  const Eigen::Vector3d turn = robot::rotationVector(motion.linear());
  const double angle = turn.norm();
  if (angle < kLeastTurn) return std::nullopt;
  return Screw{angle, std::abs(motion.translation().dot(turn) / angle), from, to};
}

/// Which row's angles each posture has, -1 where that is open: an index into the rows.
using Assignment = std::vector<int>;

class Renumbered {
 public:
  explicit Renumbered(const SearchedArm& arm) : arm_(arm) {
    if (!arm.campaign.states) return;
    for (const campaign::State& row : arm.campaign.states->rows) {
      if (row.step == 0) rows_.push_back({row.pose, row.q});
    }
    std::map<int, ReadPosture> by_pose;
    for (std::size_t i = 0; i < arm.day.unloaded.size(); ++i) {
      const UnloadedReading& reading = arm.day.unloaded[i];
      if (reading.pose < 0) continue;
      by_pose[reading.pose].pose = reading.pose;
      by_pose[reading.pose].readings.push_back(i);
    }
    for (const auto& [pose, read] : by_pose) postures_.push_back(read);
  }

  bool worthIt() const {
    constexpr std::size_t kFew = 5, kMany = 400;  // motions between rows grow with their square
    return postures_.size() >= kFew && rows_.size() >= kFew && rows_.size() <= kMany;
  }

  /// Rows by the fit of what the sweeps show alone, or by the motions between postures; empty: neither explains them.
  std::optional<Assignment> find() const {
    ReadingsOfDay sweeps = arm_.day;
    std::erase_if(sweeps.unloaded, [](const UnloadedReading& one) { return one.pose >= 0; });
    const auto by = [&](const ReadingsOfDay& day) -> std::optional<Assignment> {
      const NominalFit fit = fitNominal(day);
      if (!fit.done || fit.typical > identification::kMissedGeometry) return std::nullopt;
      Assignment rows = rowsBy(fit);
      return explains(rows) ? std::optional(rows) : std::nullopt;
    };
    // The wrist sweep alone is of one place; whether it or one axis are enough shows in what they explain.
    if (std::optional<Assignment> rows = by(sweeps)) return rows;
    const Assignment voted = rowsByMotions();
    return std::count(voted.begin(), voted.end(), -1) == std::ssize(voted) ? std::nullopt
                                                                           : by(dayWith(voted, Others::without));
  }

  enum class Others { without, with };  ///< the sweeps

  /// The day with the postures under the angles of their rows, those that have none left out.
  ReadingsOfDay dayWith(const Assignment& rows, Others sweeps) const {
    ReadingsOfDay day = arm_.day;
    const std::map<int, JointVector> q = anglesBy(rows);
    std::erase_if(day.unloaded, [&](const UnloadedReading& one) {
      return one.pose < 0 ? sweeps == Others::without : !q.contains(one.pose);
    });
    std::erase_if(day.loaded, [&](const LoadedReading& one) { return !q.contains(one.pose); });
    for (UnloadedReading& reading : day.unloaded) {
      if (reading.pose >= 0) reading.q = q.at(reading.pose);
    }
    for (LoadedReading& reading : day.loaded) reading.q = q.at(reading.pose);
    return day;
  }

  /// The same with the wrenches of those rows, too.
  ReadingsOfDay withWrenches(ReadingsOfDay day, const Assignment& rows) const {
    std::map<std::pair<int, int>, Vector6d> wrenches;
    for (const LoadedReading& one : arm_.day.loaded) wrenches[{one.pose, one.step}] = one.wrench;
    std::map<int, int> of;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (rows[i] >= 0) of[postures_[i].pose] = rows_[static_cast<std::size_t>(rows[i])].pose;
    }
    std::erase_if(day.loaded, [&](LoadedReading& one) {
      const auto from = wrenches.find({of.at(one.pose), one.step});
      if (from != wrenches.end()) one.wrench = from->second;
      return from == wrenches.end();
    });
    return day;
  }

  /// Posture, and the one whose row has its angles: those that are not in their own.
  std::vector<std::pair<int, int>> moved(const Assignment& rows) const {
    std::vector<std::pair<int, int>> moved;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const int own = postures_[i].pose;
      if (rows[i] < 0) continue;
      const int other = rows_[static_cast<std::size_t>(rows[i])].pose;
      if (other != own) moved.emplace_back(own, other);
    }
    return moved;
  }

  /// A row up or down all of them, the one at the end perhaps at the beginning: a search of its own says it shorter.
  bool isNextRow(const Assignment& rows) const {
    std::map<int, std::ptrdiff_t> place;
    for (std::size_t r = 0; r < rows_.size(); ++r) place[rows_[r].pose] = static_cast<std::ptrdiff_t>(r);
    const auto count = std::ssize(rows_);
    std::optional<std::ptrdiff_t> shift;
    for (const auto& [own, other] : moved(rows)) {
      const auto by = (place.at(other) - place.at(own) + count) % count;
      if ((by != 1 && by != count - 1) || (shift && by != *shift)) return false;
      shift = by;
    }
    return shift.has_value();
  }

  const std::vector<AnglesOfPosture>& rows() const { return rows_; }

 private:
  std::map<int, JointVector> anglesBy(const Assignment& rows) const {
    std::map<int, JointVector> q;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (rows[i] >= 0) q[postures_[i].pose] = rows_[static_cast<std::size_t>(rows[i])].q;
    }
    return q;
  }

  /// Nearly all postures have a row, three or more of them another's: of two that are exchanged a search of its own
  /// tells.
  bool explains(const Assignment& rows) const {
    constexpr std::ptrdiff_t kLeastMoved = 3, kOfMany = 10;  // one posture in so many may be wrong in itself
    const auto open = std::count(rows.begin(), rows.end(), -1);
    return open * kOfMany <= std::ssize(rows) && std::ssize(moved(rows)) >= kLeastMoved;
  }

  /// The row whose angles a posture's readings fit, each row once: its own where that fits.
  Assignment rowsBy(const NominalFit& fit) const {
    constexpr double kFits = 5e-3, kAsOthers = 3.0;  // m; of what the fit leaves of its own readings
    const double limit = std::max(kFits, kAsOthers * fit.typical);
    const auto missed = [&](const ReadPosture& posture, const JointVector& q) {
      double squares = 0.0;
      for (const std::size_t i : posture.readings) {
        UnloadedReading reading = arm_.day.unloaded[i];
        reading.q = q;
        squares += std::pow(fit.missOf(arm_.day, reading), 2);
      }
      return std::sqrt(squares / static_cast<double>(posture.readings.size()));
    };
    struct Fits {
      double miss;
      std::size_t posture, row;
    };
    std::vector<Fits> all;
    for (std::size_t i = 0; i < postures_.size(); ++i) {
      for (std::size_t r = 0; r < rows_.size(); ++r) {
        const double miss = missed(postures_[i], rows_[r].q);
        // A posture that was taken twice fits either's angles: it keeps its own.
        if (miss < limit) all.push_back({rows_[r].pose == postures_[i].pose ? 0.0 : miss, i, r});
      }
    }
    std::stable_sort(all.begin(), all.end(), [](const Fits& a, const Fits& b) { return a.miss < b.miss; });
    Assignment rows(postures_.size(), -1);
    std::vector<bool> taken(rows_.size(), false);
    for (const Fits& one : all) {
      if (rows[one.posture] >= 0 || taken[one.row]) continue;
      rows[one.posture] = static_cast<int>(one.row);
      taken[one.row] = true;
    }
    return rows;
  }

  /// By the motions between every two postures, as three reflectors show them, against those between every two rows:
  /// each pair that is alike votes for its ends.
  Assignment rowsByMotions() const {
    constexpr double kAngle = 1.0 * io::kDegree, kAlong = 0.010;  // rad, m: what an arm off its drawing makes of them
    std::vector<Screw> between;
    for (std::size_t a = 0; a < rows_.size(); ++a) {
      const Eigen::Isometry3d from = flangeOf(rows_[a].q).inverse();
      for (std::size_t b = a + 1; b < rows_.size(); ++b) {
        if (const auto screw = screwOf(flangeOf(rows_[b].q) * from, a, b)) between.push_back(*screw);
      }
    }
    std::sort(between.begin(), between.end(), [](const Screw& a, const Screw& b) { return a.angle < b.angle; });
    std::vector<std::vector<int>> votes(postures_.size(), std::vector<int>(rows_.size(), 0));
    std::vector<int> pairs(postures_.size(), 0);
    for (std::size_t a = 0; a < postures_.size(); ++a) {
      for (std::size_t b = a + 1; b < postures_.size(); ++b) {
        const auto screw = measuredScrew(a, b);
        if (!screw) continue;
        ++pairs[a], ++pairs[b];
        const auto first = std::lower_bound(between.begin(), between.end(), screw->angle - kAngle,
                                            [](const Screw& one, double angle) { return one.angle < angle; });
        for (auto one = first; one != between.end() && one->angle < screw->angle + kAngle; ++one) {
          if (std::abs(one->along - screw->along) > kAlong) continue;
          ++votes[a][one->from], ++votes[a][one->to], ++votes[b][one->from], ++votes[b][one->to];
        }
      }
    }
    Assignment rows(postures_.size(), -1);
    for (std::size_t i = 0; i < postures_.size(); ++i) {
      const auto most = std::max_element(votes[i].begin(), votes[i].end());
      if (2 * *most > pairs[i] && std::count(votes[i].begin(), votes[i].end(), *most) == 1)
        rows[i] = static_cast<int>(most - votes[i].begin());
    }
    return rows;
  }

  Eigen::Isometry3d flangeOf(const JointVector& q) const {
    return robot::flangeAt(arm_.day.robot, robot::postureAt(arm_.day.robot, q));
  }

  std::optional<Screw> measuredScrew(std::size_t a, std::size_t b) const {
    std::vector<Eigen::Vector3d> before, after;
    for (const std::size_t i : postures_[a].readings) {
      for (const std::size_t k : postures_[b].readings) {
        if (arm_.day.unloaded[i].target != arm_.day.unloaded[k].target) continue;
        before.push_back(arm_.day.unloaded[i].point);
        after.push_back(arm_.day.unloaded[k].point);
      }
    }
    const metrology::RigidRegistration motion = metrology::registerRigid(before, after);
    return motion.determined ? screwOf(motion.to_from_source, a, b) : std::nullopt;
  }

  const SearchedArm& arm_;
  std::vector<AnglesOfPosture> rows_;
  std::vector<ReadPosture> postures_;
};

/// In which order rows of postures are that were numbered anew: reversed, moved on by so many, sorted as texts.
Remark patternOf(const SearchedArm& arm, const Renumbered& search, const std::vector<std::pair<int, int>>& moved) {
  const auto name = [&](int pose) { return campaign::poseName(arm.campaign, pose); };
  // Numbers in their order; names in that of the rows.
  std::vector<int> order, as_texts;
  std::map<int, int> number;
  for (const AnglesOfPosture& row : search.rows()) {
    const std::string text = name(row.pose);
    int value = 0;
    const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end.ec == std::errc() && end.ptr == text.data() + text.size()) number[row.pose] = value;
    order.push_back(row.pose);
  }
  if (number.size() == order.size())
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return number.at(a) < number.at(b); });
  as_texts = order;
  std::stable_sort(as_texts.begin(), as_texts.end(), [&](int a, int b) { return name(a) < name(b); });
  std::map<int, std::ptrdiff_t> place, place_as_text;
  for (std::size_t i = 0; i < order.size(); ++i) {
    place[order[i]] = static_cast<std::ptrdiff_t>(i);
    place_as_text[as_texts[i]] = static_cast<std::ptrdiff_t>(i);
  }
  const auto count = std::ssize(order);
  const auto all = [&](const auto& holds) {
    return std::all_of(moved.begin(), moved.end(), [&](const auto& one) { return holds(one.first, one.second); });
  };
  if (all([&](int own, int other) { return place.at(own) + place.at(other) == count - 1; }))
    return Remark(RemarkId::order_reversed);
  const auto on = (place.at(moved.front().second) - place.at(moved.front().first) + count) % count;
  if (all([&](int own, int other) { return (place.at(own) + on) % count == place.at(other); }))
    return Remark(RemarkId::order_moved_on, 2 * on <= count ? on : on - count);
  if (all([&](int own, int other) { return place_as_text.at(own) == place.at(other); }) ||
      all([&](int own, int other) { return place.at(own) == place_as_text.at(other); }))
    return Remark(RemarkId::order_as_texts);
  return {};
}

/// Whether the springs ask for the wrenches to go with the angles: then it is the rows that are numbered anew.
bool wrenchesGoAlong(const SearchedArm& arm, const ReadingsOfDay& stay, const ReadingsOfDay& along) {
  if (!arm.campaign.load_cell) return false;
  const NominalFit fit = fitNominal(stay);
  const LoadsOfDay loads(stay, fit), moved(along, fit);
  if (!loads.enough() || !moved.enough()) return false;
  const CellReading cell = asDeclared(*arm.campaign.load_cell);
  return moved.fit(cell).left < loads.fit(cell).left;
}

}  // namespace

bool searchRenumbered(SearchedArm& arm) {
  const Renumbered search(arm);
  if (!search.worthIt()) return false;
  const std::optional<Assignment> rows = search.find();
  if (!rows || search.isNextRow(*rows)) return false;
  ArmCure cure;
  cure.day = search.dayWith(*rows, Renumbered::Others::with);
  cure.rms = fitNominal(cure.day).rms;
  if (!arm.mends(cure.rms)) return false;
  const ReadingsOfDay along = search.withWrenches(cure.day, *rows);
  const bool whole = wrenchesGoAlong(arm, cure.day, along);
  if (whole) cure.day = along;
  const std::vector<std::pair<int, int>> moved = search.moved(*rows);
  std::vector<std::string> names;
  for (const auto& [own, other] : moved) {
    names.push_back(campaign::poseName(arm.campaign, own));
    names.push_back(campaign::poseName(arm.campaign, other));
  }
  const std::string columns = whole ? "pose" : columnsOfAngles(arm.day.robot.joints());
  cure.suspected = {
      "row_order",
      Remark(RemarkId::in_columns, columns, std::vector<std::string>{fileOfAngles(arm.campaign, SourceTable::loading)}),
      Remark(whole ? RemarkId::rows_renumbered : RemarkId::angles_renumbered, names, patternOf(arm, search, moved)),
      {}};
  arm.add(std::move(cure));
  return true;
}

}  // namespace stiffscope::mistakes
