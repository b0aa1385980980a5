#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include "core/campaign/read_campaign.h"
#include "core/mistakes/find_mistakes.h"
#include "core/numerics/parallel.h"
#include "core/simulation/measure.h"
#include "core/simulation/read_spec.h"
#include "reports/words/remark_words.h"
#include "tests/fixtures/clean_day.h"
#include "tests/fixtures/simulated_lab.h"
#include "tests/fixtures/spoil.h"
#include "tests/fixtures/spoilt_forms.h"

// The usual mistakes, each in a good day of which nothing else is wrong: named with the change that takes them back.
// bench/mistakes_found measures the same on more days, with what they do to the stiffnesses.

namespace stiffscope {
namespace find_mistakes_test {

TEST(MistakeIds, AreThoseOfTheDocumentation) {
  std::ifstream file(std::filesystem::path(STIFFSCOPE_SOURCE_DIR) / "docs" / "results.md");
  std::vector<std::string> documented;
  bool there = false;
  const std::regex row("\\| `([a-z_]+)` \\|.*");
  std::smatch found;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("##")) there = line == "### Mistakes that `audit` names";
    if (there && std::regex_match(line, found, row)) documented.push_back(found[1]);
  }
  // MistakeId does not compile with another id than these.
  EXPECT_EQ(documented, std::vector<std::string>(mistakes::kMistakeIds.begin(), mistakes::kMistakeIds.end()));
}

const campaign::Campaign& goodDay() {
  static const campaign::Campaign campaign =
      campaign::readCampaign(std::filesystem::path(STIFFSCOPE_SOURCE_DIR) / "samples" / "active").campaign;
  return campaign;
}

std::string said(const mistakes::ModelAgreement& agreement) {
  std::string text;
  for (const auto* cures : {&agreement.arm, &agreement.loads}) {
    for (const mistakes::Suspected& one : *cures)
      text += fmt::format("{}: {}: {}\n", one.mistake.name(), reports::words(one.where), reports::words(one.remedy));
  }
  return text;
}

/// Those that other checks of the audit name, and one that is not found (docs/validation.md).
const std::set<std::string>& namedElsewhere() {
  static const std::set<std::string> names{"two exchanged, loaded states", "tracker's noise ten times too large",
                                           "load cell's noise ten times too large",
                                           "point on the wrong side of the flange"};
  return names;
}

TEST(FindMistakes, SuspectsNothingOfTheSample) {
  const mistakes::ModelAgreement agreement = mistakes::findMistakes(goodDay());
  EXPECT_FALSE(agreement.contradicted()) << said(agreement);
  // The machine has bearings that give: springs leave a tenth.
  EXPECT_NEAR(*agreement.loads_left, 0.1, 0.02);
  EXPECT_LT(*agreement.arm_miss, 1e-3);  // geometry errors of 0.2 mm and 0.02 deg
}

TEST(FindMistakes, NamesEachSpoiltForm) {
  const std::vector<SpoiltForm>& forms = spoiltForms();
  std::vector<std::string> wrong(forms.size());
  // Every third in the suite, which takes a quarter of a minute; all where more days are asked for, too.
  const std::size_t every = daysOr(0) > 0 ? 1 : 3;
  numerics::onAllCores(forms.size(), [&](std::size_t i) {
    if (i % every != 0) return;
    campaign::Campaign day = goodDay();
    if (namedElsewhere().contains(forms[i].name) || !forms[i].spoil(day)) return;
    const mistakes::ModelAgreement agreement = mistakes::findMistakes(day);
    const std::string text = said(agreement);
    const bool named = std::any_of(forms[i].cures.begin(), forms[i].cures.end(),
                                   [&](const std::string& cure) { return text.find(cure) != std::string::npos; });
    if (!named || !agreement.contradicted())
      wrong[i] = fmt::format("{}, {}: {}", forms[i].family, forms[i].name, text.empty() ? "nothing said" : text);
  });
  for (const std::string& one : wrong) EXPECT_TRUE(one.empty()) << one;
}

TEST(FindMistakes, NamesFileColumnAndFigures) {
  campaign::Campaign day = goodDay();
  for (auto& row : day.states->rows) row.q[3] *= -1.0;
  const mistakes::ModelAgreement agreement = mistakes::findMistakes(day);
  ASSERT_EQ(agreement.arm.size(), 1u) << said(agreement);
  const mistakes::Suspected& one = agreement.arm.front();
  EXPECT_EQ(one.mistake, "joint_sign");
  EXPECT_EQ(reports::words(one.where), "columns q1_deg to q6_deg of states.csv");
  EXPECT_EQ(reports::words(one.remedy), "turn the sign of joint 4 (q4_deg)");
  EXPECT_GT(one.before, 0.05);  // m
  EXPECT_LT(one.after, 1e-3);
  EXPECT_TRUE(agreement.loads.empty()) << said(agreement);
}

