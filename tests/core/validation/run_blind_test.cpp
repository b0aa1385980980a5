#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include "core/io/read_file.h"
#include "core/validation/run_blind.h"

namespace stiffscope {

namespace fs = std::filesystem;

namespace run_blind_test {

std::string bytesOf(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

/// Stands in for the diagnosis: hysteresis where the return to zero is far from step 0, else none.
validation::Answer standIn(const campaign::Campaign& campaign) {
  double far = 0.0;
  Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  for (const campaign::LoadingReading& one : campaign.loading->rows) {
    if (one.target != 0) continue;
    if (one.step == 0) zero = one.point;
    if (one.step == 4) far = std::max(far, (one.point - zero).norm());
  }
  validation::Answer answer;
  if (far > 1.5e-4) answer.entries = {{{"hysteresis"}, ""}};
  return answer;
}

class BlindRun : public testing::Test {
 protected:
  fs::path folder = fs::temp_directory_path() /
                    ("stiffscope_blind_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
  void SetUp() override { fs::remove_all(folder); }
  void TearDown() override { fs::remove_all(folder); }

  validation::BlindOptions options(int cases, int threads, const char* name) const {
    return {cases, 7, folder / name, false, threads};
  }
};

TEST_F(BlindRun, theSameSeedGivesTheSameBytesOnAnyNumberOfThreads) {
  const validation::BlindResult one = validation::runBlind(options(5, 1, "one"), standIn),
                                two = validation::runBlind(options(5, 2, "two"), standIn);
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
  validation::BlindOptions other = options(5, 2, "three");
  other.seed = 8;
  EXPECT_NE(validation::runBlind(other, standIn).seal, one.seal);
}

double standInDistance(const campaign::Campaign& campaign) {
  return campaign.loading->rows.front().point.norm() / 3.0;  // has all its digits
}

// A case is asked for once, whatever is killed: what an earlier run of a shard did is kept.
TEST_F(BlindRun, shardsJoinToTheBytesOfTheWhole) {
  const validation::BlindOptions whole = options(7, 2, "whole"), parts = options(7, 1, "parts");
  const validation::BlindResult expected = validation::runBlind(whole, standIn, {}, standInDistance);
  int asked = 0, until = 2;
  const auto counted = [&](const campaign::Campaign& campaign) {
    if (++asked > until) throw std::bad_alloc();  // no answer of the diagnosis: as if killed
    return standIn(campaign);
  };
  const auto killed = [&](const campaign::Campaign& campaign) { return counted(campaign); };
  validation::BlindEvents stop;
  stop.progress = [](const char* stage, int done, int) {
    if (std::string(stage) == "diagnosed" && done == 2) throw std::logic_error("killed");
  };
  EXPECT_THROW(validation::runBlindShard(parts, {0, 2}, "1", killed, stop, standInDistance), std::logic_error);
  EXPECT_EQ(asked, 2);
  EXPECT_THROW(validation::mergeBlind(parts, "1"), std::runtime_error);
  until = 7;
  validation::runBlindShard(parts, {0, 2}, "1", killed, {}, standInDistance);
  EXPECT_EQ(asked, 4);
  validation::runBlindShard(parts, {1, 2}, "1", killed, {}, standInDistance);
  EXPECT_EQ(asked, 7);
  const validation::BlindResult joined = validation::mergeBlind(parts, "1");
  EXPECT_EQ(joined.seal, expected.seal);
  EXPECT_EQ(joined.answers_hash, expected.answers_hash);
  for (const char* file : {"labels.csv", "answers.csv", "distances.csv", "seal.txt"})
    EXPECT_EQ(bytesOf(folder / "parts" / file), bytesOf(folder / "whole" / file)) << file;
  // Another version, or other options, have done nothing yet.
  EXPECT_THROW(validation::mergeBlind(parts, "2"), std::runtime_error);
}

TEST_F(BlindRun, aShardsLabelsAreWhatItSealed) {
  const validation::BlindOptions asked = options(2, 1, "run");
  validation::runBlindShard(asked, {0, 1}, "1", standIn);
  fs::path label;
  for (const auto& entry : fs::recursive_directory_iterator(folder / "run" / "parts")) {
    if (entry.path().filename() == "0001.label") label = entry.path();
  }
  std::string bytes = bytesOf(label);
  bytes[bytes.size() - 2] = bytes[bytes.size() - 2] == '1' ? '2' : '1';
  std::ofstream(label, std::ios::binary) << bytes;
  EXPECT_THROW(validation::mergeBlind(asked, "1"), std::runtime_error);
  EXPECT_THROW(validation::runBlindShard(asked, {0, 1}, "1", standIn), std::runtime_error);
}

// Sealed first, then diagnosed, then frozen, then opened.
TEST_F(BlindRun, theSealComesFirstAndIsCheckedLast) {
  const validation::BlindOptions asked = options(3, 1, "run");
  std::string seal;
  bool frozen = false;
  validation::BlindEvents events;
  events.sealed = [&](const std::string& hash) {
    seal = hash;
    EXPECT_EQ(hash, io::sha256Hex(bytesOf(asked.out / "labels.csv")));
    EXPECT_EQ(bytesOf(asked.out / "seal.txt"), hash + "  labels.csv\n");
    EXPECT_FALSE(fs::exists(asked.out / "answers.csv"));
  };
  events.frozen = [&](const std::string& hash) {
    frozen = true;
    EXPECT_EQ(hash, io::sha256Hex(bytesOf(asked.out / "answers.csv")));
  };
  const auto after_seal = [&](const campaign::Campaign& campaign) {
    EXPECT_FALSE(seal.empty());
    EXPECT_FALSE(frozen);
    return standIn(campaign);
  };
  EXPECT_EQ(validation::runBlind(asked, after_seal, events).seal, seal);
  EXPECT_TRUE(frozen);
}

TEST_F(BlindRun, aLabelThatIsChangedBreaksTheSeal) {
  const validation::BlindOptions asked = options(3, 1, "run");
  validation::BlindEvents events;
  events.frozen = [&](const std::string&) { std::ofstream(asked.out / "labels.csv", std::ios::app) << "\n"; };
  try {
    validation::runBlind(asked, standIn, events);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("labels.csv: not what was sealed"), std::string::npos) << error.what();
  }
  validation::Label label;
  const std::string before = io::sha256Hex(validation::labelsCsv({label}));
  label.noise_factor = 1.0001;
  EXPECT_NE(io::sha256Hex(validation::labelsCsv({label})), before);
}

TEST_F(BlindRun, aDiagnosisThatThrowsHasNotAnswered) {
  validation::BlindOptions asked = options(2, 2, "run");
  asked.discard = true;
  const validation::BlindResult result = validation::runBlind(
      asked, [](const campaign::Campaign&) -> validation::Answer { throw std::runtime_error("no, nothing"); });
  EXPECT_EQ(result.score.rate("failed").hits, 2);
  EXPECT_EQ(result.score.cases[0].answer.failure, "no  nothing");
  EXPECT_FALSE(fs::exists(asked.out / "cases"));
}

// Asked after the answers are frozen, of large effects outside the vocabulary alone.
TEST_F(BlindRun, distancesAreKeptBesideTheAnswers) {
  const validation::BlindOptions asked = options(9, 2, "run");
  const fs::path file = asked.out / "distances.csv";
  bool frozen = false;
  validation::BlindEvents events;
  events.frozen = [&](const std::string&) { frozen = true; };
  const validation::BlindResult result = validation::runBlind(asked, standIn, events, [&](const campaign::Campaign&) {
    EXPECT_TRUE(frozen);
    return 2.5;
  });
  std::string expected = "case,noises\n";
  int large = 0;
  for (const validation::ScoredCase& one : result.score.cases) {
    const bool is_large = one.label.kind == validation::CaseKind::outside && one.label.effects.front().size >= 2.0;
    EXPECT_EQ(one.distance.has_value(), is_large);
    if (is_large) expected += one.label.name + ",2.5\n";
    large += is_large ? 1 : 0;
  }
  EXPECT_EQ(bytesOf(file), expected);
  EXPECT_EQ(result.score.rate("unknown_apart").trials, large);
}

TEST_F(BlindRun, leavesSomebodyElsesFolderAlone) {
  fs::create_directories(folder / "run" / "cases");
  EXPECT_THROW(validation::runBlind(options(1, 1, "run"), standIn), std::runtime_error);
  EXPECT_TRUE(fs::exists(folder / "run" / "cases"));
}

TEST(BlindPlan, sharesAndBalance) {
  const std::vector<validation::CasePlan> plans = validation::planCases(320, 3);
  std::map<validation::CaseKind, int> kinds;
  std::map<std::string, int> singles;
  for (const validation::CasePlan& plan : plans) {
    ++kinds[plan.kind];
    if (plan.kind == validation::CaseKind::single) ++singles[plan.effects.front()];
    if (plan.kind == validation::CaseKind::pair) {
      EXPECT_NE(plan.effects[0], plan.effects[1]);
    }
  }
  EXPECT_EQ(kinds[validation::CaseKind::none], 64);
  EXPECT_EQ(kinds[validation::CaseKind::pair], 40);
  EXPECT_EQ(kinds[validation::CaseKind::outside], 40);
  EXPECT_EQ(kinds[validation::CaseKind::as_is], 40);
  EXPECT_EQ(singles.size(), effects::kEffectCount - 1);  // without the rail's
  for (const auto& [effect, count] : singles) EXPECT_NEAR(count, 8.5, 0.6) << effect;
}

// The share that is asked for comes off the singles alone; without it all is as before there were such machines.
TEST(BlindPlan, aShareIsOfMachinesAsTheyAre) {
  const auto count = [](const std::vector<validation::CasePlan>& plans, validation::CaseKind kind) {
    return std::count_if(plans.begin(), plans.end(), [kind](const auto& plan) { return plan.kind == kind; });
  };
  const auto none = validation::planCases(80, 3, 0.0), half = validation::planCases(80, 3, 0.5);
  EXPECT_EQ(count(none, validation::CaseKind::as_is), 0);
  EXPECT_EQ(count(none, validation::CaseKind::single), 44);
  EXPECT_EQ(count(half, validation::CaseKind::as_is), 40);
  EXPECT_EQ(count(half, validation::CaseKind::single), 4);
  for (const auto kind : {validation::CaseKind::none, validation::CaseKind::pair, validation::CaseKind::outside})
    EXPECT_EQ(count(none, kind), count(half, kind));
  int with_base = 0;
  for (const validation::CasePlan& plan : half) {
    if (plan.kind != validation::CaseKind::as_is) continue;
    EXPECT_TRUE(plan.effects.size() == 2 || plan.effects.size() == 4);
    with_base += plan.effects.size() == 4 ? 1 : 0;
  }
  EXPECT_EQ(with_base, 20);
}

}  // namespace run_blind_test

}  // namespace stiffscope
