#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/app/command.h"

namespace stiffscope {
namespace blind_test {

namespace fs = std::filesystem;

TEST(Blind, SealsDiagnosesAndScores) {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "blind";
  const Ran ran =
      runProgram("blind --cases 2 --seed 4 --discard --json - --out '" + out.string() + "'", scratch.path());
  ASSERT_EQ(ran.status, 0) << ran.err;
  const nlohmann::json json = nlohmann::json::parse(ran.out);
  EXPECT_EQ(nlohmann::json::parse(contentsOf(out / "results.json")), json);
  ASSERT_EQ(json["cases"].size(), 2u);
  EXPECT_EQ(json["rates"]["failed"]["hits"], 0);
  // Silent in a pipe but for the two hashes, the seal first.
  EXPECT_EQ(ran.err, "labels sealed, SHA-256 " + json["seal"].get<std::string>() + "\nanswers frozen, SHA-256 " +
                         json["answers_sha256"].get<std::string>() + "\n");
  EXPECT_EQ(contentsOf(out / "seal.txt").find(json["seal"].get<std::string>() + "  labels.csv\n"), 0u);
  EXPECT_FALSE(fs::exists(out / "cases"));
  EXPECT_EQ(contentsOf(out / "blind.html").rfind("<!DOCTYPE html>", 0), 0u);
}

// The vocabulary of days without a load, in every table; machines as they are belong to loaded days.
TEST(Blind, OfDaysWithoutALoad) {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "blind";
  const std::string asked = "blind --unloaded --cases 3 --seed 4 --json - --out '" + out.string() + "'";
  const Ran ran = runProgram(asked, scratch.path());
  ASSERT_EQ(ran.status, 0) << ran.err;
  const nlohmann::json json = nlohmann::json::parse(ran.out);
  EXPECT_EQ(json["unloaded"], true);
  ASSERT_EQ(json["cases"].size(), 3u);
  EXPECT_EQ(json["rates"]["failed"]["hits"], 0);
  EXPECT_EQ(json["effects"][0]["effect"], "kinematic_error");
  EXPECT_EQ(json["effects"].size(), 15u);
  EXPECT_EQ(json["confusion"]["truths"].size(), 17u);  // none and outside as well
  EXPECT_TRUE(json["as_is"].empty());
  EXPECT_TRUE(fs::exists(out / "cases" / "0001" / "states.csv"));
  EXPECT_FALSE(fs::exists(out / "cases" / "0001" / "wrist_sweep.csv"));
  EXPECT_NE(contentsOf(out / "blind.html").find("on days without a load"), std::string::npos);
  const Ran refused = runProgram("blind --unloaded --as-is 0.1 --out '" + out.string() + "'", scratch.path());
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find("--as-is"), std::string::npos) << refused.err;
}

TEST(Blind, RefusesNoCases) {
  const ScratchFolder scratch;
  const Ran ran = runProgram("blind --cases 0 --out '" + scratch.path().string() + "'", scratch.path());
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.err.find("--cases"), std::string::npos) << ran.err;
}

}  // namespace blind_test
}  // namespace stiffscope