TEST(FindMistakes, NamesTheRowOfOnePosture) {
  campaign::Campaign day = goodDay();
  std::size_t line = 0;
  for (auto& row : day.states->rows) {
    if (row.pose != 7) continue;
    if (line == 0) line = row.line;
    row.q.reverseInPlace();
  }
  const mistakes::ModelAgreement agreement = mistakes::findMistakes(day);
  ASSERT_EQ(agreement.arm.size(), 1u) << said(agreement);
  EXPECT_EQ(reports::words(agreement.arm.front().where),
            fmt::format("pose 8, q1_deg to q6_deg from states.csv:{} on", line));
}

// A shift by a step has the wrench of one of the two where it belongs, and would pass for the mistake.
TEST(FindMistakes, NamesALoadExchangedWithTheReturnToZero) {
  for (const bool of_points : {false, true}) {
    campaign::Campaign day = simulation::simulate(cleanDay(31, 1.0));
    ASSERT_TRUE(spoil::exchangeSteps(3, 4, of_points)(day));
    const mistakes::ModelAgreement agreement = mistakes::findMistakes(day);
    ASSERT_EQ(agreement.loads.size(), 1u) << said(agreement);
    EXPECT_EQ(reports::words(agreement.loads.front().remedy), "exchange the wrenches of steps 3 and 4");
    EXPECT_LT(agreement.loads.front().after, 0.05);
  }
}

TEST(FindMistakes, NamesWrenchesShiftedByAStep) {
  campaign::Campaign day = simulation::simulate(cleanDay(31, 1.0));
  ASSERT_TRUE(spoil::wrenchOf(0, -1)(day));
  const mistakes::ModelAgreement agreement = mistakes::findMistakes(day);
  ASSERT_EQ(agreement.loads.size(), 1u) << said(agreement);
  EXPECT_EQ(reports::words(agreement.loads.front().remedy),
            "each wrench stands a step late: that of a step is in the row of the next step");
}

// Springs leave little of a day of which three wrenches are two thirds of what they should be; their digits tell.
TEST(FindMistakes, NamesStepsThatHaveTheWrenchOfTheStepBefore) {
  campaign::Campaign day = simulation::simulate(cleanDay(31, 1.0));
  const std::set<int> stale{2, 7, 11};
  std::map<int, Vector6d> second;
  for (const campaign::State& row : day.states->rows) {
    if (row.step == 2) second[row.pose] = row.wrench_in_cell;
  }
  for (campaign::State& row : day.states->rows) {
    if (row.step == 3 && stale.contains(row.pose)) row.wrench_in_cell = second.at(row.pose);
  }
  const mistakes::ModelAgreement agreement = mistakes::findMistakes(day);
  ASSERT_EQ(agreement.loads.size(), 1u) << said(agreement);
  EXPECT_EQ(agreement.loads.front().mistake, "row_order");
  EXPECT_EQ(reports::words(agreement.loads.front().remedy),
            fmt::format("poses {}, {}, {}: step 3 has the wrench of step 2, digit by digit: write its own",
                        day.pose_ids[2], day.pose_ids[7], day.pose_ids[11]));
}

// The other steps agree within a hundredth: a fifth stands out of that.
TEST(FindMistakes, NamesAStepOfAFifthTooMuch) {
  for (const double factor : {1.2, 1.0 / 1.2}) {
    campaign::Campaign day = simulation::simulate(cleanDay(31, 1.0));
    for (campaign::State& row : day.states->rows) {
      if (row.step == 2) row.wrench_in_cell *= factor;
    }
    const mistakes::ModelAgreement agreement = mistakes::findMistakes(day);
    ASSERT_EQ(agreement.loads.size(), 1u) << said(agreement);
    EXPECT_EQ(agreement.loads.front().mistake, "step_scale");
    EXPECT_EQ(std::get<std::int64_t>(agreement.loads.front().remedy.values.at(0)), 2);
    EXPECT_NEAR(std::get<double>(agreement.loads.front().remedy.values.at(1)), factor, 0.02);
  }
}

