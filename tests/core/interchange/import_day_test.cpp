#include "core/interchange/import_day.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/core/interchange/refusal.h"
#include "tests/fixtures/written_day.h"

namespace stiffscope {
namespace import_day_test {

namespace fs = std::filesystem;
using namespace interchange;
using interchange_test::expectSays;

// The writers of the files are the tests' own (written_day.h); the day is the simulator's.
const fs::path kSample = STIFFSCOPE_SOURCE_DIR "/samples/unloaded";
constexpr int kPoses = 12;

class ImportDay : public ::testing::Test {
 protected:
  ImportDay() : day_(kSample) {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(STIFFSCOPE_TEST_OUTPUT) / "import_day" / test->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    fs::copy_file(kSample / "robot.urdf", folder_ / "robot.urdf");
    day_.keepPoses(kPoses);
  }
  ~ImportDay() override { fs::remove_all(folder_); }

  void writeFiles() const {
    day_.writeSpatialAnalyzer(folder_ / "tracker.txt");
    day_.writeKarel(folder_ / "karel.csv");
  }

  /// Readings of so many postures, and a log that has two more.
  void writeWithLongerLog(int postures) {
    day_.keepPoses(postures);
    day_.writeSpatialAnalyzer(folder_ / "tracker.txt");
    WrittenDay longer(kSample);
    longer.keepPoses(postures + 2);
    longer.writeKarel(folder_ / "karel.csv");
  }

  static std::string dayXml(const std::string& elements) {
    return "<day format=\"1\" name=\"Cell\" date=\"2031-03-04\">\n"
           "<robot urdf=\"robot.urdf\" base_link=\"base_link\" flange_link=\"tool0\"/>\n"
           "<tracker model=\"t\" range_fixed_um=\"4\" range_per_m_um=\"0.6\" angle_fixed_um=\"6\" "
           "angle_per_m_um=\"2.4\"/>\n"
           "<targets><target id=\"P10\"/><target id=\"P11\"/><target id=\"P12\"/></targets>\n" +
           elements + "\n</day>\n";
  }

  ImportedDay imported(const std::string& elements) const {
    std::ofstream(folder_ / "DAY.xml") << dayXml(elements);
    return importDay(folder_ / "DAY.xml");
  }

  std::string refusal(const std::string& elements) const {
    return interchange_test::refusalOf([&] { imported(elements); });
  }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }

  std::string lineOf(const std::string& name, std::size_t line) const {
    std::ifstream lines(folder_ / name);
    std::string text;
    for (std::size_t i = 0; i < line; ++i) std::getline(lines, text);
    return text;
  }

