#include <gtest/gtest.h>

#include <bit>
#include <clocale>
#include <cmath>
#include <fstream>
#include <random>
#include "core/io/input_error.h"
#include "core/io/numbers.h"
#include "core/io/write_file.h"
#include "tests/fixtures/small_campaign.h"

namespace stiffscope {
namespace numbers_and_xml_test {

std::string contentOf(const std::filesystem::path& file) {
  std::string text;
  std::getline(std::ifstream(file), text, '\0');
  return text;
}

TEST(NearestName, CountsEdits) {
  EXPECT_EQ(io::editDistance("", "abc"), 3u);
  EXPECT_EQ(io::editDistance("kitten", "sitting"), 3u);  // Wagner and Fischer's example
  EXPECT_EQ(io::editDistance("flnage", "flange"), 1u);   // two neighbours swapped
  EXPECT_EQ(io::editDistance("Robot", "robot"), 0u);
}

TEST(NearestName, NamesOnlyWhatIsNear) {
  const std::vector<std::string> names{"link_compliance", "bearing_tilt", "x", "backlash"};
  EXPECT_EQ(io::nearestName("link_complience", names), "link_compliance");
  EXPECT_EQ(io::nearestName("baklash", names), "backlash");
  EXPECT_EQ(io::nearestName("hysteresis", names), "");
  EXPECT_EQ(io::nearestName("y", names), "");  // every letter differs
  EXPECT_EQ(io::nearestName("", names), "");
  EXPECT_EQ(io::nearestNameHint("bearingtilt", names), " (did you mean 'bearing_tilt'?)");
  EXPECT_EQ(io::nearestNameHint("zzz", names), "");
}

TEST(Numbers, AreReadWholeAndTheSameInEveryLocale) {
  const char* const before = std::setlocale(LC_NUMERIC, nullptr);
  const std::string restored = before;
  for (const char* locale : {"C", "de_DE.UTF-8"}) {
    std::setlocale(LC_NUMERIC, locale);  // where it is not installed nothing changes
    EXPECT_EQ(io::parseNumber("-1.5e3").value, -1500.0);
    EXPECT_EQ(io::parseNumber("+.5").value, 0.5);
    EXPECT_NE(io::parseNumber("1,5").expectation, "");
  }
  std::setlocale(LC_NUMERIC, restored.c_str());
  for (const char* text : {"", " 1", "1 ", "+", "-", "+-1", "++1", "1.2.3", "1e", "inf", "NaN", "1e400", "0x10"}) {
    EXPECT_NE(io::parseNumber(text).expectation, "") << text;
  }
  EXPECT_EQ(io::parseInteger("+7"), 7);
  for (const char* text : {"", "7.0", "7a", "99999999999"}) EXPECT_FALSE(io::parseInteger(text)) << text;
}

TEST(Numbers, WhatIsWrongIsSaid) {
  const auto says = [](const char* text, const char* part) {
    EXPECT_NE(io::parseNumber(text).expectation.find(part), std::string::npos)
        << text << ": " << io::parseNumber(text).expectation;
  };
  for (const char* text : {"1,5", "-0,25", "1500,5"}) says(text, "not a decimal comma");
  for (const char* text : {"1,234.5", "1.234,5", "1,234,567"}) says(text, "without a mark between thousands");
  for (const char* text : {"27.11.2026", "27.11.2026 08:00:00", "2026-11-27T08:00:00", "2026-11-27", "11/27/2026",
                           "08:15", "08:15:30.5", "27.11.26"})
    says(text, "times are in seconds");
  for (const char* text : {"1.2.3", "1e-5-", "-", "."})
    EXPECT_EQ(io::parseNumber(text).expectation.find("seconds"), std::string::npos) << text;
}

// The way of tables must give the very bits of the other, wherever it gives a value at all.
TEST(Numbers, OfTablesAreTheSameBits) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 200000; ++i) {
    std::string text =
        std::to_string(random() % static_cast<std::uint64_t>(std::pow(10.0, 1.0 + static_cast<double>(random() % 15))));
    if (random() % 4 != 0) text.insert(random() % (text.size() + 1), ".");
    if (random() % 2 != 0) text.insert(0, "-");
    if (random() % 4 == 0) text += "e-3";
    const io::ParsedNumber expected = io::parseNumber(text);
    ASSERT_EQ(expected.expectation, "") << text;
    ASSERT_EQ(std::bit_cast<std::uint64_t>(io::numberOrNan(text)), std::bit_cast<std::uint64_t>(expected.value))
        << text;
  }
  EXPECT_EQ(std::signbit(io::numberOrNan("-0")), true);
  for (const char* text : {"", "-", ".", "-.", "1.2.3", "--1", "+1", "1e", "1 ", " 1", "nan", "inf", "-infinity",
                           "1e999", "0x10", "1,5"}) {
    EXPECT_TRUE(std::isnan(io::numberOrNan(text))) << text;
  }
}

