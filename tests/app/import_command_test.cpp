#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/app/command.h"
#include "tests/fixtures/written_day.h"

namespace stiffscope {
namespace import_command_test {

namespace fs = std::filesystem;

const fs::path kSamples = STIFFSCOPE_SOURCE_DIR "/samples";

const std::string kTracker =
    "<tracker model=\"absolute tracker\" range_fixed_um=\"4\" range_per_m_um=\"0.6\" angle_fixed_um=\"6\" "
    "angle_per_m_um=\"2.4\"/>";
const std::string kTargets = "<targets><target id=\"P10\"/><target id=\"P11\"/><target id=\"P12\"/></targets>";

/// Of the written day, whose second 0 is 08:00:00: where the campaign's times begin.
double startSecond(const nlohmann::json& import) {
  const std::string start = import["start"].get<std::string>();  // 2031-03-04T08:00:02
  return 3600.0 * std::stod(start.substr(11, 2)) + 60.0 * std::stod(start.substr(14, 2)) + std::stod(start.substr(17)) -
         8.0 * 3600.0;
}

class ImportCommand : public ::testing::Test {
 protected:
  Ran run(const std::string& words) const { return runProgram(words, scratch_.path()); }
  std::string quoted(const fs::path& path) const { return " '" + path.string() + "' "; }
  fs::path at(const std::string& name) const { return scratch_.path() / name; }

  void write(const std::string& name, const std::string& text) const {
    fs::create_directories(at(name).parent_path());
    std::ofstream(at(name), std::ios::binary) << text;
  }

  /// Runs `words`, which must be refused with all of `said` and leave nothing at `left`.
  void refused(const std::string& words, const std::vector<std::string>& said, const fs::path& left) const {
    const Ran ran = run(words);
    EXPECT_EQ(ran.status, 2) << words;
    for (const std::string& part : said) EXPECT_NE(ran.err.find(part), std::string::npos) << part << " in: " << ran.err;
    EXPECT_FALSE(fs::exists(left));
    for (const auto& entry : fs::directory_iterator(scratch_.path()))
      EXPECT_EQ(entry.path().filename().string().find(".part-"), std::string::npos) << entry.path();
  }

  /// What a command prints of the campaign in a folder, by the folder's own name left out.
  std::string printed(const std::string& command, const fs::path& campaign, const std::string& options = "") const {
    const Ran ran = run(command + quoted(campaign) + options);
    EXPECT_NE(ran.status, 2) << ran.err;
    std::string text = ran.out;
    for (std::size_t at = text.find(campaign.string()); at != std::string::npos; at = text.find(campaign.string()))
      text.erase(at, campaign.string().size());
    return text;
  }

