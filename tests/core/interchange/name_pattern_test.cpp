#include "core/interchange/day_description.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <regex>

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

TEST(NamePattern, EachFieldTakesTheFewestLettersFromTheLeft) {
  const Patterned given;
  EXPECT_EQ(given.of("{target}_{pose}").fieldsIn("a_b_c"), (Fields{{"target", "a"}, {"pose", "b_c"}}));
  EXPECT_EQ(given.of("{target}{pose}").fieldsIn("abc"), (Fields{{"target", "a"}, {"pose", "bc"}}));
  EXPECT_EQ(given.of("{target}ab").fieldsIn("abab"), (Fields{{"target", "ab"}}));
  EXPECT_FALSE(given.of("{target}{pose}{step}").fieldsIn("ab"));
}

// As an expression of the standard library, each field a group of letters that is as short as it may be, finds them.
TEST(NamePattern, FindsWhatAnExpressionFinds) {
  const Patterned given;
  const std::vector<std::string> pieces{"{target}", "{pose}", "{step}", "a", "b", "ab", "::"};
  std::mt19937 random(7);
  const auto below = [&](std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
  };
  int matched = 0;
  for (int i = 0; i < 1000; ++i) {
    std::string pattern, expression, name;
    std::vector<std::string> fields;
    int parts = 0;
    for (std::size_t k = below(6) + 1; k > 0; --k) {
      const std::string& piece = pieces[below(pieces.size())];
      const std::string field = piece[0] == '{' ? piece.substr(1, piece.size() - 2) : "";
      if (std::find(fields.begin(), fields.end(), field) != fields.end() ||
          (piece == "::" && (pattern.ends_with(":") || ++parts > 2)))
        continue;
      pattern += piece;
      expression += field.empty() ? piece : "([^:]+?)";
      if (!field.empty()) fields.push_back(field);
    }
    if (pattern.empty()) continue;
    for (std::size_t k = below(8); k > 0; --k) name += below(8) == 0 ? "::" : below(2) == 0 ? "a" : "b";
    std::smatch match;
    const bool of_it = std::regex_match(name, match, std::regex(expression));
    const auto found = given.of(pattern).fieldsIn(name);
    ASSERT_EQ(found.has_value(), of_it) << pattern << " " << name;
    if (!of_it) continue;
    ++matched;
    for (std::size_t f = 0; f < fields.size(); ++f)
      EXPECT_EQ(found->at(fields[f]), match[f + 1].str()) << pattern << " " << name;
  }
  EXPECT_GT(matched, 50);
}

// 66 fields and no letter that ends them: ways to share 200 letters among them have 54 digits. It takes no time.
TEST(NamePattern, ManyFieldsInALongName) {
  const Patterned given;
  std::string pattern;
  for (int i = 0; i < 66; ++i) pattern += "{*}";
  EXPECT_FALSE(given.of(pattern + "x").fieldsIn(std::string(200, 'a')));
  EXPECT_TRUE(given.of(pattern + "x").fieldsIn(std::string(200, 'a') + "x"));
  EXPECT_FALSE(given.of(pattern).fieldsIn(std::string(65, 'a')));
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

TEST(NamePattern, PartsInOneCellAreThoseOfThreeCells) {
  const Patterned given;
  interchange::PointReading one, three;
  interchange::PointGroups groups;
  one.name = "Day::step2::P10";
  three.of = groups.of("Day", "step2");
  three.name = "P10";
  for (const char* pattern :
       {"step{step}::{target}", "{*}::step{step}::{target}", "Day::step{step}::{target}", "Day::step2::{target}"}) {
    ASSERT_TRUE(given.of(pattern).fieldsIn(three)) << pattern;
    EXPECT_EQ(given.of(pattern).fieldsIn(one), given.of(pattern).fieldsIn(three)) << pattern;
  }
  // Also below a group of its own.
  one.of = groups.of("", "Main");
  EXPECT_EQ(given.of("{*}::step{step}::{target}").fieldsIn(one), (Fields{{"step", "2"}, {"target", "P10"}}));
  EXPECT_FALSE(given.of("Night::step{step}::{target}").fieldsIn(one));
  one.name = "P10";
  EXPECT_FALSE(given.of("{*}::{*}::{target}").fieldsIn(one));  // it has two parts
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
