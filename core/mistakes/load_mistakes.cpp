#include "core/mistakes/load_search.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/identification/load_case.h"
#include "core/io/units.h"
#include "core/mistakes/arm_mistakes.h"
#include "core/mistakes/remarks.h"
#include "core/robot/kinematics.h"

namespace stiffscope::mistakes {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kKilogramForce = 9.80665, kPoundForce = 4.4482216152605, kFoot = 0.3048, kInch = 0.0254;  // N, m

std::vector<double> listed(const Vector3d& v) { return {v.begin(), v.end()}; }

class Table {
 public:
  explicit Table(const campaign::Campaign& campaign) : campaign_(campaign), cell_(*campaign.load_cell) {
    declared_ = asDeclared(cell_);
  }

  std::vector<LoadMistake> all() {
    addSigns();
    addOrders();
    addTurns();
    addUnits();
    addFrames();
    addPoints();
    addRows();
    return std::move(all_);
  }

  LoadMistake start(MistakeId id) const {
    LoadMistake mistake;
    mistake.id = id;
    mistake.meant = declared_;
    return mistake;
  }

  Remark columns(const std::string& names) const {
    return Remark(RemarkId::in_columns, names, std::vector<std::string>{campaign_.states->file});
  }

 private:
  void addSigns() {
    constexpr std::array<const char*, 6> kColumns{"fx_n", "fy_n", "fz_n", "mx_nm", "my_nm", "mz_nm"};
    for (int set = 1; set < 64; ++set) {
      Vector6d signs = Vector6d::Ones();
      std::vector<std::string> names;
      for (int k = 0; k < 6; ++k) {
        if ((set >> k & 1) == 0) continue;
        signs[k] = -1.0;
        names.push_back(kColumns[static_cast<std::size_t>(k)]);
      }
      LoadMistake mistake = start("wrench_sign");
      const bool convention = set == 7 || set == 56 || set == 63;  // of all forces, all moments, both: one thing
      mistake.things = convention ? 1 : static_cast<int>(names.size());
      mistake.meant.on_force = Vector3d(signs.head<3>()).asDiagonal();
      mistake.meant.on_moment = Vector3d(signs.tail<3>()).asDiagonal();
      mistake.where = columns(names.size() == 6 ? "fx_n to mz_nm" : joined(names));
      mistake.remedy = Remark(RemarkId::turn_wrench_signs, names);
      all_.push_back(std::move(mistake));
    }
  }

  static std::string joined(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
  }

  void addOrders() {
    for (const SignedPermutation& one : signedPermutations()) {
      const bool exchanges = std::abs(one.map.diagonal().prod()) < 0.5;
      if (!exchanges) continue;
      for (const bool force : {true, false}) {
        LoadMistake mistake = start("wrench_order");
        mistake.things = 2;
        (force ? mistake.meant.on_force : mistake.meant.on_moment) = one.map;
        const std::string names = force ? "fx_n, fy_n, fz_n" : "mx_nm, my_nm, mz_nm";
        mistake.where = columns(names);
        mistake.remedy = Remark(RemarkId::order_of_wrench, names, one.rows);
        all_.push_back(std::move(mistake));
      }
    }
    LoadMistake mistake = start("wrench_order");
    mistake.meant.moments_first = true;
    mistake.where = columns("fx_n to mz_nm");
    mistake.remedy = Remark(RemarkId::moments_first);
    all_.push_back(std::move(mistake));
  }

  void addTurns() {
    for (const SignedPermutation& one : signedPermutations()) {
      if (one.map.isIdentity()) continue;
      if (one.proper()) {
        if (!cell_.axes_link) all_.push_back(turnedCell(campaign_, one.map));
        continue;
      }
      LoadMistake mistake = start("cell_axes");
      // The moment is an axial vector, but files exchange columns of both alike.
      mistake.meant.on_force = mistake.meant.on_moment = one.map;
      mistake.things = 2;
      mistake.where = columns("fx_n to mz_nm");
      mistake.remedy = Remark(RemarkId::cell_left_handed, one.rows);
      all_.push_back(std::move(mistake));
    }
  }