  const ScratchFolder scratch_;
};

// ---------------------------------------------------------------------------------------------------------------------
// A simulated day, written by the tests' own writer as SpatialAnalyzer and a KAREL log would: what comes out of the
// import gives the day's own results.

TEST_F(ImportCommand, AnUnloadedDayGivesItsOwnCalibration) {
  WrittenDay day(kSamples / "unloaded");
  fs::create_directories(at("lab"));
  fs::copy_file(kSamples / "unloaded/robot.urdf", at("lab/robot.urdf"));
  day.writeSpatialAnalyzer(at("lab/tracker.txt"));
  day.writeKarel(at("lab/karel.csv"));
  write("lab/DAY.xml",
        "<day format=\"1\" name=\"Day\" date=\"2031-03-04\"><robot urdf=\"robot.urdf\" base_link=\"base_link\" "
        "flange_link=\"tool0\"/>" +
            kTracker + kTargets +
            "<joint_reading joint=\"3\" plus=\"2\"/><points role=\"loading\" file=\"tracker.txt\"/><points "
            "role=\"nests\" "
            "file=\"tracker.txt\"/><log file=\"karel.csv\"/><join by=\"clock\"/></day>");
  const Ran ran = run("import campaign" + quoted(at("lab/DAY.xml")) + "--out" + quoted(at("imported")) + "--json -");
  ASSERT_EQ(ran.status, 0) << ran.err;
  const auto json = nlohmann::json::parse(ran.out);
  EXPECT_EQ(json, nlohmann::json::parse(contentsOf(at("imported/import.json"))));
  ASSERT_EQ(json["clocks"].size(), 1u);
  EXPECT_NEAR(json["clocks"][0]["offset_s"].get<double>(), day.clock_ahead_s + startSecond(json),
              json["clocks"][0]["uncertainty_s"].get<double>());

  // The day itself, without what neither tracker nor robot writes: temperatures, wrenches of nothing, and the times of
  // the rows of states.
  day.timeStatesByReadings();
  for (const char* column : {"fx_n", "fy_n", "fz_n", "mx_nm", "my_nm", "mz_nm", "temperature_c"})
    day.states.remove(column);
  fs::copy(kSamples / "unloaded", at("own"));
  day.states.write(at("own/states.csv"));
  std::string xml = contentsOf(at("own/campaign.xml"));
  const std::size_t name = xml.find("name=\"");
  xml.replace(name, xml.find('"', name + 6) - name, "name=\"Day");
  write("own/campaign.xml", xml);
  for (const std::string command : {"calibrate", "diagnose", "audit"})
    EXPECT_EQ(printed(command, at("imported")), printed(command, at("own"))) << command;
}

TEST_F(ImportCommand, ALoadedDayGivesItsOwnStiffness) {
  // Sweeps from tables with their joints, the loading by the clock: all steps of a pose within one standstill.
  WrittenDay day(kSamples / "active");
  day.steps_as_groups = true;
  fs::create_directories(at("lab"));
  for (const char* name : {"robot.urdf", "circle_sweeps.csv", "wrist_sweep.csv"})
    fs::copy_file(kSamples / "active" / name, at("lab") / name);
  for (const char* name : {"circle_sweeps.csv", "wrist_sweep.csv"}) {
    // By SpatialAnalyzer's clock, as all of the tracker's times, and joint 3 against the horizontal, as in the log.
    PlainTable table(at("lab") / name);
    for (std::size_t i = 0; i < table.size(); ++i) {
      table.at(i, "time_s") = WrittenDay::dateAndTime(table.number(i, "time_s"));
      table.at(i, "q3_deg") = fmt::format("{:.5f}", table.number(i, "q3_deg") - table.number(i, "q2_deg"));
    }
    table.write(at("lab") / name);
    std::string text = contentsOf(at("lab") / name);
    text.replace(text.find("time_s"), 6, "time");
    std::ofstream(at("lab") / name) << text;
  }
  day.writeSpatialAnalyzer(at("lab/tracker.txt"));
  day.writeKarel(at("lab/karel.csv"));
  day.writeLoads(at("lab/loads.csv"));
  write("lab/DAY.xml",
        "<day format=\"1\" name=\"Day\" date=\"2031-03-04\"><robot urdf=\"robot.urdf\" base_link=\"base_link\" "
        "flange_link=\"tool0\" double_encoder=\"active\"/>" +
            kTracker + kTargets +
            "<load_cell parent=\"tool0\" xyz_mm=\"0 0 110\" rpy_deg=\"0 0 0\" force_sigma_n=\"1\" "
            "moment_sigma_nm=\"0.3\"/>"
            "<tool mass_kg=\"60\" com_mm=\"0 0 90\"/><joint_reading joint=\"3\" plus=\"2\"/>"
            "<points role=\"circle_sweeps\" file=\"circle_sweeps.csv\" by=\"name\"/>"
            "<log role=\"circle_sweeps\" file=\"circle_sweeps.csv\"/>"
            "<points role=\"wrist_sweep\" file=\"wrist_sweep.csv\" by=\"name\"/>"
            "<log role=\"wrist_sweep\" file=\"wrist_sweep.csv\"/>"
            "<points role=\"loading\" file=\"tracker.txt\" names=\"step{step}::{target}\"/>"
            "<points role=\"nests\" file=\"tracker.txt\" names=\"Floor::{nest}\"/>"
            "<log role=\"loading\" file=\"karel.csv\"/><loads file=\"loads.csv\"/><join by=\"clock\"/></day>");
  const Ran ran = run("import campaign" + quoted(at("lab/DAY.xml")) + "--out" + quoted(at("imported")));
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(ran.out.find("855 of 855 readings fall into its 19 standstills"), std::string::npos) << ran.out;
  const auto json = nlohmann::json::parse(contentsOf(at("imported/import.json")));
  const auto& clock = json["clocks"][0];
  EXPECT_NEAR(clock["offset_s"].get<double>(), day.clock_ahead_s + startSecond(json),
              clock["uncertainty_s"].get<double>());

  day.timeStatesByReadings();
  fs::copy(kSamples / "active", at("own"));
  day.states.write(at("own/states.csv"));
  std::string xml = contentsOf(at("own/campaign.xml"));
  const std::size_t name = xml.find("name=\"");
  xml.replace(name, xml.find('"', name + 6) - name, "name=\"Day");
  write("own/campaign.xml", xml);
  for (const std::string command : {"audit", "identify", "diagnose"})
    EXPECT_EQ(printed(command, at("imported")), printed(command, at("own"))) << command;
}

TEST_F(ImportCommand, ALoadedDayWithoutAWrenchSaysThatItLacksIt) {
  fs::copy(kSamples / "active", at("day"));
  PlainTable states(at("day/states.csv"));
  for (const char* column : {"fx_n", "fy_n", "fz_n", "mx_nm", "my_nm", "mz_nm"}) states.remove(column);
  states.write(at("day/states.csv"));
  const std::string lacking = "no wrench in 'states' (fx_n to mz_nm)";
  const Ran identified = run("identify" + quoted(at("day")));
  EXPECT_EQ(identified.status, 1);
  EXPECT_NE(identified.err.find(lacking), std::string::npos) << identified.err;
  EXPECT_EQ(identified.err.find("displacements"), std::string::npos) << identified.err;
  EXPECT_NE(run("audit" + quoted(at("day"))).out.find(lacking), std::string::npos);
}

// ---------------------------------------------------------------------------------------------------------------------
// Points.

const std::string kSa =
    "// SpatialAnalyzer SA 2031.1\n// Points relative to 'Cell::BASE'\n// X,  Y,  Z (mm),  U-x,  U-y,  U-z,  U-mag\n"
    "// 95.0 %\n"
    "Run,  Main,  P10,  1500.123456,  -20.500000,  300.250000,  0.020000,  0.030000,  0.060000,  0.070000,  03/04/31 "
    "09:08:07\n"
    "Run,  Main,  P10,  1500.223456,  -20.600000,  300.350000,  0.020000,  0.030000,  0.060000,  0.070000,  03/04/31 "
    "09:08:09\n";

TEST_F(ImportCommand, PointsAsTextAndAsJson) {
  write("a.txt", kSa);
  const Ran text = run("import points" + quoted(at("a.txt")));
  ASSERT_EQ(text.status, 0) << text.err;
  for (const char* part : {"format sa, encoding utf-8, frame Cell::BASE",
                           "2 points, 2 with uncertainties, 2 with a time", "1500.1235", "2031-03-04T09:08:09"})
    EXPECT_NE(text.out.find(part), std::string::npos) << part << " in: " << text.out;
  const Ran ran = run("import points" + quoted(at("a.txt")) + "--json -");
  const auto json = nlohmann::json::parse(ran.out);
  EXPECT_EQ(json["format"], "sa");
  EXPECT_EQ(json["frame"], "Cell::BASE");
  ASSERT_EQ(json["points"].size(), 2u);
  const auto& point = json["points"][1];
  EXPECT_EQ(point["collection"], "Run");
  EXPECT_EQ(point["group"], "Main");
  EXPECT_EQ(point["name"], "P10");
  EXPECT_EQ(point["occurrence"], 2);
  EXPECT_NEAR(point["xyz_m"][0].get<double>(), 1.500223456, 1e-15);
  EXPECT_NEAR(point["u_m"][2].get<double>(), 30e-6, 1e-15);
  EXPECT_EQ(point["time"], "2031-03-04T09:08:09");
  EXPECT_EQ(point["line"], 6);
  EXPECT_TRUE(json["skipped"].empty());
}

TEST_F(ImportCommand, PointsOfSeveralFilesAndByColumns) {
  write("P10.csv", "a;b\n1,5;2;3\n0;0;0\n");
  write("P11.csv", "a;b\n4,5;5;6\n");
  const Ran ran = run("import points" + quoted(at("P10.csv")) + quoted(at("P11.csv")) +
                      "--columns 'x_mm y_mm z_mm' --separator ';' --decimal-comma --skip 1 --target P10 --json -");
  ASSERT_EQ(ran.status, 0) << ran.err;
  const auto json = nlohmann::json::parse(ran.out);
  ASSERT_EQ(json["files"].size(), 2u);
  EXPECT_NEAR(json["files"][0]["points"][0]["xyz_m"][0].get<double>(), 1.5e-3, 1e-18);
  EXPECT_EQ(json["files"][0]["skipped"][0]["line"], 3);
  EXPECT_TRUE(json["files"][1]["points"][0]["time"].is_null());
}

TEST_F(ImportCommand, WrongChoicesAreRefusedWithWhatWasSeen) {
  write("a.txt", kSa);
  const std::string file = "import points" + quoted(at("a.txt"));
  const fs::path none = at("none");
  refused(file + "--format leica", {"a.txt", "format", "'leica'", "expected sa", "// SpatialAnalyzer"}, none);
  refused(file + "--format spatial", {"--format", "'spatial'", "expected sa"}, none);
  refused(file + "--encoding utf-16le", {"encoding", "'utf-16le'", "expected utf-8"}, none);
  refused(file + "--encoding latin1", {"--encoding", "'latin1'"}, none);
  refused(file + "--decimal-comma", {"a.txt"}, none);
  refused(file + "--unit in", {"unit", "'in'"}, none);
  refused("import points" + quoted(at("missing.txt")), {"missing.txt"}, none);
  refused("import points" + quoted(scratch_.path()), {"directory"}, none);
  refused("import points" + quoted(at("a.txt")) + "--json" + quoted(at("a.txt")), {"it is an input of this run"}, none);
  EXPECT_EQ(contentsOf(at("a.txt")), kSa);
}

TEST_F(ImportCommand, TruncatedMixedAndHostileFilesAreRefusedWithTheirLine) {
  const std::string file = "import points" + quoted(at("a.txt"));
  const fs::path none = at("none");
  for (std::size_t cut = kSa.size() - 2; cut > kSa.rfind('\n', kSa.size() - 2) + 24; cut -= 7) {
    write("a.txt", kSa.substr(0, cut));
    const Ran ran = run(file);
    // Refused with the line, or said: a last digit that may lack others.
    EXPECT_TRUE(ran.status == 2 || ran.err.find("cut short") != std::string::npos) << cut;
    EXPECT_NE(ran.err.find("a.txt:6"), std::string::npos) << ran.err;
  }
  write("a.txt",
        kSa + "Z\xC3\xA4hler,  Main,  P10,  1.000000,  2.000000,  3.000000\n\xE4,  M,  P,  1.000000,  2.0,  3\n");
  refused(file, {"a.txt:8", "0xE4", "line 7", "two files"}, none);
  write("a.txt", kSa + std::string(1, '\0'));
  refused(file, {"a.txt:7", "byte 0"}, none);
  write("a.txt", "// 'A::B'\n// X, Y, Z (mm)\nG,  \x1b[31mred,  1.000000,  2.000000,  3.000000\n");
  refused(file, {"a.txt:3", "name", "control"}, none);
  write("a.txt", "// X, Y, Z (mm)\nG,  " + std::string(300, 'a') + ",  1.000000,  2.000000,  3.000000\n");
  refused(file, {"a.txt:2", "200 bytes"}, none);
  write("a.txt", "");
  refused(file, {"a.txt"}, none);
  // A name that a page would run is text.
  write("a.txt", "// X, Y, Z (mm)\nG,  <script>\"';,  1.000000,  2.000000,  3.000000\n");
  const Ran ran = run(file + "--json -");
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_EQ(nlohmann::json::parse(ran.out)["points"][0]["name"], "<script>\"';");
}

// ---------------------------------------------------------------------------------------------------------------------
// Folders.

class ImportFolders : public ImportCommand {
 protected:
  ImportFolders() {
    day_.keepPoses(8);
    fs::create_directories(at("lab"));
    fs::copy_file(kSamples / "unloaded/robot.urdf", at("lab/robot.urdf"));
    day_.writeSpatialAnalyzer(at("lab/tracker.txt"));
    day_.writeKarel(at("lab/karel.csv"));
    write("lab/DAY.xml", xml_);
  }

