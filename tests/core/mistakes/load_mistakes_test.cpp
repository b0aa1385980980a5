#include "core/mistakes/load_search.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>
#include <set>

#include "core/mistakes/remarks.h"
#include "reports/words/remark_words.h"

// What a remedy says in words of the file against what it does to the readings.

namespace stiffscope {
namespace load_mistakes_test {

using mistakes::LoadMistake;
using mistakes::RemarkId;

const std::vector<std::string> kColumns{"fx_n", "fy_n", "fz_n", "mx_nm", "my_nm", "mz_nm"};

/// A cell on the flange, turned by 30 deg about its z.
campaign::Campaign withCell() {
  campaign::Campaign campaign;
  campaign.base_link = "base_link", campaign.flange_link = "tool0";
  campaign.load_cell.emplace();
  campaign.load_cell->parent = "tool0";
  campaign.load_cell->parent_from_cell.translation() << 0.01, -0.02, 0.09;
  campaign.load_cell->parent_from_cell.rotate(Eigen::AngleAxisd(std::numbers::pi / 6.0, Eigen::Vector3d::UnitZ()));
  campaign.states.emplace().file = "states.csv";
  return campaign;
}

std::vector<LoadMistake> ofKind(const std::string& id) {
  std::vector<LoadMistake> all = mistakes::loadMistakes(withCell());
  std::erase_if(all, [&](const LoadMistake& one) { return one.id != id; });
  return all;
}

const std::vector<std::string>& names(const Remark& remark, std::size_t place) {
  return std::get<std::vector<std::string>>(remark.values.at(place));
}

TEST(LoadMistakes, TurnTheSignsOfTheColumnsTheyName) {
  const std::vector<LoadMistake> signs = ofKind("wrench_sign");
  std::set<std::vector<std::string>> all;
  for (const LoadMistake& one : signs) {
    ASSERT_TRUE(one.remedy.is(RemarkId::turn_wrench_signs));
    const std::set<std::string> named(names(one.remedy, 0).begin(), names(one.remedy, 0).end());
    for (int k = 0; k < 6; ++k) {
      const double sign = k < 3 ? one.meant.on_force(k, k) : one.meant.on_moment(k - 3, k - 3);
      EXPECT_EQ(sign, named.contains(kColumns[static_cast<std::size_t>(k)]) ? -1.0 : 1.0) << k;
    }
    all.insert(names(one.remedy, 0));
  }
  EXPECT_EQ(all.size(), 63u);  // every choice of six columns but none
}

TEST(LoadMistakes, OrdersSayWhatStandsForEachColumn) {
  int of_forces = 0;
  for (const LoadMistake& one : ofKind("wrench_order")) {
    if (!one.remedy.is(RemarkId::order_of_wrench)) continue;
    const bool force = std::get<std::string>(one.remedy.values[0]) == "fx_n, fy_n, fz_n";
    of_forces += force;
    const Eigen::Matrix3d& map = force ? one.meant.on_force : one.meant.on_moment;
    EXPECT_TRUE((force ? one.meant.on_moment : one.meant.on_force).isIdentity());
    // A file that reads 1, 2, 3 in its columns x, y, z.
    const Eigen::Vector3d meant = map * Eigen::Vector3d(1, 2, 3);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string& row = names(one.remedy, 1).at(k);
      const double value = static_cast<double>(std::string("xyz").find(row.back()) + 1);
      EXPECT_EQ(meant[static_cast<Eigen::Index>(k)], row.front() == '-' ? -value : value) << row;
    }
  }
  EXPECT_EQ(of_forces, 40);  // of 48 signed permutations those 8 exchange nothing
}

TEST(LoadMistakes, UnitsAreThoseOfTheirNames) {
  // kgf is the standard acceleration, lbf is 0.45359237 kgf, a foot is 304.8 mm.
  const double kgf = 9.80665, lbf = 0.45359237 * kgf, ft = 0.3048;
  const std::vector<std::tuple<std::string, std::string, double, double>> expected{
      {"forces", "lbf", lbf, 1.0},
      {"forces", "kN", 1000.0, 1.0},
      {"moments", "N mm", 1.0, 1e-3},
      {"moments", "lbf ft", 1.0, lbf * ft},
      {"moments", "kgf m", 1.0, kgf},
      {"wrenches", "kgf", kgf, kgf},
      {"wrenches", "lbf and lbf in", lbf, lbf * ft / 12.0}};
  const std::vector<LoadMistake> units = ofKind("wrench_unit");
  for (const auto& [what, name, force, moment] : expected) {
    const auto found = std::find_if(units.begin(), units.end(), [&, what = what, name = name](const LoadMistake& one) {
      return one.remedy == Remark(RemarkId::wrench_in, what, name);
    });
    ASSERT_NE(found, units.end()) << what << " " << name;
    EXPECT_NEAR(found->meant.on_force(1, 1), force, 1e-9 * force) << name;
    EXPECT_NEAR(found->meant.on_moment(2, 2), moment, 1e-9 * moment) << name;
  }
}

// The cell declared at 30 deg about z stands at 120 deg: its rpy_deg is then 0 0 120.
TEST(LoadMistakes, ATurnedCellIsDeclaredByItsNewAngles) {
  const LoadMistake turned = mistakes::turnedCell(
      withCell(), Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitZ()).toRotationMatrix());
  ASSERT_TRUE(turned.remedy.is(RemarkId::turn_cell));
  const auto& axis = std::get<std::vector<double>>(turned.remedy.values[0]);
  EXPECT_NEAR(axis[2], 1.0, 1e-12);
  EXPECT_NEAR(std::get<double>(turned.remedy.values[1]), 0.5 * std::numbers::pi, 1e-12);
  const auto& rpy = std::get<std::vector<double>>(turned.remedy.values[2]);
  EXPECT_NEAR(rpy[0], 0.0, 1e-12);
  EXPECT_NEAR(rpy[1], 0.0, 1e-12);
  EXPECT_NEAR(rpy[2], std::numbers::pi * 2.0 / 3.0, 1e-12);
  EXPECT_TRUE((turned.meant.on_force * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-12));
}