  void addUnits() {
    struct Unit {
      const char *what, *name;
      double force, moment;
    };
    constexpr std::array kUnits{
        Unit{"forces", "kgf", kKilogramForce, 1.0},
        Unit{"forces", "lbf", kPoundForce, 1.0},
        Unit{"forces", "kN", 1e3, 1.0},
        Unit{"forces", "daN", 10.0, 1.0},
        Unit{"moments", "N mm", 1.0, 1e-3},
        Unit{"moments", "N cm", 1.0, 1e-2},
        Unit{"moments", "kNm", 1.0, 1e3},
        Unit{"moments", "kgf m", 1.0, kKilogramForce},
        Unit{"moments", "lbf ft", 1.0, kPoundForce * kFoot},
        Unit{"moments", "lbf in", 1.0, kPoundForce * kInch},
        Unit{"wrenches", "kgf and N mm", kKilogramForce, 1e-3},
        Unit{"wrenches", "kgf and kgf mm", kKilogramForce, kKilogramForce * 1e-3},
        Unit{"wrenches", "lbf and lbf ft", kPoundForce, kPoundForce * kFoot},
        Unit{"wrenches", "lbf and lbf in", kPoundForce, kPoundForce * kInch},
        Unit{"wrenches", "kgf", kKilogramForce, kKilogramForce},
        Unit{"wrenches", "lbf", kPoundForce, kPoundForce},
        Unit{"wrenches", "kN", 1e3, 1e3},
        Unit{"wrenches", "daN", 10.0, 10.0},
    };
    for (const Unit& unit : kUnits) {
      LoadMistake mistake = start("wrench_unit");
      // Pounds with their feet or inches are one habit.
      const bool pounds = unit.force == kPoundForce;
      mistake.things = unit.force != 1.0 && unit.moment != 1.0 && unit.force != unit.moment && !pounds ? 2 : 1;
      mistake.meant.on_force *= unit.force;
      mistake.meant.on_moment *= unit.moment;
      mistake.where = columns(unit.moment == 1.0  ? "fx_n, fy_n, fz_n"
                              : unit.force == 1.0 ? "mx_nm, my_nm, mz_nm"
                                                  : "fx_n to mz_nm");
      mistake.remedy = Remark(RemarkId::wrench_in, std::string(unit.what), std::string(unit.name));
      all_.push_back(std::move(mistake));
    }
  }

  void addFrame(RemarkId remedy, const char* attribute, CellReading meant, std::vector<std::string> values = {}) {
    LoadMistake mistake = start("cell_axes");
    mistake.meant = std::move(meant);
    mistake.of_one_posture = false;
    mistake.where = Remark(RemarkId::in_cell, std::string(attribute));
    mistake.remedy = values.empty() ? Remark(remedy) : Remark(remedy, values.front());
    all_.push_back(std::move(mistake));
  }

  void addFrames() {
    for (const std::string& link : {campaign_.base_link, campaign_.flange_link}) {
      if (cell_.axes_link == link || (!cell_.axes_link && link == cell_.parent && turn().isIdentity(1e-9))) continue;
      CellReading meant = declared_;
      meant.axes_link = link;
      addFrame(RemarkId::cell_along_link, "axes", meant, {link});
    }
    if (cell_.axes_link) {
      CellReading meant = declared_;
      meant.axes_link.reset();
      addFrame(RemarkId::cell_not_along_link, "axes", meant, {*cell_.axes_link});
      return;
    }
    if (turn().isIdentity(1e-9)) return;
    CellReading meant = declared_;
    meant.parent_from_cell.linear() = turn().transpose();
    addFrame(RemarkId::cell_turned_back, "rpy_deg", meant);
    const Vector3d rpy = robot::rpyFromRotation(turn());
    meant.parent_from_cell.linear() = robot::rotationFromRpy(rpy / io::kDegree);
    addFrame(RemarkId::cell_angles_in, "rpy_deg", meant, {"radians"});
  }

  Matrix3d turn() const { return cell_.parent_from_cell.linear(); }