// Joints that stiffen, have play or stick put the first step apart from the others, and are no wrong step.
TEST(FindMistakes, JointsThatAreNotLinearAreNoWrongStep) {
  for (const int kind : {0, 1, 2}) {
    simulation::SimulationSpec spec = cleanDay(32, 1.0);
    for (auto& joint : spec.machine.joints) {
      const double rate = *joint.torsion;
      if (kind == 0) joint.stages = simulation::JointStages{{1e-4 * rate, 3e-4 * rate}, {0.4 * rate, 0.7 * rate, rate}};
      if (kind == 1) joint.backlash = simulation::JointBacklash{2e-4};
      if (kind == 2) joint.friction = simulation::JointFriction{1e-4 * rate, rate};
    }
    const mistakes::ModelAgreement agreement = mistakes::findMistakes(simulation::simulate(spec));
    EXPECT_TRUE(agreement.loads.empty()) << kind << ": " << said(agreement);
  }
}

/// The sample with the angles of the posture after its own, or before it, from the tenth on.
mistakes::ModelAgreement withRowsShifted(bool lost) {
  campaign::Campaign day = goodDay();
  std::map<int, JointVector> q;
  for (const auto& row : day.states->rows) q.emplace(row.pose, row.q);
  const int last = static_cast<int>(q.size()) - 1;
  for (auto& row : day.states->rows) {
    if (row.pose >= 9) row.q = q.at(lost ? std::min(row.pose + 1, last) : row.pose - 1);
  }
  return mistakes::findMistakes(day);
}

// The figure that is said is that of the postures that the change mends: as large as on the good day.
TEST(FindMistakes, SaysWhatShiftedRowsMissOnceTheyAreMended) {
  const double good = *mistakes::findMistakes(goodDay()).arm_miss;
  for (const bool lost : {true, false}) {
    const mistakes::ModelAgreement agreement = withRowsShifted(lost);
    ASSERT_EQ(agreement.arm.size(), 1u) << said(agreement);
    const mistakes::Suspected& one = agreement.arm.front();
    EXPECT_NE(said(agreement).find(lost ? "a row of the log is lost" : "a row of the log is too many"),
              std::string::npos)
        << said(agreement);
    EXPECT_GT(one.before, 0.5);  // m
    EXPECT_LT(one.after, 2.0 * good) << lost;
    // The loads of the mended postures are explained as on the good day.
    EXPECT_TRUE(agreement.loads.empty()) << said(agreement);
    EXPECT_NEAR(*agreement.loads_left, 0.1, 0.03);
  }
}

