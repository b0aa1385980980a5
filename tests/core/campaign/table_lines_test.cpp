#include "core/campaign/read_table.h"

#include <gtest/gtest.h>

#include "core/io/input_error.h"

namespace stiffscope {
namespace table_lines_test {

using campaign::TableLines;
using campaign::TableSource;

const std::vector<campaign::WantedColumn> kWanted{
    {"pose"}, {"x_mm"}, {"from_s", false, "time"}, {"until_s", false, "time"}, {"note", false}};

std::string refusal(const std::string& bytes) {
  const TableSource source{"t.csv", bytes};
  std::vector<std::string> warnings;
  try {
    TableLines lines(source, kWanted, warnings);
    while (lines.next()) continue;
  } catch (const io::InputError& error) {
    return error.what();
  }
  return "read";
}

TEST(TableLines, FindsColumnsWhereverTheyStand) {
  const TableSource source{"t.csv", "note,x_mm,operator,pose\ngood,1.5,me,a\nbad,-2,me,b\n"};
  std::vector<std::string> warnings;
  TableLines lines(source, kWanted, warnings);
  EXPECT_EQ(lines.placeOf(0), 3u);
  EXPECT_EQ(lines.placeOf(1), 1u);
  EXPECT_FALSE(lines.has(2));
  EXPECT_FALSE(lines.has(3));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("operator"), std::string::npos) << warnings[0];
  ASSERT_TRUE(lines.next());
  EXPECT_EQ(lines.cell(0), "a");
  EXPECT_EQ(lines.cell(4), "good");
  ASSERT_TRUE(lines.next());
  EXPECT_EQ(lines.line(), 3u);
  EXPECT_EQ(lines.cell(1), "-2");
  EXPECT_FALSE(lines.next());
  EXPECT_EQ(warnings.size(), 1u);
}

TEST(TableLines, WarnOfALastLineThatMayBeCutShort) {
  const TableSource source{"t.csv", "pose,x_mm\na,1\nb,2"};
  std::vector<std::string> warnings;
  TableLines lines(source, kWanted, warnings);
  while (lines.next()) continue;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].rfind("t.csv:3: the last line has no line end", 0), 0u) << warnings[0];
}

TEST(TableLines, RefuseWhatIsNoTable) {
  EXPECT_EQ(refusal("pose,x_mm\na,1\n"), "read");
  EXPECT_EQ(refusal(""), "t.csv: expected a header line; there is none");
  EXPECT_EQ(refusal("pose,x_mm\n"), "t.csv: expected at least one row below the header");
  EXPECT_EQ(refusal("pose,x_mm\na,1\nb,2,5\n"),
            "t.csv:3: '3 cells': expected 2 cells, as the header has; a decimal comma splits a number in two, write a "
            "point");
  EXPECT_EQ(refusal("pose,x_mm,\na,1,\nb,2,5\n"),
            "t.csv:3: column 3: '5': expected nothing in a column without a name; a decimal comma splits a number in "
            "two");
  EXPECT_EQ(refusal("pose,x_mm,pose\na,1,b\n"), "t.csv:1: pose: expected this column once; the header has it twice");
  // Columns of one group come together.
  EXPECT_EQ(refusal("pose,x_mm,from_s\na,1,5\n").rfind("t.csv:1: until_s: expected this column", 0), 0u);
}

// 12 bytes of rows in 5 lines: a row is no shorter than "a,1\n" without what may be blank, so three at most and one
// that is begun; and never more than there are lines.
TEST(TableLines, BoundTheRowsByBytesAndByLines) {
  const TableSource source{"t.csv", "pose,x_mm\na,1\nb,2\nc,3\n"};
  std::vector<std::string> warnings;
  const TableLines lines(source, kWanted, warnings);
  EXPECT_EQ(lines.mostRows(12, 5), 4u);
  EXPECT_EQ(lines.mostRows(12, 2), 2u);
}

}  // namespace table_lines_test
}  // namespace stiffscope