  void addPoints() {
    const Vector3d at = cell_.parent_from_cell.translation();
    constexpr double kInMetres = 2e-3;  // m: 2 mm, where 2 m were meant
    if (at.norm() > 0.0 && at.norm() < kInMetres) {
      all_.push_back(movedCell(campaign_, 1e3 * at));
      all_.back().mends =
          0.98;  // no cell is mounted a tenth of a millimetre from its parent: not much more is to be shown
    }
    if (at.norm() > 0.0) all_.push_back(movedCell(campaign_, -at));
  }

  void addRows() {
    for (const WrenchRow row :
         {WrenchRow::previous_posture, WrenchRow::next_posture, WrenchRow::previous_step, WrenchRow::next_step}) {
      LoadMistake mistake = start("row_order");
      mistake.meant.row = row;
      mistake.of_one_posture = row == WrenchRow::previous_step || row == WrenchRow::next_step;
      mistake.where = columns("fx_n to mz_nm");
      mistake.remedy = Remark(RemarkId::wrench_of_row, row);
      all_.push_back(std::move(mistake));
    }
  }

  const campaign::Campaign& campaign_;
  const campaign::LoadCell& cell_;
  CellReading declared_;
  std::vector<LoadMistake> all_;
};

}  // namespace

std::vector<LoadMistake> loadMistakes(const campaign::Campaign& campaign) { return Table(campaign).all(); }

LoadMistake turnedCell(const campaign::Campaign& campaign, const Matrix3d& turn) {
  LoadMistake mistake = Table(campaign).start("cell_axes");
  mistake.meant.on_force = mistake.meant.on_moment = turn;
  const Eigen::AngleAxisd by(turn);
  const Matrix3d parent_from_cell = campaign.load_cell->parent_from_cell.linear();
  // In the parent's axes where it is about one of those.
  constexpr double kOneAxis = 0.999;
  const Vector3d in_parent = parent_from_cell * by.axis();
  const bool of_parent = by.axis().cwiseAbs().maxCoeff() < kOneAxis && in_parent.cwiseAbs().maxCoeff() > kOneAxis;
  Vector3d axis = of_parent ? in_parent : by.axis();
  double angle = by.angle();
  // The sense in which the axis has more that is positive.
  if (axis.sum() < 0.0) axis *= -1.0, angle *= -1.0;
  const Vector3d rpy = robot::rpyFromRotation(Matrix3d(parent_from_cell * turn));
  mistake.where = Remark(RemarkId::in_cell, std::string("rpy_deg"));
  mistake.remedy = Remark(RemarkId::turn_cell, listed(axis), angle, listed(rpy), of_parent, campaign.robot.joints());
  return mistake;
}

LoadMistake movedCell(const campaign::Campaign& campaign, const Vector3d& to) {
  LoadMistake mistake = Table(campaign).start("cell_point");
  mistake.of_one_posture = false;
  mistake.meant.parent_from_cell.translation() = to;
  mistake.where = Remark(RemarkId::in_cell, std::string("xyz_mm"));
  mistake.remedy = Remark(RemarkId::move_cell, listed(campaign.load_cell->parent_from_cell.translation()), listed(to));
  return mistake;
}

bool forcesStandOut(const campaign::Campaign& campaign) {
  if (!campaign.states) return false;
  struct Sum {
    double squares = 0.0, count = 0.0;
  };
  std::map<int, Sum> by_step;
  for (const campaign::State& row : campaign.states->rows) {
    Sum& sum = by_step[row.step];
    sum.squares += row.wrench_in_cell.head<3>().squaredNorm();
    sum.count += 1.0;
  }
  double least = std::numeric_limits<double>::infinity(), most = 0.0;  // N^2
  for (const auto& [step, sum] : by_step) {
    least = std::min(least, sum.squares / sum.count);
    most = std::max(most, sum.squares / sum.count);
  }
  constexpr double kStandsOut = 3.0;
  return by_step.size() == 1 || most > kStandsOut * kStandsOut * least;
}