  std::string import(const std::string& out) const {
    return "import campaign" + quoted(at("lab/DAY.xml")) + "--out" + quoted(at(out));
  }

  WrittenDay day_{kSamples / "unloaded"};
  const std::string xml_ =
      "<day format=\"1\" name=\"Day\" date=\"2031-03-04\">\n<robot urdf=\"robot.urdf\" base_link=\"base_link\" "
      "flange_link=\"tool0\"/>\n" +
      kTracker + kTargets +
      "\n<joint_reading joint=\"3\" plus=\"2\"/>\n<points role=\"loading\" file=\"tracker.txt\"/>\n<log "
      "file=\"karel.csv\"/>\n<join by=\"clock\"/>\n</day>\n";
};

TEST_F(ImportFolders, NothingIsWrittenOver) {
  EXPECT_EQ(run(import("out")).status, 0);
  const std::string before = contentsOf(at("out/loading.csv"));
  const Ran again = run(import("out"));
  EXPECT_EQ(again.status, 2);
  EXPECT_NE(again.err.find("it holds a campaign; expected another folder, or --replace"), std::string::npos)
      << again.err;
  EXPECT_EQ(run(import("out") + "--replace").status, 0);
  EXPECT_EQ(contentsOf(at("out/loading.csv")), before);  // the same bytes for the same files
  // The files themselves are not written over, whatever is asked for.
  const std::string urdf = contentsOf(at("lab/robot.urdf"));
  for (const char* option : {"", "--replace"}) {
    const Ran onto = run(import("lab") + option);
    EXPECT_EQ(onto.status, 2);
    EXPECT_NE(onto.err.find("it is an input of this run"), std::string::npos) << onto.err;
  }
  EXPECT_FALSE(fs::exists(at("lab/campaign.xml")));
  EXPECT_EQ(contentsOf(at("lab/robot.urdf")), urdf);
  // Nothing is left behind, either, that the next run would refuse to write over.
  refused(import("other") + "--json" + quoted(at("lab/karel.csv")), {"it is an input of this run"}, at("other"));
}

TEST_F(ImportFolders, ADayThatIsRefusedLeavesNothing) {
  const fs::path out = at("out");
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string xml = xml_;
    xml.replace(xml.find(from), from.size(), to);
    write("lab/DAY.xml", xml);
  };
  with("tracker.txt", "absent.txt");
  refused(import("out"), {"DAY.xml:5", "file", "'absent.txt'", "there is none"}, out);
  with("<joint_reading joint=\"3\" plus=\"2\"/>", "");
  refused(import("out"), {"DAY.xml:6", "joint_reading joint=\"3\" plus=\"2\""}, out);
  with("by=\"clock\"", "by=\"cloc\"");
  refused(import("out"), {"DAY.xml:7", "by", "'cloc'", "did you mean 'clock'"}, out);
  with("</day>", "");
  refused(import("out"), {"DAY.xml"}, out);
  write("lab/DAY.xml", xml_);
  const std::string log = contentsOf(at("lab/karel.csv"));
  write("lab/karel.csv", log.substr(0, log.size() - 30));
  refused(import("out"), {"karel.csv:", "ends in the middle"}, out);
  write("lab/karel.csv", log.substr(0, log.size() / 2) + "\xB5\n");
  refused(import("out"), {"karel.csv:"}, out);
  fs::remove(at("lab/DAY.xml"));
  refused(import("out"), {"DAY.xml"}, out);
}

TEST_F(ImportFolders, WhatIsImportedPassesOn) {
  ASSERT_EQ(run(import("out")).status, 0);
  const Ran audit = run("audit" + quoted(at("out")));
  EXPECT_NE(audit.status, 2) << audit.err;
  EXPECT_NE(contentsOf(at("out/campaign.xml")).find("<joint_reading joint=\"3\" sign=\"1\" plus=\"2\"/>"),
            std::string::npos);
  // The tables have the controller's figures again.
  const PlainTable states(at("out/states.csv"));
  EXPECT_NEAR(states.number(4, "q3_deg"), day_.states.number(4, "q3_deg") - day_.states.number(4, "q2_deg"), 2e-5);
}

TEST_F(ImportCommand, TemplatesAreWrittenOnceAndAreRead) {
  for (const std::string maker : {"fanuc", "kuka", "abb", "ur"}) {
    const std::string words = "import template --maker " + maker + quoted(at(maker));
    const Ran ran = run(words);
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_NE(ran.out.find("DAY.xml: written, to be filled in"), std::string::npos) << ran.out;
    const Ran again = run(words);
    EXPECT_EQ(again.status, 2);
    EXPECT_NE(again.err.find("not written: it is there already"), std::string::npos) << again.err;
    // It is a day; its files are to be put beside it.
    refused("import campaign" + quoted(at(maker) / "DAY.xml") + "--out" + quoted(at("out")),
            {"robot.urdf", "there is none of this name"}, at("out"));
  }
  // Of KUKA's arms some URDFs turn as the controller counts and others do not: nothing is stated before one has looked.
  const std::string kuka = contentsOf(at("kuka") / "DAY.xml");
  const std::size_t reading = kuka.find("<joint_reading"), comment = kuka.rfind("<!--", reading);
  ASSERT_NE(reading, std::string::npos);
  EXPECT_LT(reading, kuka.find("-->", comment));
  EXPECT_EQ(kuka.find("<joint_reading", kuka.find("-->", comment)), std::string::npos);
  refused("import template --maker fanux" + quoted(at("x")), {"--maker", "did you mean 'fanuc'"}, at("x"));
}

TEST_F(ImportCommand, InitMakesACampaignToFillIn) {
  const std::string words = "init" + quoted(kSamples / "m900ib700.urdf") + "--out" + quoted(at("new"));
  ASSERT_EQ(run(words).status, 0);
  EXPECT_EQ(contentsOf(at("new/robot.urdf")), contentsOf(kSamples / "m900ib700.urdf"));
  const Ran audit = run("audit" + quoted(at("new")));
  EXPECT_EQ(audit.status, 1) << audit.err;  // nothing is in it to be tested, and it is read
  EXPECT_NE(run(words).err.find("not written: it is there already"), std::string::npos);
  refused("init" + quoted(kSamples / "m900ib700.urdf") + "--out" + quoted(at("bad")) + "--flange-link nowhere",
          {"nowhere"}, at("bad"));
  // A URDF that stands there already stays; another of that name is not written over.
  fs::create_directories(at("here"));
  fs::copy_file(kSamples / "m900ib700.urdf", at("here/robot.urdf"));
  EXPECT_EQ(run("init" + quoted(at("here/robot.urdf")) + "--out" + quoted(at("here"))).status, 0);
  write("mine/robot.urdf", "mine");
  const Ran mine = run("init" + quoted(kSamples / "m900ib700.urdf") + "--out" + quoted(at("mine")));
  EXPECT_EQ(mine.status, 2);
  EXPECT_EQ(contentsOf(at("mine/robot.urdf")), "mine");
  EXPECT_FALSE(fs::exists(at("mine/campaign.xml")));
}

}  // namespace import_command_test
}  // namespace stiffscope