// Half a turn about an axis between two of the cell's that is one of the flange's is told by that of the flange.
TEST(LoadMistakes, ATurnAboutTheFlangesAxisIsToldByIt) {
  const Eigen::Vector3d x_in_cell =
      Eigen::AngleAxisd(-std::numbers::pi / 6.0, Eigen::Vector3d::UnitZ()) * Eigen::Vector3d::UnitX();
  const LoadMistake turned =
      mistakes::turnedCell(withCell(), Eigen::AngleAxisd(0.5 * std::numbers::pi, x_in_cell).toRotationMatrix());
  const auto& axis = std::get<std::vector<double>>(turned.remedy.values[0]);
  EXPECT_NEAR(axis[0], 1.0, 1e-12);
  EXPECT_EQ(std::get<std::int64_t>(turned.remedy.values[3]), 1);
}

// Where a wrench stands and where it is read are one thing, said twice.
TEST(LoadMistakes, RowsAreNamedTheSameWayTwice) {
  for (const LoadMistake& one : ofKind("row_order")) {
    const std::string said = reports::words(one.remedy);
    const bool before =
        one.meant.row == mistakes::WrenchRow::previous_posture || one.meant.row == mistakes::WrenchRow::previous_step;
    EXPECT_EQ(said.find("early") != std::string::npos, before) << said;
    EXPECT_EQ(said.find("before") != std::string::npos, before) << said;
    EXPECT_EQ(said.find("late") != std::string::npos, !before) << said;
    EXPECT_EQ(said.find("next") != std::string::npos, !before) << said;
  }
}

TEST(LoadMistakes, ThePointMayBeOnTheOtherSide) {
  const std::vector<LoadMistake> points = ofKind("cell_point");
  ASSERT_EQ(points.size(), 1u);
  EXPECT_TRUE(points[0].meant.parent_from_cell.translation().isApprox(Eigen::Vector3d(-0.01, 0.02, -0.09)));
  EXPECT_FALSE(points[0].of_one_posture);
  // 0.1 mm: metres were meant, or the other side.
  campaign::Campaign near = withCell();
  near.load_cell->parent_from_cell.translation() << 0.0, 0.0, 1e-4;
  std::size_t count = 0;
  for (const LoadMistake& one : mistakes::loadMistakes(near)) {
    if (one.id != "cell_point") continue;
    ++count;
    const double z = one.meant.parent_from_cell.translation().z();
    EXPECT_TRUE(std::abs(z - 0.1) < 1e-12 || std::abs(z + 1e-4) < 1e-12) << z;
  }
  EXPECT_EQ(count, 2u);
}

}  // namespace load_mistakes_test
}  // namespace stiffscope