std::optional<std::pair<int, int>> posesOfEqualWrenches(const campaign::Campaign& campaign) {
  if (campaign.load_cell->axes_link) return std::nullopt;  // a weight in base_link's axes may be written without noise
  std::map<int, std::vector<const campaign::State*>> postures;
  for (const campaign::State& row : campaign.states->rows) {
    if (row.step != 0) postures[row.pose].push_back(&row);
  }
  // Postures of like wrenches, earlier ones first: of ten thousand not each is held against each.
  std::map<std::vector<double>, std::vector<int>> alike;
  for (const auto& [pose, rows] : postures) {
    std::vector<double> digits;
    bool all_of_six = true;
    for (const campaign::State* row : rows) {
      digits.push_back(row->step);
      digits.insert(digits.end(), row->wrench_in_cell.begin(), row->wrench_in_cell.end());
      all_of_six &= (row->wrench_in_cell.array().abs() > 0.0).all();  // nor is one NaN
    }
    if (!all_of_six) continue;
    std::vector<int>& earlier = alike[std::move(digits)];
    for (const int other : earlier) {
      constexpr double kOtherPosture = 2.0 * io::kDegree;
      if ((rows.front()->q - postures.at(other).front()->q).cwiseAbs().maxCoeff() >= kOtherPosture)
        return std::pair{other, pose};
    }
    earlier.push_back(pose);
  }
  return std::nullopt;
}

namespace {

/// Whether the reflectors of a posture stand apart in two of its loaded steps by more than a fifth of what they moved:
/// one load leaves them where they were, but for friction.
bool standApart(const identification::LoadReadings& readings, std::size_t pose, int a, int b) {
  constexpr double kApart = 0.2;
  double between = 0.0, moved = 0.0;
  const auto add = [&](const Vector3d& by_a, const Vector3d& by_b) {
    between += (by_b - by_a).squaredNorm();
    moved += std::max(by_a.squaredNorm(), by_b.squaredNorm());
  };
  const auto at_rest = readings.points(pose, 0), at_a = readings.points(pose, a), at_b = readings.points(pose, b);
  for (std::size_t k = 0; k < at_rest.size(); ++k) {
    if (at_rest[k].readings > 0 && at_a[k].readings > 0 && at_b[k].readings > 0)
      add(at_a[k].mean() - at_rest[k].mean(), at_b[k].mean() - at_rest[k].mean());
  }
  const auto by_a = readings.differences(pose, a), by_b = readings.differences(pose, b);
  for (std::size_t k = 0; k < by_a.size(); ++k) {
    if (by_a[k].readings > 0 && by_b[k].readings > 0) add(by_a[k].mean(), by_b[k].mean());
  }
  return between > kApart * kApart * moved;
}

}  // namespace

std::optional<RepeatedSteps> stepsOfEqualWrenches(const campaign::Campaign& campaign) {
  if (campaign.load_cell->axes_link) return std::nullopt;
  std::map<int, std::vector<const campaign::State*>> postures;
  for (const campaign::State& row : campaign.states->rows) {
    if (row.step != 0 && (row.wrench_in_cell.array().abs() > 0.0).all()) postures[row.pose].push_back(&row);
  }
  std::map<std::pair<int, int>, std::vector<int>> alike;  // by the earlier and the later step
  for (const auto& [pose, rows] : postures) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (std::size_t k = i + 1; k < rows.size(); ++k) {
        if (rows[i]->wrench_in_cell == rows[k]->wrench_in_cell)
          alike[std::minmax(rows[i]->step, rows[k]->step)].push_back(pose);
      }
    }
  }
  std::optional<RepeatedSteps> most;
  for (auto& [steps, poses] : alike) {
    const int own = steps.first, step = steps.second;
    const identification::LoadReadings readings(campaign, {own, step});
    std::erase_if(poses, [&](int pose) { return !standApart(readings, static_cast<std::size_t>(pose), own, step); });
    if (!poses.empty() && (!most || poses.size() > most->poses.size())) most = RepeatedSteps{poses, step, own};
  }
  return most;
}

}  // namespace stiffscope::mistakes
