#include <gtest/gtest.h>

#include <random>
#include "core/campaign/read_table.h"
#include "core/campaign/table_layouts.h"
#include "core/numerics/parallel.h"

namespace stiffscope {
namespace table_parts_test {

/// All that a reading gives, as text.
template <class Row>
std::string outcome(const campaign::TableLayout<Row>& layout, const std::string& bytes, std::size_t part_bytes) {
  campaign::CampaignNames names;
  for (const char* target : {"P10", "P11"}) names.targets.add(target);
  names.poses.add("known");
  std::vector<std::string> warnings;
  std::string text;
  try {
    for (Row& row : campaign::readTable<Row>({"t.csv", bytes}, layout, names, warnings, part_bytes)) {
      text += fmt::format("\n{}", row.line);
      for (const campaign::Column<Row>& column : layout.columns) {
        std::visit([&](auto member) { text += fmt::format(" {}", member(row)); }, column.member);
      }
    }
    text += fmt::format("\n{}\n{}\n{}", fmt::join(names.poses.names(), " "), fmt::join(names.repeats.names(), " "),
                        fmt::join(warnings, "\n"));
  } catch (const io::InputError& error) {
    text = error.what();
  }
  return text;
}

constexpr std::size_t kWhole = std::size_t{1} << 40;

template <class Row>
void expectSameInParts(const campaign::TableLayout<Row>& layout, const std::string& bytes) {
  const std::string whole = outcome(layout, bytes, kWhole);
  for (const std::size_t part : {1, 7, 64, 200, 1000})
    EXPECT_EQ(outcome(layout, bytes, part), whole) << part << "\n" << bytes;
}

const std::string kHeader = "pose,step,repeat,target,time_s,x_mm,y_mm,z_mm\n";

std::string row(const std::string& pose, int step, const std::string& target) {
  return fmt::format("{},{},1,{},5.5,1.25,-2,3e0\n", pose, step, target);
}

TEST(TableParts, NumberPosesAsTheyFirstAppearInTheWhole) {
  std::string bytes = kHeader;
  for (const char* pose : {"b", "known", "a", "c", "b", "a", "d"}) {
    for (const char* target : {"P11", "P10"}) bytes += row(pose, static_cast<int>(bytes.size()), target);
  }
  expectSameInParts(campaign::loadingLayout(), bytes);
  EXPECT_NE(outcome(campaign::loadingLayout(), bytes, 1).find("known b a c d"), std::string::npos);
}

// Repeats are numbers where they are written as such, and names in the order in which the whole brings them.
TEST(TableParts, NumberNamedRepeatsAsTheyFirstAppearInTheWhole) {
  std::string bytes = kHeader;
  const std::vector<std::string> repeats{"2", "b", "01", "1", "0", "a", "99999999999", "-1"};
  for (int step = 0; step < 4; ++step) {
    for (std::size_t k = 0; k < repeats.size(); ++k)
      bytes += fmt::format("p,{},{},P10,5.5,1,2,3\n", step, repeats[(k + static_cast<std::size_t>(3 * step)) % 8]);
  }
  expectSameInParts(campaign::loadingLayout(), bytes);
  EXPECT_NE(outcome(campaign::loadingLayout(), bytes, 1).find("\nb 01 a 99999999999 -1\n"), std::string::npos);
  // "1" and "01" are two repeats; the same one twice is refused.
  EXPECT_EQ(outcome(campaign::loadingLayout(), bytes + "p,3,01,P10,5.5,1,2,3\n", 1)
                .find("expected a key that does not repeat"),
            outcome(campaign::loadingLayout(), bytes + "p,3,01,P10,5.5,1,2,3\n", kWhole)
                .find("expected a key that does not repeat"));
  EXPECT_NE(outcome(campaign::loadingLayout(), bytes + "p,3,01,P10,5.5,1,2,3\n", 1).find("does not repeat"),
            std::string::npos);
}

TEST(TableParts, CountLinesOfEveryEndAndBlankOnes) {
  const std::string a = row("a", 1, "P10"), b = row("b", 1, "P10"), c = row("c", 1, "P10");
  for (const std::string end : {"\n", "\r\n", "\r", "\n\n\n", "\r\n \t\r\n", "\n\r", "\r\r\n"}) {
    std::string bytes;
    for (const std::string& line : {kHeader, a, b, c, a}) bytes += line.substr(0, line.size() - 1) + end;
    expectSameInParts(campaign::loadingLayout(), bytes);                                  // line 5 or so repeats a key
    expectSameInParts(campaign::loadingLayout(), bytes.substr(0, bytes.rfind("a,1,1")));  // it does not
    expectSameInParts(campaign::loadingLayout(), bytes.substr(0, bytes.rfind(",P10") + 4));  // cut short
  }
}

TEST(TableParts, RefuseTheFirstErrorOfTheFile) {
  const std::string good = kHeader + row("a", 1, "P10") + row("b", 1, "P10") + row("c", 1, "P11");
  const std::string repeat = row("b", 1, "P10"), unknown = row("d", 1, "P99"), quote = "\"d,1,1,P10,5,1,2,3\n",
                    few = "d,1\n";
  for (const std::string& first : {repeat, unknown, quote, few}) {
    for (const std::string& second : {repeat, unknown, quote, few}) {
      expectSameInParts(campaign::loadingLayout(), good + first + row("e", 1, "P10") + second);
    }
  }
  EXPECT_EQ(
      outcome(campaign::loadingLayout(), good + repeat + unknown, 1),
      "t.csv:5: pose, step, repeat, target: 'b, 1, 1, P10': expected a key that does not repeat; line 3 has it first");
  expectSameInParts(campaign::loadingLayout(), kHeader);
  expectSameInParts(campaign::loadingLayout(), kHeader + "\n\n\n");
  expectSameInParts(campaign::loadingLayout(), "");
}

TEST(TableParts, ReadWhatOneReadingReadsInAThousandSpoiltTables) {
  // Rows of which bytes are overwritten, by few letters so that quotes, commas and line ends meet often.
  std::mt19937_64 random(3);
  const std::string letters = "\"\",,\n\r 1abP.";
  for (int table = 0; table < 1000; ++table) {
    std::string bytes = kHeader;
    for (int i = 0; i < 12; ++i) {
      bytes += row(std::string(1, static_cast<char>('a' + random() % 4)), static_cast<int>(random() % 40),
                   random() % 2 ? "P10" : "P11");
    }
    for (std::uint64_t k = random() % 4; k > 0; --k) {
      bytes[kHeader.size() + random() % (bytes.size() - kHeader.size())] = letters[random() % letters.size()];
    }
    expectSameInParts(campaign::loadingLayout(), bytes);
  }
}

TEST(OnAllCores, CallsEachIndexOnce) {
  std::vector<int> calls(10'000);
  numerics::onAllCores(calls.size(), [&](std::size_t i) { ++calls[i]; });
  numerics::smallWorkOnAllCores(calls.size(), [&](std::size_t i) { ++calls[i]; });
  EXPECT_EQ(calls, std::vector<int>(calls.size(), 2));
}

TEST(OnAllCores, ThrowsTheExceptionOfTheLowestIndex) {
  for (int repeat = 0; repeat < 100; ++repeat) {
    std::string what;
    try {
      numerics::onAllCores(64, [](std::size_t i) {
        if (i % 8 == 5) throw std::runtime_error(std::to_string(i));
      });
    } catch (const std::runtime_error& error) {
      what = error.what();
    }
    EXPECT_EQ(what, "5");
  }
}

}  // namespace table_parts_test
}  // namespace stiffscope
