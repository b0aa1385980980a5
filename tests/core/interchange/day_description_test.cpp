#include "core/interchange/day_description.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/interchange/day_template.h"
#include "tests/core/interchange/refusal.h"

namespace stiffscope {
namespace day_description_test {

using namespace interchange;
using interchange_test::expectSays;

/// A DAY.xml with these elements behind the robot and the targets.
std::string dayOf(const std::string& elements) {
  return "<day format=\"1\" name=\"Cell\" date=\"2031-03-04\">\n"
         "<robot urdf=\"robot.urdf\" base_link=\"base_link\" flange_link=\"tool0\"/>\n"
         "<targets><target id=\"P10\"/><target id=\"P11\"/></targets>\n" +
         elements + "\n</day>\n";
}

DayDescription parsed(const std::string& xml, std::vector<std::string>* said = nullptr) {
  std::vector<std::string> warnings;
  DayDescription day = parseDayDescription("lab/DAY.xml", xml, warnings);
  if (said != nullptr) *said = warnings;
  return day;
}

std::string refusal(const std::string& elements) {
  return interchange_test::refusalOf([&] { parsed(dayOf(elements)); });
}

const std::string kJoin = "<join by=\"clock\"/>", kPoints = "<points role=\"loading\" file=\"a.txt\"/>";

TEST(DayDescription, WhatIsNotSaidHasItsDefault) {
  std::vector<std::string> warnings;
  const DayDescription day = parsed(dayOf(kJoin + kPoints + "<log file=\"b.csv\"/>"), &warnings);
  EXPECT_TRUE(warnings.empty());
  EXPECT_EQ(day.folder, "lab");
  EXPECT_EQ(day.pathOf("a.txt"), "lab/a.txt");
  ASSERT_EQ(day.points.size(), 1u);
  const PointsSource& points = day.points[0];
  EXPECT_EQ(points.role, Role::loading);
  EXPECT_EQ(points.by, JoinBy::clock);
  EXPECT_EQ(points.line, 4u);
  EXPECT_TRUE(points.names.has("target"));
  EXPECT_EQ(points.axis, -1);
  EXPECT_FALSE(points.options.format || points.options.encoding || points.options.decimal_comma);
  EXPECT_FALSE(day.logs[0].role);
  EXPECT_TRUE(day.logs[0].names.has("pose"));
  EXPECT_NEAR(day.clock.standstill.band, 0.02 * std::numbers::pi / 180, 1e-15);
  EXPECT_EQ(day.clock.standstill.shortest_s, 1.0);
  EXPECT_FALSE(day.clock.offset_s);
}

TEST(DayDescription, EverythingThatCanBeSaid) {
  const DayDescription day = parsed(dayOf(
      "<join by=\"order\" still_deg=\"0.1\" shortest_s=\"2.5\" offset_s=\"-3\"/>"
      "<points role=\"circle_sweeps\" file=\"a\" axis=\"3\" by=\"name\" format=\"columns\" encoding=\"cp1252\" "
      "columns=\"x_mm y_mm z_mm\" separator=\";\" decimal_comma=\"yes\" skip=\"2\" target=\"P10\" frame=\"base_link\"/>"
      "<points role=\"nests\" file=\"b\" only=\"N1  a_nest_with_a_name_of_some_length\" unit=\"in\"/>"
      "<log role=\"loading\" file=\"c\" format=\"ur\" rate_hz=\"125\"/><loads file=\"d\"/>"
      "<joint_reading joint=\"3\" plus=\"2\"/><target_name from=\"1\" to=\"P10\"/>"));
  const PointsSource& points = day.points[0];
  EXPECT_EQ(points.role, Role::circle_sweeps);
  EXPECT_EQ(points.axis, 2);
  EXPECT_EQ(points.by, JoinBy::name);
  EXPECT_EQ(points.options.format, PointFormat::columns);
  EXPECT_EQ(points.options.encoding, Encoding::cp1252);
  EXPECT_EQ(points.options.separator, ";");
  EXPECT_TRUE(points.options.decimal_comma);
  EXPECT_EQ(points.options.skip, 2u);
  EXPECT_EQ(points.target, "P10");
  EXPECT_EQ(points.frame, campaign::PointFrame::base_link);
  EXPECT_EQ(day.points[1].only, (std::vector<std::string>{"N1", "a_nest_with_a_name_of_some_length"}));
  EXPECT_EQ(day.points[1].options.unit, "in");
  EXPECT_EQ(day.logs[0].role, Role::loading);
  EXPECT_EQ(day.logs[0].options.rate_hz, 125.0);
  EXPECT_EQ(day.loads[0].file, "d");
  EXPECT_EQ(day.clock.offset_s, -3.0);
  EXPECT_EQ(day.clock.standstill.shortest_s, 2.5);
  EXPECT_EQ(day.target_names.at("1"), "P10");
  ASSERT_EQ(day.xml.campaign.joint_readings.size(), 1u);
  EXPECT_EQ(day.xml.campaign.joint_readings[0].plus, 1);
}

TEST(DayDescription, RefusesWithLineAttributeAndValue) {
  expectSays(refusal(kPoints + "<log file=\"k.csv\"/>"), {"lab/DAY.xml:1", "join"});
  expectSays(refusal(kJoin), {"points"});
  expectSays(refusal("<join by=\"clok\"/>" + kPoints), {":4", "by", "'clok'", "did you mean 'clock'"});
  expectSays(refusal(kJoin + "<points role=\"load\" file=\"a\"/>"), {"role", "'load'", "loading, circle_sweeps"});
  expectSays(refusal(kJoin + "<points role=\"loading\"/>"), {"file"});
  expectSays(refusal(kJoin + "<points role=\"loading\" file=\"\"/>"), {"file"});
  expectSays(refusal(kJoin + "<points role=\"loading\" file=\"a\" format=\"SA\"/>"), {"format", "'SA'"});
  expectSays(refusal(kJoin + "<points role=\"loading\" file=\"a\" axis=\"2\"/>"), {"axis", "circle_sweeps"});
  expectSays(refusal(kJoin + "<points role=\"circle_sweeps\" file=\"a\" axis=\"0\"/>"), {"axis", "'0'", "from 1 on"});
  expectSays(refusal(kJoin + "<points role=\"loading\" file=\"a\" step=\"two\"/>"), {"step", "'two'"});
  expectSays(refusal(kJoin + "<points role=\"loading\" file=\"a\" skip=\"-1\"/>"), {"skip", "'-1'"});
  expectSays(refusal(kJoin + "<points role=\"loading\" file=\"a\" unit=\"ell\"/>"), {"unit", "'ell'"});
  expectSays(refusal(kJoin + "<points role=\"loading\" file=\"a\" decimal_comma=\"1\"/>"),
             {"decimal_comma", "yes or no"});
  expectSays(refusal(kJoin + kPoints + "<log file=\"b\" rate_hz=\"0\"/>"), {"rate_hz", "'0'"});
  expectSays(refusal("<join by=\"clock\" still_deg=\"90\"/>" + kPoints), {"still_deg", "'90'"});
  expectSays(refusal(kJoin + kPoints + "<target_name from=\"1\" to=\"P10\"/><target_name from=\"1\" to=\"P11\"/>"),
             {"from", "'1'", "repeat"});
  expectSays(refusal(kJoin + kPoints + "<joint_reading joint=\"3\" plus=\"3\"/>"), {"plus"});
  std::vector<std::string> warnings;
  parsed(dayOf(kJoin + "<points role=\"loading\" file=\"a\" colour=\"red\"/>"), &warnings);
  ASSERT_EQ(warnings.size(), 1u);
  expectSays(warnings[0], {":4", "colour"});
}

TEST(DayTemplate, EveryMakersIsADayAndItsLogFormatIsTheMakers) {
  const std::array<LogFormat, 4> formats{LogFormat::fanuc_karel, LogFormat::kuka_krl, LogFormat::rapid, LogFormat::ur};
  for (std::size_t i = 0; i < kMakerNames.size(); ++i) {
    std::vector<std::string> warnings;
    const DayDescription day = parsed(dayTemplate(makerNamed(kMakerNames[i], "--maker")), &warnings);
    EXPECT_TRUE(warnings.empty()) << kMakerNames[i];
    ASSERT_EQ(day.logs.size(), 1u);
    EXPECT_EQ(day.logs[0].options.format, formats[i]);
    EXPECT_EQ(day.points.size(), 1u);
  }
  // FANUC's joint 3 is against the horizontal.
  const DayDescription fanuc = parsed(dayTemplate(Maker::fanuc));
  ASSERT_EQ(fanuc.xml.campaign.joint_readings.size(), 1u);
  EXPECT_EQ(fanuc.xml.campaign.joint_readings[0].joint, 2);
  EXPECT_EQ(fanuc.xml.campaign.joint_readings[0].plus, 1);
  expectSays(interchange_test::refusalOf([] { makerNamed("fanux", "--maker"); }), {"--maker", "did you mean 'fanuc'"});
}

}  // namespace day_description_test
}  // namespace stiffscope
