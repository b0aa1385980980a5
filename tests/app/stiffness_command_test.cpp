// `stiffness`: numbers against `identify` and against the prediction under a force, files, refusals.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/app/command.h"

namespace stiffscope {
namespace stiffness_command_test {

namespace fs = std::filesystem;
using nlohmann::json;

const std::string kSample = "'" STIFFSCOPE_SOURCE_DIR "/samples/active'";

json jsonOf(const std::string& words, const ScratchFolder& scratch) {
  const Ran ran = runProgram(words + " --json -", scratch.path());
  EXPECT_NE(ran.status, 2) << ran.err;
  return json::parse(ran.out);
}

Eigen::Vector3d vectorOf(const json& list) {
  return {list[0].get<double>(), list[1].get<double>(), list[2].get<double>()};
}

TEST(StiffnessCommand, KxIsThatOfIdentifyWhereAllItsJointsAreKnown) {
  const ScratchFolder scratch;
  // k1 from elsewhere: then nothing is unknown.
  const fs::path folder = scratch.path() / "known";
  fs::copy(STIFFSCOPE_SOURCE_DIR "/samples/active", folder);
  std::string xml = contentsOf(folder / "campaign.xml");
  xml.insert(xml.find("<tracker"),
             "<known_stiffness joint=\"1\" nm_per_rad=\"7e6\" sd_nm_per_rad=\"1e5\" source=\"maker\"/>\n  ");
  std::ofstream(folder / "campaign.xml", std::ios::binary) << xml;
  const json known = jsonOf("stiffness '" + folder.string() + "' --springs-only --spacing 500", scratch),
             unknown = jsonOf("stiffness " + kSample + " --springs-only --spacing 500", scratch);
  EXPECT_TRUE(known["unknown_joints"].empty());
  EXPECT_EQ(unknown["unknown_joints"], json::array({1}));
  ASSERT_EQ(known["postures"].size(), unknown["postures"].size());
  for (std::size_t i = 0; i < known["postures"].size(); ++i) {
    const json &with = known["postures"][i], &without = unknown["postures"][i];
    ASSERT_EQ(with["k_x"].size(), 3u);
    ASSERT_EQ(without["k_x"].size(), 2u);  // none in the direction in which joint 1 moves P_TCP
    // Springs alone: K_x and the whole model are one.
    EXPECT_EQ(with["k_x"], with["model"]);
    const Eigen::Vector3d tcp = vectorOf(with["tcp_m"]);
    const Eigen::Vector3d sideways = Eigen::Vector3d::UnitZ().cross(tcp).normalized();
    for (const json& one : without["k_x"]) EXPECT_NEAR(vectorOf(one["direction"]).dot(sideways), 0.0, 1e-9);
    // Without k1 the arm counts as rigid there: never softer than with it.
    EXPECT_GE(without["k_x"][0]["stiffness_n_per_m"].get<double>(),
              with["k_x"][0]["stiffness_n_per_m"].get<double>() * (1.0 - 1e-9));
    for (const json& one : with["k_x"]) {
      const double k = one["stiffness_n_per_m"];
      EXPECT_LE(one["interval_n_per_m"][0].get<double>(), k);
      if (one["interval_n_per_m"][1].is_number()) EXPECT_GE(one["interval_n_per_m"][1].get<double>(), k);
    }
  }
  const json identified = jsonOf("identify " + kSample + " --springs-only", scratch);
  ASSERT_EQ(identified["posture_stiffness"]["method"], unknown["method"]);
  for (std::size_t i = 0; i < unknown["postures"].size(); ++i) {
    const json& row = identified["posture_stiffness"]["rows"][i];
    // identify takes k1 as rigid: of its compliance what lies at right angles to joint 1's motion is the same.
    Eigen::Matrix3d rigid = Eigen::Matrix3d::Zero();
    for (const json& one : row["k_x_without_kc"]) {
      const Eigen::Vector3d d = vectorOf(one["direction"]);
      if (one["stiffness_n_per_m"].is_number()) rigid += d * d.transpose() / one["stiffness_n_per_m"].get<double>();
    }
    for (const json& one : unknown["postures"][i]["k_x"]) {
      const Eigen::Vector3d d = vectorOf(one["direction"]);
      // One takes the angles as read, the other those of the arm that sags by a thousandth of a posture: some
      // millionths.
      EXPECT_NEAR(d.dot(rigid * d) * one["stiffness_n_per_m"].get<double>(), 1.0, 2e-5);
    }
  }
}

TEST(StiffnessCommand, ThePlacementDeflectsAsTheModelsComplianceSays) {
  const ScratchFolder scratch;
  const fs::path csv = scratch.path() / "places.csv", placements = scratch.path() / "placements.csv",
                 picture = scratch.path() / "slice.png";
  const json found = jsonOf("stiffness " + kSample + " --spacing 400 --force 0,0,-1000 --csv '" + csv.string() +
                                "' --placements '" + placements.string() + "' --picture '" + picture.string() + "'",
                            scratch);
  EXPECT_FALSE(found["model_holds_besides_joints"].empty());  // the sample's bearings
  const json& placement = found["placement"];
  const std::string now = placement["now"], pose = found["slice"]["pose"];
  const json* here = nullptr;
  for (const json& one : placement["offsets"])
    if (one["offset"] == now) here = &one;
  ASSERT_TRUE(here != nullptr && (*here)["judged"].get<bool>());
  for (const json& posture : found["postures"]) {
    if (posture["pose"] != pose) continue;
    Eigen::Matrix3d compliance;
    for (int row = 0; row < 3; ++row) compliance.row(row) = vectorOf(posture["model_compliance_m_per_n"][row]);
    const Eigen::Vector3d straight = 1e3 * compliance * Eigen::Vector3d(0.0, 0.0, -1000.0),
                          predicted = vectorOf((*here)["deflection_vector_mm"]);
    // The prediction is of 1 kN one way, the compliance of the day's 1.5 kN both ways: K_c of the load is between them.
    EXPECT_LT((straight - predicted).norm(), 0.01 * predicted.norm());
    // Bearings give, too: joint springs alone say less.
    Eigen::Matrix3d springs;
    for (int row = 0; row < 3; ++row) springs.row(row) = vectorOf(posture["k_x_compliance_m_per_n"][row]);
    EXPECT_LT(springs(2, 2), compliance(2, 2));
  }
  const std::string best = placement["best"];
  double least = 0.0;
  for (const json& one : placement["offsets"])
    if (one["offset"] == best) least = one["deflection_mm"];
  for (const json& one : placement["offsets"])
    if (one["judged"].get<bool>()) EXPECT_GE(one["deflection_mm"].get<double>(), least);
  EXPECT_EQ(contentsOf(csv).substr(0, 11), "place,pose,");
  EXPECT_EQ(contentsOf(placements).substr(0, 7), "offset,");
  const cv::Mat grey = cv::imread(picture.string(), cv::IMREAD_GRAYSCALE);
  ASSERT_FALSE(grey.empty());
  EXPECT_GT(cv::countNonZero(grey < 200), static_cast<int>(grey.total() / 500));
}

// A hanging day does not know k1, so of a force across the arm nothing is guessed.
TEST(StiffnessCommand, AForceThatTurnsAJointOfUnknownStiffnessIsNotJudged) {
  const ScratchFolder scratch;
  const Ran ran = runProgram("stiffness " + kSample + " --springs-only --spacing 500 --force 0,1000,0", scratch.path());
  EXPECT_EQ(ran.status, 1);
  EXPECT_NE(ran.out.find("None of 125 places could be judged"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("k1 is not known"), std::string::npos) << ran.out;
}

TEST(StiffnessCommand, RefusesWhatItCannotUse) {
  const ScratchFolder scratch;
  std::ofstream(scratch.path() / "offsets.csv") << "offset,dx_mm,dy_mm\na,0,0\n";
  const std::string bad = (scratch.path() / "offsets.csv").string();
  const std::vector<std::pair<std::string, std::string>> refused{
      {"--slice no-such-posture", "--slice: 'no-such-posture': expected a posture that identifies"},
      {"--force 0,0,0", "--force: '0,0,0': expected a force that is not zero"},
      {"--force 0,0", "--force"},
      {"--spacing -3", "--spacing"},
      {"--force 0,0,-1 --offsets '" + bad + "'", "dz_mm: expected this column"},
      {"--offsets '" + bad + "'", "--force"}};
  for (const auto& [words, said] : refused) {
    const Ran ran = runProgram("stiffness " + kSample + " --springs-only " + words, scratch.path());
    EXPECT_EQ(ran.status, 2) << words;
    EXPECT_NE(ran.err.find(said), std::string::npos) << words << ": " << ran.err;
  }
  EXPECT_EQ(runProgram("stiffness '" STIFFSCOPE_SOURCE_DIR "/samples/unloaded'", scratch.path()).status, 2);
}

}  // namespace stiffness_command_test
}  // namespace stiffscope