TEST(InputErrorMessage, IsOneLineWhateverTheValueHolds) {
  const io::InputError error({"a\nb.csv", 7, "x\tmm"}, std::string(78, 'v') + "\xC3\xBC\xC3\xBC", "expected\nthis");
  EXPECT_EQ(std::string(error.what()), "a?b.csv:7: x?mm: '" + std::string(78, 'v') + "\xC3\xBC...': expected?this");
  EXPECT_EQ(std::string(io::InputError({"", 0, ""}, "\xE9\x1B[2J", "no").what()), "'??[2J': no");
}

TEST(Utf8, FindsTheFirstByteThatIsNone) {
  EXPECT_EQ(io::findNotUtf8("a\xC3\xBC\xE2\x82\xAC\xF0\x9F\x98\x80"), std::string_view::npos);
  EXPECT_EQ(io::findNotUtf8("ab\xFF"), 2u);
  EXPECT_EQ(io::findNotUtf8("\xC0\x80"), 0u);          // longer than needed
  EXPECT_EQ(io::findNotUtf8("\xED\xA0\x80"), 0u);      // a surrogate
  EXPECT_EQ(io::findNotUtf8("\xF4\x90\x80\x80"), 0u);  // beyond the last character
  EXPECT_EQ(io::findNotUtf8("a\xE2\x82"), 1u);         // cut short
  EXPECT_EQ(io::findNotUtf8("\xE0\x9F\xBF"), 0u);      // longer than needed, of three bytes
  EXPECT_EQ(io::findNotUtf8("\xF0\x8F\xBF\xBF"), 0u);  // and of four
  EXPECT_EQ(io::findNotUtf8("\xEF\xBF\xBF"),
            std::string_view::npos);  // no character is assigned there, but it is UTF-8
  EXPECT_EQ(io::findNotUtf8(""), std::string_view::npos);
}

TEST(WriteFile, ReplacesWholeFilesAndLeavesNothingBehind) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "a.json";
  io::writeFileWhole(file, "one");
  io::writeFileWhole(file, "two");
  EXPECT_EQ(contentOf(file), "two");
  std::filesystem::create_symlink("a.json", folder.path() / "link");
  io::writeFileWhole(folder.path() / "link", "three");
  EXPECT_EQ(contentOf(file), "three");
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path() / "link"));
  io::writeFileWhole("/dev/null", "gone");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2);
}

TEST(WriteFile, SaysWhichFileAndWhy) {
  const TemporaryFolder folder;
  const auto why = [](const std::filesystem::path& path) -> std::string {
    try {
      io::writeFileWhole(path, "x");
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  const std::string name = folder.path().string();
  EXPECT_EQ(why(folder.path() / "no" / "a"),
            name + "/no/a: cannot be written: expected a folder that is there; there is no " + name + "/no");
  EXPECT_EQ(why(folder.path()), name + ": cannot be written: it is a directory; expected the name of a file");
  EXPECT_EQ(why(""), ": cannot be written: it names no file; expected the name of one");
  if (std::filesystem::exists("/dev/full")) {
    EXPECT_EQ(why("/dev/full"), "/dev/full: cannot be written: No space left on device");
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace numbers_and_xml_test
}  // namespace stiffscope