  WrittenDay day_;
  fs::path folder_;
};

const std::string kCoupled = "<joint_reading joint=\"3\" plus=\"2\"/>";
const std::string kTracker =
    "<points role=\"loading\" file=\"tracker.txt\"/><points role=\"nests\" file=\"tracker.txt\"/>";
const std::string kByClock = kCoupled + kTracker + "<log file=\"karel.csv\"/><join by=\"clock\"/>";

TEST_F(ImportDay, TheOffsetOfTheClocksLiesWithinItsUncertainty) {
  // Days of other lengths of stay, by clocks that are apart by anything up to an hour.
  for (unsigned seed = 1; seed <= 8; ++seed) {
    std::mt19937 draw(seed);
    std::uniform_real_distribution<double> hour(-3600.0, 3600.0), settle(0.6, 3.0), stay(0.4, 2.5);
    day_.clock_ahead_s = seed == 1 ? 3.9 : std::round(1000.0 * hour(draw)) / 1000.0;
    day_.settle_s = settle(draw);
    day_.stay_s = stay(draw);
    writeFiles();
    const ImportedDay made = imported(kByClock);
    ASSERT_EQ(made.clocks.size(), 1u);
    EXPECT_LE(std::abs(made.clocks[0].offset_s - day_.clock_ahead_s - day_.firstSecond()), made.clocks[0].uncertainty_s)
        << seed;
    EXPECT_EQ(made.campaign.loading->rows.size(), day_.loading.size()) << seed;
  }
}

TEST_F(ImportDay, ByTheClockEveryReadingFindsItsJoints) {
  writeFiles();
  const ImportedDay made = imported(kByClock);
  ASSERT_TRUE(made.campaign.loading && made.campaign.states && made.campaign.nests);
  ASSERT_EQ(made.campaign.loading->rows.size(), day_.loading.size());
  ASSERT_EQ(made.campaign.states->rows.size(), static_cast<std::size_t>(kPoses));
  EXPECT_EQ(made.campaign.nests->rows.size(), day_.nests.size());
  for (std::size_t i = 0; i < day_.states.size(); ++i) {
    for (int j = 0; j < 6; ++j)  // five decimals of a degree were written
      EXPECT_NEAR(made.campaign.states->rows[i].q[j] * 180.0 / std::acos(-1.0),
                  day_.states.number(i, "q" + std::to_string(j + 1) + "_deg"), 1e-9);
  }
  for (std::size_t i = 0; i < day_.loading.size(); ++i) {
    const campaign::LoadingReading& row = made.campaign.loading->rows[i];
    EXPECT_EQ(made.campaign.pose_ids[static_cast<std::size_t>(row.pose)], day_.loading.at(i, "pose"));
    EXPECT_EQ(made.campaign.targets[static_cast<std::size_t>(row.target)].id, day_.loading.at(i, "target"));
    EXPECT_EQ(std::to_string(row.repeat), day_.loading.at(i, "repeat"));
    EXPECT_NEAR(row.point.x() * 1e3, day_.loading.number(i, "x_mm"), 1e-9);
    EXPECT_NEAR(row.point.z() * 1e3, day_.loading.number(i, "z_mm"), 1e-9);
  }
}

TEST_F(ImportDay, TheClocksOffsetLiesWithinItsUncertainty) {
  for (const double ahead : {3.9, -1234.5, 86400.25}) {
    day_.clock_ahead_s = ahead;
    writeFiles();
    const ImportedDay made = imported(kByClock);
    ASSERT_EQ(made.clocks.size(), 1u);
    // time_s counts from the first reading of all, a nest's.
    const double first = day_.nests.number(0, "time_s");
    EXPECT_EQ(made.start, "2031-03-04T08:00:02");
    EXPECT_LE(std::abs(made.clocks[0].offset_s - ahead - first), made.clocks[0].uncertainty_s);
    EXPECT_GT(made.clocks[0].uncertainty_s, 0.0);
    EXPECT_LT(made.clocks[0].uncertainty_s, 2.0);
    EXPECT_EQ(made.clocks[0].inside, day_.loading.size());
    ASSERT_TRUE(made.clocks[0].misfit);
    EXPECT_LT(*made.clocks[0].misfit, 0.005);  // the arm differs from its URDF, and bends, by some millimetres
  }
}

TEST_F(ImportDay, EveryRowSaysItsLine) {
  writeFiles();
  const ImportedDay made = imported(kByClock);
  ASSERT_EQ(made.rows.at("loading").size(), made.campaign.loading->rows.size());
  for (const std::size_t i : {std::size_t{0}, std::size_t{17}, day_.loading.size() - 1}) {
    const RowOrigin& origin = made.rows.at("loading")[i];
    EXPECT_EQ(made.files[origin.file].name, "tracker.txt");
    const std::string line = lineOf("tracker.txt", origin.line);
    expectSays(line, {day_.loading.at(i, "target"), day_.loading.at(i, "x_mm")});
  }
  for (std::size_t i = 0; i < day_.states.size(); ++i) {
    const RowOrigin& origin = made.rows.at("states")[i];
    EXPECT_EQ(made.files[origin.file].name, "karel.csv");
    EXPECT_GT(origin.last_line, origin.line + 125);  // a second and more
    for (const std::size_t line : {origin.line, origin.last_line})
      expectSays(lineOf("karel.csv", line), {';' + day_.states.at(i, "q1_deg") + ';'});
  }
  EXPECT_TRUE(made.skipped.empty());  // nests and reflectors share a file, each row in one table
}

TEST_F(ImportDay, ReadingsInMotionAndOutsideTheLogAreLeftOut) {
  writeFiles();
  const double leave = day_.stands()[4].to_s, first = day_.stands().front().from_s;
  std::ofstream(folder_ / "tracker.txt", std::ios::app)
      << "Day,  Main,  P10,  1000.000000,  2000.000000,  500.000000,  " << WrittenDay::dateAndTime(leave + 6.0)
      << "\nDay,  Main,  P10,  1000.000000,  2000.000000,  500.000000,  " << WrittenDay::dateAndTime(first - 12.0)
      << "\nDay,  Main,  X9,  1000.000000,  2000.000000,  500.000000,  " << WrittenDay::dateAndTime(leave) << '\n';
  const ImportedDay made = imported(
      kCoupled + "<points role=\"loading\" file=\"tracker.txt\"/><log file=\"karel.csv\"/><join by=\"clock\"/>");
  std::map<Skip, int> counts;
  for (const SkippedOrigin& row : made.skipped) ++counts[row.row.reason];
  EXPECT_EQ(counts[Skip::in_motion], 1);
  EXPECT_EQ(counts[Skip::outside_log], 1);
  EXPECT_EQ(counts[Skip::another_point], static_cast<int>(day_.nests.size()) + 1);
  EXPECT_EQ(made.campaign.loading->rows.size(), day_.loading.size());
}

TEST_F(ImportDay, StandstillsWithoutReadingsAreListed) {
  writeFiles();
  day_.loading.keepRows(day_.loading.size() - 6);  // the last pose, three reflectors twice
  day_.writeSpatialAnalyzer(folder_ / "tracker.txt");
  const ImportedDay made = imported(kByClock);
  ASSERT_EQ(made.skipped.size(), 1u);
  EXPECT_EQ(made.skipped[0].row.reason, Skip::no_readings);
  EXPECT_EQ(made.files[made.skipped[0].file].name, "karel.csv");
  EXPECT_EQ(made.campaign.states->rows.size(), static_cast<std::size_t>(kPoses - 1));
}

TEST_F(ImportDay, AJointThatTheRobotHasNotIsRefused) {
  writeFiles();
  expectSays(refusal("<points role=\"circle_sweeps\" file=\"tracker.txt\" axis=\"7\"/>" + kByClock),
             {"DAY.xml:5", "axis", "'7'", "1 to 6"});
  expectSays(refusal("<joint_reading joint=\"7\" sign=\"-1\"/>" + kByClock), {"DAY.xml:5", "joint", "'7'", "1 to 6"});
}

TEST_F(ImportDay, ABalancerOfTheDayIsTheCampaigns) {
  writeFiles();
  const std::string balancer =
      "<balancer kind=\"spring\" from_link=\"link_1\" from_mm=\"-900 0 0\" to_link=\"link_2\" to_mm=\"-160 0 190\" "
      "rate_n_per_m=\"2e4\" tension_n=\"5e3\" length_mm=\"773\"/>";
  const auto balancers = imported(balancer + kByClock).campaign.robot.balancers;
  ASSERT_EQ(balancers.size(), 1u);
  EXPECT_EQ(balancers[0].to.body, 2);
  // Axis 2 of the sample's arm stands 0.41 m before axis 1 and 0.94 m up.
  EXPECT_LT((balancers[0].to.in_base_at_zero - Eigen::Vector3d(0.25, 0, 1.13)).norm(), 1e-12);
  std::string elsewhere = balancer;
  elsewhere.replace(elsewhere.find("link_2"), 6, "link_7");
  expectSays(refusal(elsewhere + kByClock), {"DAY.xml:5", "to_link", "'link_7'", "expected a link of the robot"});
}

TEST_F(ImportDay, AWrongSignCouplingOrUnitIsRefusedAndNamed) {
  writeFiles();
  const std::string rest = kTracker + "<log file=\"karel.csv\"/><join by=\"clock\"/>";
  expectSays(refusal(rest), {"DAY.xml:5", "joint=\"3\" plus=\"2\"", "off by"});
  expectSays(refusal(kCoupled + "<joint_reading joint=\"2\" sign=\"-1\"/>" + rest), {"joint=\"2\" sign=\"1\""});
  expectSays(refusal(kCoupled + "<joint_reading joint=\"4\" offset_deg=\"90\"/>" + rest),
             {"joint=\"4\" offset_deg=\"0\""});
  std::string text;
  std::ifstream lines(folder_ / "tracker.txt");
  for (std::string line; std::getline(lines, line);)
    text += (line.find("Millimeter") == std::string::npos ? line : "// X,  Y,  Z  (Zoll)\r") + '\n';
  write("tracker.txt", text);
  expectSays(refusal(kByClock), {"points times 0.0393701"});
}

TEST_F(ImportDay, AnOffsetThatIsStatedMustServe) {
  writeFiles();
  const std::string rest = kCoupled + kTracker + "<log file=\"karel.csv\"/>";
  const ImportedDay made = imported(rest + "<join by=\"clock\" offset_s=\"5.9\"/>");
  EXPECT_TRUE(made.clocks[0].stated);
  EXPECT_EQ(made.clocks[0].inside, day_.loading.size());
  expectSays(refusal(rest + "<join by=\"clock\" offset_s=\"15.9\"/>"), {"offset_s", "'15.9'", "expected an offset"});
}

TEST_F(ImportDay, AnOffsetThatGivesEachPostureTheJointsOfAnotherIsRefused) {
  // Postures follow each other evenly, and the log has two more: offsets a posture apart serve alike, but for
  // distances.
  writeWithLongerLog(8);
  const ImportedDay made = imported(kByClock);
  const double right = made.clocks[0].offset_s,
               apart = day_.states.number(1, "time_s") - day_.states.number(0, "time_s");
  const std::string shown = fmt::format("{:.3f} +- {:.3f} s", right, made.clocks[0].uncertainty_s);
  EXPECT_NEAR(right, day_.clock_ahead_s + day_.firstSecond(), made.clocks[0].uncertainty_s);
  const auto stated = [&](double offset) {
    return kCoupled + kTracker +
           fmt::format("<log file=\"karel.csv\"/><join by=\"clock\" offset_s=\"{:.3f}\"/>", offset);
  };
  expectSays(refusal(stated(right + apart)), {"DAY.xml:5: offset_s", "expected the offset", "off by", "with " + shown});
  // One that serves nothing gets the right one named, and no other.
  const std::string said = refusal(stated(right + 0.5 * apart));
  expectSays(said, {"DAY.xml:5: offset_s", "expected an offset that puts", ", " + shown, "off by"});
  EXPECT_EQ(said.find(" +- "), said.rfind(" +- ")) << said;
  EXPECT_EQ(imported(stated(right)).campaign.states->rows.size(), 8u);
}

TEST_F(ImportDay, ARhythmThatTwoOffsetsServeIsRefusedWithoutDistances) {
  // Four postures are too few for distances, and they follow each other evenly.
  writeWithLongerLog(4);
  expectSays(refusal(kByClock), {"expected one offset", "offset_s"});
  // Whoever states one that serves nothing hears of all that do.
  expectSays(refusal(kCoupled + kTracker + "<log file=\"karel.csv\"/><join by=\"clock\" offset_s=\"15.9\"/>"),
             {"offset_s", "'15.9'", ", or ", "do not tell apart"});
}

TEST_F(ImportDay, ByNameAndByOrderFromTaughtTargets) {
  std::string program = "/PROG  DAY\n/POS\n";
  std::string points = "// X, Y, Z (mm)\n";
  for (std::size_t i = 0; i < day_.states.size(); ++i) {
    program += fmt::format("P[{}]{{\n   GP1:\n\tUF : 0, UT : 1,\n", i + 1);
    for (int j = 1; j <= 6; ++j)
      program += fmt::format("\tJ{}= {} deg,\n", j, day_.states.at(i, fmt::format("q{}_deg", j)));
    program += "};\n";
  }
  for (std::size_t i = 0; i < day_.loading.size(); ++i) {
    if (day_.loading.at(i, "repeat") != "1") continue;
    points +=
        fmt::format("Main,  {}_{},  {}00,  {}00,  {}00\n", day_.loading.at(i, "target"), day_.loading.at(i, "pose"),
                    day_.loading.at(i, "x_mm"), day_.loading.at(i, "y_mm"), day_.loading.at(i, "z_mm"));
  }
  write("day.ls", program + "/END\n");
  write("tracker.txt", points);
  const ImportedDay named = imported(
      "<points role=\"loading\" file=\"tracker.txt\" names=\"{target}_{pose}\"/><log file=\"day.ls\" "
      "names=\"P[{pose}]\"/><join by=\"name\"/>");
  ASSERT_EQ(named.campaign.states->rows.size(), static_cast<std::size_t>(kPoses));
  EXPECT_NEAR(named.campaign.states->rows[7].q[0] * 180 / std::acos(-1.0), day_.states.number(7, "q1_deg"), 1e-9);
  EXPECT_TRUE(named.clocks.empty());
  const ImportedDay ordered = imported(
      "<points role=\"loading\" file=\"tracker.txt\" names=\"{target}_{pose}\"/><log file=\"day.ls\"/><join "
      "by=\"order\"/>");
  for (std::size_t i = 0; i < named.campaign.states->rows.size(); ++i)
    EXPECT_EQ(ordered.campaign.states->rows[i].q, named.campaign.states->rows[i].q);
  write("tracker.txt", points + "Main,  P10_99,  1.000000,  2.000000,  3.000000\n");
  expectSays(refusal("<points role=\"loading\" file=\"tracker.txt\" names=\"{target}_{pose}\"/><log file=\"day.ls\" "
                     "names=\"P[{pose}]\"/><join by=\"name\"/>"),
             {"tracker.txt:38", "pose", "'99'", "day.ls"});
  expectSays(refusal("<points role=\"loading\" file=\"tracker.txt\" names=\"{target}_{pose}\"/><log file=\"day.ls\"/>"
                     "<join by=\"order\"/>"),
             {"day.ls", "order", "13", "12 rows"});
}

TEST_F(ImportDay, ByOrderALostReadingMovesNoOther) {
  std::string points = "target;x_mm;y_mm;z_mm\n", joints = "q1_deg;q2_deg;q3_deg;q4_deg;q5_deg;q6_deg\n";
  for (std::size_t i = 0; i < day_.loading.size(); ++i) {
    if (day_.loading.at(i, "repeat") != "1") continue;
    const bool lost = day_.loading.at(i, "target") == "P11" && day_.loading.at(i, "pose") == "3";
    points += day_.loading.at(i, "target") + ';';
    points += lost ? "0;0;0\n"
                   : fmt::format("{};{};{}\n", day_.loading.at(i, "x_mm"), day_.loading.at(i, "y_mm"),
                                 day_.loading.at(i, "z_mm"));
  }
  for (std::size_t i = 0; i < day_.states.size(); ++i) {
    for (int j = 1; j <= 6; ++j) joints += day_.states.at(i, fmt::format("q{}_deg", j)) + (j < 6 ? ";" : "\n");
  }
  write("points.csv", points);
  write("joints.csv", joints);
  const std::string elements =
      "<points role=\"loading\" file=\"points.csv\"/><log file=\"joints.csv\"/><join by=\"order\"/>";
  const ImportedDay made = imported(elements);
  EXPECT_EQ(made.campaign.loading->rows.size(), 3u * kPoses - 1);
  ASSERT_EQ(made.skipped.size(), 1u);
  EXPECT_EQ(made.skipped[0].row.reason, Skip::lost_beam);
  for (const campaign::LoadingReading& row : made.campaign.loading->rows)
    EXPECT_FALSE(row.target == 1 && made.campaign.pose_ids[static_cast<std::size_t>(row.pose)] == "3");
  EXPECT_LT(made.misfit.at("loading"), 0.005);
  // Without the row it cannot be known which pose lacks it.
  points.erase(points.find("P11;0;0;0\n"), 10);
  write("points.csv", points);
  expectSays(refusal(elements), {"points.csv", "'P11'", "11 times", "P12 12 times"});
}

TEST_F(ImportDay, LoadsByPoseAndStepWithTheirLines) {
  writeFiles();
  day_.writeLoads(folder_ / "loads.csv");
  const std::string cell =
      "<load_cell parent=\"tool0\" xyz_mm=\"0 0 110\" rpy_deg=\"0 0 0\" force_sigma_n=\"1\" moment_sigma_nm=\"0.3\"/>";
  const ImportedDay made = imported(cell + kByClock + "<loads file=\"loads.csv\"/>");
  ASSERT_EQ(made.wrenches.size(), made.campaign.states->rows.size());
  EXPECT_EQ(made.wrenches[3].line, 5u);
  EXPECT_EQ(made.files[made.wrenches[3].file].role, "loads");
  day_.states.keepRows(kPoses - 1);
  day_.writeLoads(folder_ / "loads.csv");
  expectSays(refusal(cell + kByClock + "<loads file=\"loads.csv\"/>"), {"loads.csv", "pose", "12, 0"});
  std::ofstream(folder_ / "loads.csv", std::ios::app) << "1;0;1;2;3;4;5;6\n";
  expectSays(refusal(cell + kByClock + "<loads file=\"loads.csv\"/>"), {"loads.csv:13", "line 2 has it first"});
}

TEST_F(ImportDay, StatedUncertaintiesAreHeldAgainstTheDeclaredNoise) {
  std::string points = "target;pose;x_mm;y_mm;z_mm;ux_um;uy_um;uz_um\n";
  std::string joints = "pose;q1_deg;q2_deg;q3_deg;q4_deg;q5_deg;q6_deg\n";
  for (std::size_t i = 0; i < day_.loading.size(); ++i) {
    if (day_.loading.at(i, "repeat") != "1") continue;
    points += fmt::format("{};{};{};{};{};60;60;60\n", day_.loading.at(i, "target"), day_.loading.at(i, "pose"),
                          day_.loading.at(i, "x_mm"), day_.loading.at(i, "y_mm"), day_.loading.at(i, "z_mm"));
  }
  for (std::size_t i = 0; i < day_.states.size(); ++i) {
    joints += day_.states.at(i, "pose");
    for (int j = 1; j <= 6; ++j) joints += ';' + day_.states.at(i, fmt::format("q{}_deg", j));
    joints += '\n';
  }
  write("points.csv", points);
  write("joints.csv", joints);
  const ImportedDay made =
      imported("<points role=\"loading\" file=\"points.csv\"/><log file=\"joints.csv\"/><join by=\"name\"/>");
  ASSERT_TRUE(made.stated_sigma && made.stated_over_declared);
  EXPECT_NEAR(*made.stated_sigma, 60e-6, 1e-12);
  // At 2 to 6 m 4 + 0.6 d um along and 6 + 2.4 d um across are 9 to 17 um rms.
  EXPECT_GT(*made.stated_over_declared, 60.0 / 17.0);
  EXPECT_LT(*made.stated_over_declared, 60.0 / 9.0);
  ASSERT_EQ(made.warnings.size(), 1u);
  expectSays(made.warnings[0], {"DAY.xml", "tracker", "60.0 um", "declared"});
}

TEST_F(ImportDay, SweepsInOneTableWithTheirJoints) {
  const fs::path active = STIFFSCOPE_SOURCE_DIR "/samples/active";
  for (const char* name : {"circle_sweeps.csv", "wrist_sweep.csv"}) fs::copy_file(active / name, folder_ / name);
  const ImportedDay made = imported(
      "<points role=\"circle_sweeps\" file=\"circle_sweeps.csv\"/><log role=\"circle_sweeps\" "
      "file=\"circle_sweeps.csv\"/><points role=\"wrist_sweep\" file=\"wrist_sweep.csv\"/><log role=\"wrist_sweep\" "
      "file=\"wrist_sweep.csv\"/><join by=\"name\"/>");
  const PlainTable circles(active / "circle_sweeps.csv");
  ASSERT_EQ(made.campaign.circle_sweeps->rows.size(), circles.size());
  EXPECT_EQ(made.campaign.wrist_sweep->rows.size(), PlainTable(active / "wrist_sweep.csv").size());
  for (std::size_t i = 0; i < circles.size(); i += 37) {
    const RowOrigin& origin = made.rows.at("circle_sweeps")[i];
    const campaign::CircleReading& row = made.campaign.circle_sweeps->rows[i];
    EXPECT_EQ(row.axis + 1, std::stoi(circles.at(origin.line - 2, "axis")));
    EXPECT_EQ(row.index, circles.at(origin.line - 2, "index"));
    EXPECT_NEAR(row.q[1] * 180 / std::acos(-1.0), circles.number(origin.line - 2, "q2_deg"), 1e-9);
  }
}

TEST_F(ImportDay, RefusesWithFileAndLine) {
  expectSays(refusal(kByClock), {"DAY.xml:5", "tracker.txt", "there is none"});
  writeFiles();
  expectSays(refusal(kCoupled + kTracker + "<join by=\"clock\"/>"), {"DAY.xml:5", "log", "loading"});
  expectSays(refusal(kCoupled + "<points role=\"loading\" file=\"tracker.txt\" names=\"Q{target}\"/><log "
                                "file=\"karel.csv\"/><join by=\"clock\"/>"),
             {"names", "none of its", "'N1'"});
  write("other.txt", "// 'Other::Frame'\n// X, Y, Z (mm)\nN1,  1.000000,  2.000000,  3.000000,  03/04/31 08:00:00\n");
  expectSays(refusal(kByClock + "<points role=\"nests\" file=\"other.txt\"/>"),
             {"one frame", "Other::Frame", "Day::Station"});
  write("seconds.csv", "nest,x_mm,y_mm,z_mm,time_s\nN1,1,2,3,4\n");
  expectSays(refusal(kByClock + "<points role=\"nests\" file=\"seconds.csv\"/>"), {"dates, or seconds"});
  write("timeless.csv", "nest,x_mm,y_mm,z_mm\nN1,1,2,3\n");
  expectSays(refusal(kByClock + "<points role=\"nests\" file=\"timeless.csv\"/>"), {"timeless.csv:2", "time", "nest"});
  std::string torn;
  std::ifstream whole(folder_ / "karel.csv");
  for (std::string line; std::getline(whole, line) && torn.size() < 100'000;) torn += line + '\n';
  write("karel.csv", torn.substr(0, torn.size() - 40));
  expectSays(refusal(kByClock), {"karel.csv:", "ends in the middle"});
}

TEST_F(ImportDay, ALogAloneIsItsStandstills) {
  writeFiles();
  const ImportedDay made = imported(kCoupled + "<log file=\"karel.csv\"/>");
  EXPECT_FALSE(made.campaign.loading);
  ASSERT_TRUE(made.campaign.states);
  ASSERT_EQ(made.campaign.states->rows.size(), static_cast<std::size_t>(kPoses));
  for (std::size_t i = 0; i < made.campaign.states->rows.size(); ++i) {
    EXPECT_EQ(made.campaign.pose_ids[i], std::to_string(i + 1));
    for (int j = 0; j < 6; ++j)
      EXPECT_NEAR(made.campaign.states->rows[i].q[j] * 180.0 / std::numbers::pi,
                  day_.states.number(i, "q" + std::to_string(j + 1) + "_deg"), 1e-5);
  }
  EXPECT_EQ(made.rows.at("states").size(), made.campaign.states->rows.size());
  // Moving or not: pose and joints of one sample are one computation.
  const ImportedDay often = imported(kCoupled + "<log file=\"karel.csv\" every_s=\"2\"/>");
  const double seconds = often.campaign.states->rows.back().time_s - often.campaign.states->rows.front().time_s;
  EXPECT_EQ(often.campaign.states->rows.size(), static_cast<std::size_t>(seconds / 2.0 + 1.5));
  expectSays(refusal(kTracker + "<log file=\"karel.csv\" every_s=\"2\"/><join by=\"clock\"/>"),
             {"every_s", "beside points"});
  expectSays(refusal(""), {"points", "or log"});
}

TEST_F(ImportDay, PointsAloneArePostures) {
  writeFiles();
  const ImportedDay made = imported(kTracker);
  EXPECT_FALSE(made.campaign.states);
  ASSERT_TRUE(made.campaign.loading);
  EXPECT_EQ(made.campaign.loading->rows.size(), day_.loading.size());
  // A posture an occurrence of each of the three names: nothing says that two are one.
  EXPECT_EQ(made.campaign.pose_ids.size(), day_.loading.size() / 3);
  expectSays(refusal(kTracker + "<join by=\"clock\"/>"), {"log"});
  expectSays(refusal("<points role=\"wrist_sweep\" file=\"tracker.txt\"/>"), {"wrist_sweep", "log"});
}

}  // namespace import_day_test
}  // namespace stiffscope
