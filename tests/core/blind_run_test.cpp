#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/blind/run_blind.h"
#include "core/input/sha256.h"

namespace stiffscope {

namespace fs = std::filesystem;
using namespace blind;

namespace {

std::string bytesOf(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

/// Stands in for the diagnosis: hysteresis where the return to zero is far from step 0, else none.
DiagnosisAnswer standIn(const Campaign& campaign) {
  double far = 0.0;
  Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  for (const LoadingReading& one : campaign.loading->rows) {
    if (one.target != 0) continue;
    if (one.step == 0) zero = one.point;
    if (one.step == 4) far = std::max(far, (one.point - zero).norm());
  }
  DiagnosisAnswer answer;
  if (far > 1.5e-4) answer.verdict.entries = {{{Effect::hysteresis}, ""}};
  return answer;
}

class BlindRun : public testing::Test {
 protected:
  fs::path folder =
      fs::temp_directory_path() /
      ("stiffscope_blind_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
  void SetUp() override { fs::remove_all(folder); }
  void TearDown() override { fs::remove_all(folder); }

  BlindOptions options(int cases, int threads, const char* name) const {
    return {cases, 7, folder / name, false, threads};
  }
};

}  // namespace

TEST_F(BlindRun, theSameSeedGivesTheSameBytesOnAnyNumberOfThreads) {
  const BlindResult one = runBlind(options(5, 1, "one"), standIn),
                    two = runBlind(options(5, 2, "two"), standIn);
  EXPECT_EQ(one.seal, two.seal);
  EXPECT_EQ(one.answers_hash, two.answers_hash);
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder / "one")) {
    if (!entry.is_regular_file()) continue;
    ++files;
    EXPECT_EQ(bytesOf(entry.path()), bytesOf(folder / "two" / fs::relative(entry.path(), folder / "one")))
        << entry.path();
  }
  EXPECT_EQ(files, 5u * 7 + 3);  // campaign.xml, robot.urdf, five tables; labels, answers, seal
  BlindOptions other = options(5, 2, "three");
  other.seed = 8;
  EXPECT_NE(runBlind(other, standIn).seal, one.seal);
}

// Sealed first, then diagnosed, then frozen, then opened.
TEST_F(BlindRun, theSealComesFirstAndIsCheckedLast) {
  const BlindOptions asked = options(3, 1, "run");
  std::string seal;
  bool frozen = false;
  BlindEvents events;
  events.sealed = [&](const std::string& hash) {
    seal = hash;
    EXPECT_EQ(hash, sha256Hex(bytesOf(asked.out / "labels.csv")));
    EXPECT_EQ(bytesOf(asked.out / "seal.txt"), hash + "  labels.csv\n");
    EXPECT_FALSE(fs::exists(asked.out / "answers.csv"));
  };
  events.frozen = [&](const std::string& hash) {
    frozen = true;
    EXPECT_EQ(hash, sha256Hex(bytesOf(asked.out / "answers.csv")));
  };
  const auto after_seal = [&](const Campaign& campaign) {
    EXPECT_FALSE(seal.empty());
    EXPECT_FALSE(frozen);
    return standIn(campaign);
  };
  EXPECT_EQ(runBlind(asked, after_seal, events).seal, seal);
  EXPECT_TRUE(frozen);
}

TEST_F(BlindRun, aLabelThatIsChangedBreaksTheSeal) {
  const BlindOptions asked = options(3, 1, "run");
  BlindEvents events;
  events.frozen = [&](const std::string&) { std::ofstream(asked.out / "labels.csv", std::ios::app) << "\n"; };
  try {
    runBlind(asked, standIn, events);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("labels.csv: not what was sealed"), std::string::npos)
        << error.what();
  }
  Label label;
  const std::string before = sha256Hex(labelsCsv({label}));
  label.noise_factor = 1.0001;
  EXPECT_NE(sha256Hex(labelsCsv({label})), before);
}

TEST_F(BlindRun, aDiagnosisThatThrowsHasNotAnswered) {
  BlindOptions asked = options(2, 2, "run");
  asked.discard = true;
  const BlindResult result =
      runBlind(asked, [](const Campaign&) -> DiagnosisAnswer { throw std::runtime_error("no, nothing"); });
  EXPECT_EQ(result.score.rate("failed").hits, 2);
  EXPECT_EQ(result.score.cases[0].answer.failure, "no  nothing");
  EXPECT_FALSE(fs::exists(asked.out / "cases"));
}

// Asked after the answers are frozen, of large effects outside the vocabulary alone.
TEST_F(BlindRun, distancesAreKeptBesideTheAnswers) {
  const BlindOptions asked = options(9, 2, "run");
  const fs::path file = asked.out / "distances.csv";
  bool frozen = false;
  BlindEvents events;
  events.frozen = [&](const std::string&) { frozen = true; };
  const BlindResult result = runBlind(asked, standIn, events, [&](const Campaign&) {
    EXPECT_TRUE(frozen);
    return 2.5;
  });
  std::string expected = "case,noises\n";
  int large = 0;
  for (const ScoredCase& one : result.score.cases) {
    const bool is_large = one.label.kind == CaseKind::outside && one.label.effects.front().size >= 2.0;
    EXPECT_EQ(one.distance.has_value(), is_large);
    if (is_large) expected += one.label.name + ",2.5\n";
    large += is_large ? 1 : 0;
  }
  EXPECT_EQ(bytesOf(file), expected);
  EXPECT_EQ(result.score.rate("unknown_apart").trials, large);
}

TEST_F(BlindRun, leavesSomebodyElsesFolderAlone) {
  fs::create_directories(folder / "run" / "cases");
  EXPECT_THROW(runBlind(options(1, 1, "run"), standIn), std::runtime_error);
  EXPECT_TRUE(fs::exists(folder / "run" / "cases"));
}

TEST(BlindPlan, sharesAndBalance) {
  const std::vector<CasePlan> plans = planCases(320, 3);
  std::map<CaseKind, int> kinds;
  std::map<Effect, int> singles;
  for (const CasePlan& plan : plans) {
    ++kinds[plan.kind];
    if (plan.kind == CaseKind::single) ++singles[plan.effects.front()];
    if (plan.kind == CaseKind::pair) {
      EXPECT_NE(plan.effects[0], plan.effects[1]);
    }
  }
  EXPECT_EQ(kinds[CaseKind::none], 64);
  EXPECT_EQ(kinds[CaseKind::pair], 40);
  EXPECT_EQ(kinds[CaseKind::outside], 40);
  EXPECT_EQ(singles.size(), kEffectCount);
  for (const auto& [effect, count] : singles) EXPECT_NEAR(count, 11, 1) << idOf(effect);
}

}  // namespace stiffscope
