#include "core/interchange/day_description.h"

#include <gtest/gtest.h>

#include "core/interchange/length_unit.h"
#include "tests/core/interchange/refusal.h"

namespace stiffscope {
namespace name_pattern_test {

using interchange::metresIn;
using interchange::NamePattern;
using interchange_test::expectSays;
using Fields = std::map<std::string, std::string>;

struct Patterned {
  io::XmlFile xml{"day.xml", "<day>\n<points names='as asked'/></day>"};
  NamePattern of(const std::string& pattern) const {
    return NamePattern(xml.root().children("points").front(), "names", pattern);
  }
  std::string refusal(const std::string& pattern) const {
    return interchange_test::refusalOf([&] { of(pattern); });
  }
};

TEST(NamePattern, FieldsBetweenTheLettersOfThePattern) {
  const Patterned given;
  const NamePattern pattern = given.of("P{target}_{pose}_{step}");
  EXPECT_EQ(pattern.fieldsIn("P10_7_2"), (Fields{{"target", "10"}, {"pose", "7"}, {"step", "2"}}));
  EXPECT_FALSE(pattern.fieldsIn("P10_7"));
  EXPECT_FALSE(pattern.fieldsIn("Q10_7_2"));
  EXPECT_FALSE(pattern.fieldsIn("P10__2"));  // a field is never empty
  EXPECT_TRUE(pattern.has("pose"));
  EXPECT_FALSE(pattern.has("axis"));
}

TEST(NamePattern, SignsOfExpressionsStandForThemselves) {
  const Patterned given;
  EXPECT_TRUE(given.of("P[{pose}]").fieldsIn("P[12]"));
  EXPECT_FALSE(given.of("P[{pose}]").fieldsIn("P1"));
  EXPECT_TRUE(given.of("a.b*({target})").fieldsIn("a.b*(1)"));
  EXPECT_FALSE(given.of("a.b").fieldsIn("axb"));
}

TEST(NamePattern, PartsOfCollectionGroupAndName) {
  const Patterned given;
  interchange::PointReading point;
  interchange::PointGroups groups;
  point.of = groups.of("Day", "step2");
  point.name = "P10";
  EXPECT_EQ(given.of("step{step}::{target}").fieldsIn(point), (Fields{{"step", "2"}, {"target", "P10"}}));
  EXPECT_EQ(given.of("{*}::step{step}::{target}").fieldsIn(point), (Fields{{"step", "2"}, {"target", "P10"}}));
  EXPECT_EQ(given.of("{target}").fieldsIn(point), (Fields{{"target", "P10"}}));
  point.name = "a::b";
  EXPECT_FALSE(given.of("{target}").fieldsIn(point));
}

TEST(NamePattern, RefusesWhatIsNoPattern) {
  const Patterned given;
  expectSays(given.refusal("{targt}"), {"day.xml:2: names", "{targt}", "did you mean 'target'"});
  expectSays(given.refusal("{target"), {"expected '}'"});
  expectSays(given.refusal("target}"), {"expected '{'"});
  expectSays(given.refusal("{pose}_{pose}"), {"{pose}", "once"});
  expectSays(given.refusal("{*}::{*}::{*}::{target}"), {"collection::group::name"});
  expectSays(given.refusal(""), {"1 to 200"});
  expectSays(given.refusal(std::string(201, 'a')), {"1 to 200"});
}

TEST(LengthUnit, InTheLanguagesSeen) {
  for (const char* unit : {"mm", "MM", "Millimeter", "Millimetern", "millimetres"}) EXPECT_EQ(metresIn(unit), 1e-3);
  for (const char* unit : {"m", "Meter", "metern", "metres"}) EXPECT_EQ(metresIn(unit), 1.0);
  for (const char* unit : {"in", "Inches", "Zoll", "pouces", "\""}) EXPECT_EQ(metresIn(unit), 0.0254);
  EXPECT_EQ(metresIn("\xC2\xB5m"), metresIn("\xCE\xBCm"));  // the micro sign and the Greek letter
  EXPECT_DOUBLE_EQ(*metresIn("\xC2\xB5m"), 1e-6);
  for (const char* unit : {"", "furlong", "mmm", "deg"}) EXPECT_FALSE(metresIn(unit)) << unit;
}

TEST(LengthUnit, MillimetresAreTakenWithAWarning) {
  std::vector<std::string> warnings;
  EXPECT_EQ(interchange::unitOrMillimetres("a.txt", "", warnings), 1e-3);
  ASSERT_EQ(warnings.size(), 1u);
  expectSays(warnings[0], {"a.txt", "no unit", "millimetres"});
  EXPECT_EQ(interchange::unitOrMillimetres("a.txt", "in", warnings), 0.0254);
  EXPECT_EQ(warnings.size(), 1u);
  expectSays(interchange_test::refusalOf([&] { interchange::unitOrMillimetres("a.txt", "ell", warnings); }),
             {"unit", "'ell'", "mm, m or in"});
}

}  // namespace name_pattern_test
}  // namespace stiffscope