TEST(FindMistakes, NamesTwoAtOnce) {
  campaign::Campaign day = goodDay();
  const auto spoil = [](JointVector& q) {
    q[2] -= q[1];
    q[4] *= -1.0;
  };
  for (auto& row : day.states->rows) spoil(row.q);
  for (auto& row : day.circle_sweeps->rows) spoil(row.q);
  for (auto& row : day.wrist_sweep->rows) spoil(row.q);
  for (auto& row : day.states->rows) row.wrench_in_cell.head<3>() *= -1.0;
  const std::string text = said(mistakes::findMistakes(day));
  for (const char* const part : {"joint 3 without joint 2", "sign of joint 5", "sign of fx_n, fy_n, fz_n"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
}

// No sweeps, no nests, no masses, points in the base: the postures of the loading are enough.
TEST(FindMistakes, NeedsNoSweeps) {
  campaign::Campaign day = goodDay();
  day.circle_sweeps.reset();
  day.wrist_sweep.reset();
  day.nests.reset();
  for (robot::BodyMass& body : day.robot.bodies) body = {};
  EXPECT_FALSE(mistakes::findMistakes(day).contradicted());
  for (auto& row : day.states->rows) std::swap(row.q[3], row.q[5]);
  const std::string text = said(mistakes::findMistakes(day));
  EXPECT_NE(text.find("order 1, 2, 3, 6, 5, 4"), std::string::npos) << text;
}

// Displacements in the base alone: the arm cannot be held against the URDF, the loads can.
TEST(FindMistakes, OfDisplacementsTheLoadsTell) {
  SimulatedLab lab;
  lab.withoutMasses();
  lab.compliance << 2e-7, 3e-7, 4e-7, 2e-6, 4e-6, 6e-6;
  lab.tracker_from_base = Eigen::Isometry3d::Identity();
  campaign::Campaign day = fullDay(lab, [](int) { return Eigen::Vector3d(0.0, 0.0, -800.0); });
  day.displacements = campaign::Displacements{"displacements.csv", campaign::PointFrame::base_link, {}};
  std::map<std::pair<int, int>, Eigen::Vector3d> unloaded;
  for (const auto& row : day.loading->rows) {
    if (row.step == 0) unloaded[{row.pose, row.target}] = row.point;
  }
  for (const auto& row : day.loading->rows) {
    if (row.step == 0) continue;
    day.displacements->rows.push_back(
        {row.pose, row.step, row.target, row.point - unloaded.at({row.pose, row.target})});
  }
  day.loading.reset();
  day.circle_sweeps.reset();
  day.wrist_sweep.reset();
  for (std::size_t k = 0; k < day.targets.size(); ++k) day.targets[k].position_in_flange = lab.targets_in_flange[k];
  const mistakes::ModelAgreement good = mistakes::findMistakes(day);
  EXPECT_FALSE(good.arm_miss);
  ASSERT_TRUE(good.loads_left);
  EXPECT_FALSE(good.contradicted()) << said(good);
  for (auto& row : day.states->rows) row.wrench_in_cell.head<3>() *= -1.0;
  const std::string text = said(mistakes::findMistakes(day));
  EXPECT_NE(text.find("turn the sign of fx_n, fy_n, fz_n"), std::string::npos) << text;
}

/// Whether the day of a rigid arm with reflectors at these places, of which only the first `read` were read, is said to
/// have them on one line.
bool saysOnLine(const std::vector<Eigen::Vector3d>& targets_in_flange, int read) {
  SimulatedLab lab;
  lab.withoutMasses();
  lab.targets_in_flange = targets_in_flange;
  campaign::Campaign day = fullDay(lab, hangingForce);
  const auto keepRead = [&](auto& table) {
    std::erase_if(table.rows, [&](const auto& row) { return row.target >= read; });
  };
  keepRead(*day.loading), keepRead(*day.circle_sweeps), keepRead(*day.wrist_sweep);
  const mistakes::ModelAgreement agreement = mistakes::findMistakes(day);
  EXPECT_LT(agreement.arm_miss.value_or(1.0), 1e-6) << "the arm was not fitted";
  return std::any_of(agreement.arm.begin(), agreement.arm.end(),
                     [](const mistakes::Suspected& one) { return one.mistake == "reflectors_on_line"; });
}

// Where a reflector stands that was never read nothing says: not at the flange's origin, and not on a line.
TEST(FindMistakes, ReflectorsThatWereNeverReadAreOnNoLine) {
  const std::vector<Eigen::Vector3d> spread = SimulatedLab().targets_in_flange;
  EXPECT_FALSE(saysOnLine(spread, 3));
  EXPECT_FALSE(saysOnLine(spread, 1));
  // Two are always on a line, these with the flange's origin on it.
  EXPECT_FALSE(saysOnLine({spread[0], 0.4 * spread[0], spread[2]}, 2));
}

TEST(FindMistakes, ThreeReflectorsOnALineAreNamedBesideOneThatWasNeverRead) {
  const Eigen::Vector3d first(0.28, 0.05, 0.12), along(-0.2, 0.1, 0.05);
  const std::vector<Eigen::Vector3d> on_line{first, first + along, first + 1.7 * along, {-0.1, -0.3, 0.21}};
  EXPECT_TRUE(saysOnLine(on_line, 3));
  EXPECT_FALSE(saysOnLine(on_line, 4));
}

// A day that no one mistake explains: noise for angles.
TEST(FindMistakes, FailsForWhatItIs) {
  campaign::Campaign day = goodDay();
  double at = 0.1;
  for (auto& row : day.states->rows) {
    if (row.step == 0) at = at * 3.9 * (1.0 - at);  // the logistic map, which repeats nothing
    row.q = (Vector6d() << at + 0.3, 1.7 * at, at - 0.6, 2.9 * at, -at * at, 5.0 * at).finished();
  }
  const mistakes::ModelAgreement agreement = mistakes::findMistakes(day);
  EXPECT_TRUE(agreement.arm_contradicted);
  EXPECT_TRUE(agreement.arm.empty()) << said(agreement);
}

TEST(FindMistakes, AccusesNoCleanDay) {
  for (int day = 0; day < daysOr(5); ++day) {
    const mistakes::ModelAgreement agreement =
        mistakes::findMistakes(simulation::simulate(cleanDay(300 + static_cast<std::uint64_t>(day), 1.0)));
    EXPECT_FALSE(agreement.contradicted()) << said(agreement);
  }
}

}  // namespace find_mistakes_test
}  // namespace stiffscope
