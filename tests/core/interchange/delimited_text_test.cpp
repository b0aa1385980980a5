#include "core/interchange/delimited_text.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/interchange/column_table.h"
#include "core/interchange/point_file.h"
#include "core/interchange/point_reading.h"
#include "tests/core/interchange/refusal.h"

namespace stiffscope {
namespace delimited_text_test {

using namespace interchange;
using interchange_test::expectSays;
using interchange_test::refusalOf;
using Cells = std::vector<std::string_view>;

TEST(DelimitedText, LinesEndInThreeWays) {
  std::vector<TextLine> lines;
  for (const TextLine& line : linesOf("a\nb\r\nc\rd")) lines.push_back(line);
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_EQ(lines[2].text, "c");
  EXPECT_EQ(lines[3].number, 4u);
  EXPECT_TRUE(lines[2].ended);
  EXPECT_FALSE(lines[3].ended);
  EXPECT_TRUE(linesOf("").begin() == linesOf("").end());
}

TEST(DelimitedText, CellsAndQuotes) {
  EXPECT_EQ(cellsBetween(" a ;\"b;c\";;d", ';'), (Cells{"a", "b;c", "", "d"}));
  EXPECT_EQ(cellsBetween("\"open;b", ';'), (Cells{"\"open", "b"}));
  EXPECT_EQ(cellsBetween("\xC2\xA0x\xC2\xA0", ';'), (Cells{"x"}));
  EXPECT_EQ(cellsBetweenBlanks("  Main   nominal 1   2.5", 2), (Cells{"Main", "nominal 1", "2.5"}));
  EXPECT_EQ(cellsBetweenBlanks("a b\tc", 1), (Cells{"a", "b", "c"}));
  EXPECT_EQ(cellsBetweenBlanks("a b\tc", 2), (Cells{"a b", "c"}));
  EXPECT_EQ(longestBlanks("  a   b  "), 3u);
}

// RFC 4180: a quote in a quoted cell is written twice.
TEST(DelimitedText, QuotesInQuotedCells) {
  const PointFile file =
      parsePointFile("p.csv",
                     "target,x_mm,y_mm,z_mm,pose,group\n"
                     "\"a \"\"quoted\"\", b\",1,2,3,\"\"\"4\"\"\",\"g\"\",\"\n\"\",4,5,6,x,\"\"\"\"\n");
  ASSERT_EQ(file.points.size(), 2u);
  EXPECT_EQ(file.points[0].name, "a \"quoted\", b");
  EXPECT_EQ(file.points[0].column("pose"), "\"4\"");
  EXPECT_EQ(file.points[0].group(), "g\",");
  EXPECT_EQ(file.points[1].name, "");
  EXPECT_EQ(file.points[1].group(), "\"");
  EXPECT_EQ(file.points[1].occurrence, 1);
  EXPECT_EQ(file.points[1].point.y(), 5e-3);
  // Quotes without a partner are letters.
  EXPECT_EQ(cellsBetween("5\";\"\"x;y", ';'), (Cells{"5\"", "\"\"x", "y"}));
  // The same of tables with another grammar.
  const PointFile leica =
      parsePointFile("p.csv", "Name,X [mm],Y [mm],Z [mm],Q0,\"Q, \"\"1\"\"\"\n\"a \"\"b\"\", c\",1,2,3,1,\"0\"\n");
  EXPECT_EQ(leica.points[0].name, "a \"b\", c");
}

TEST(DelimitedText, NumbersWithEitherDecimalSign) {
  EXPECT_EQ(decimalOrNan("-.5", DecimalSign::point), -0.5);
  EXPECT_EQ(decimalOrNan("12.", DecimalSign::point), 12.0);
  EXPECT_EQ(decimalOrNan("-1,25", DecimalSign::comma), -1.25);
  for (const char* text : {"1.25", "1,2,3", "1.000,5", "", "x", "nan", "inf", "0x10"})
    EXPECT_TRUE(std::isnan(decimalOrNan(text, DecimalSign::comma))) << text;
  expectSays(refusalOf([] { decimal("1.5", DecimalSign::comma, "f", 3, "x"); }), {"f:3: x", "'1.5'", "has a point"});
  expectSays(refusalOf([] { decimal("1,5", DecimalSign::point, "f", 3, "x"); }), {"'1,5'", "has a comma"});
  EXPECT_EQ(decimalsOf("1.250"), 3);
  EXPECT_EQ(decimalsOf("1e5"), -1);
  EXPECT_TRUE(looksLikeDecimalComma("-12,5"));
  EXPECT_FALSE(looksLikeDecimalComma("P1,5"));
  EXPECT_FALSE(looksLikeDecimalComma("1,2,3"));
}

TEST(TextDecoding, EveryByteOfTheWesternCodePage) {
  EXPECT_EQ(decodeText("f", "\x80\xB5\xFC", Encoding::cp1252).text(), "\xE2\x82\xAC\xC2\xB5\xC3\xBC");
  // Five bytes stand for nothing.
  for (const char* undefined : {"\x81", "\x8D", "\x8F", "\x90", "\x9D"})
    expectSays(refusalOf([&] { decodeText("f", std::string("a\nb") + undefined, Encoding::cp1252); }),
               {"f:2", "byte 0x", "cp1252"});
}

TEST(TextDecoding, Utf16OfBothOrdersWithCharactersBeyondTheFirstPlane) {
  const std::string big("\xFE\xFF\x00x\x00\n\xD8\x3D\xDE\x00", 10), little("\xFF\xFEx\x00\n\x00\x3D\xD8\x00\xDE", 10);
  EXPECT_EQ(decodeText("f", big).text(), "x\n\xF0\x9F\x98\x80");
  EXPECT_EQ(decodeText("f", little).text(), "x\n\xF0\x9F\x98\x80");
  expectSays(refusalOf([&] { decodeText("f", big.substr(0, 9)); }), {"f:2", "utf-16be"});
  expectSays(refusalOf([&] { decodeText("f", std::string("a\nb\0c", 5)); }), {"f:2", "byte 0"});
}

TEST(TextDecoding, TwoFilesPutTogetherAreRefusedWithBothLines) {
  expectSays(refusalOf([] { decodeText("f", "a\xC3\xA4\nb\n\xE4 x\n"); }), {"f:3", "0xE4", "line 1", "two files"});
}

/// A table of these bytes and columns.
struct Tabled {
  std::string file = "t.csv", text;
  FileOptions options;
  std::string refusal() const {
    return refusalOf([&] { rowsOf(ColumnTable({file, text, options})); });
  }

  static std::vector<ColumnTable::Row> rowsOf(const ColumnTable& table) {
    std::vector<ColumnTable::Row> rows;
    table.forEachRow([&rows](const ColumnTable::Row& row) { rows.push_back(row); });
    return rows;
  }
};

TEST(ColumnTable, UnitsBecomeSi) {
  Tabled given;
  given.options.columns = "pose x_mm ux_um y_in q1_deg fx_kn time_ms temperature_c -";
  given.text = "A;1;2;3;180;0.5;250;21.5;ignored\n";
  const ColumnTable table({given.file, given.text, given.options});
  const auto row = Tabled::rowsOf(table).front();
  EXPECT_EQ(table.separator(), ';');
  EXPECT_DOUBLE_EQ(table.number(row, "x"), 1e-3);
  EXPECT_DOUBLE_EQ(table.number(row, "ux"), 2e-6);
  EXPECT_DOUBLE_EQ(table.number(row, "y"), 3 * 0.0254);
  EXPECT_DOUBLE_EQ(table.number(row, "q1"), std::acos(-1.0));
  EXPECT_DOUBLE_EQ(table.number(row, "fx"), 500.0);
  EXPECT_DOUBLE_EQ(table.number(row, "temperature"), 21.5);
  EXPECT_DOUBLE_EQ(table.time(row)->seconds, 0.25);
  EXPECT_DOUBLE_EQ(table.time(row)->resolution, 1e-3);
  EXPECT_EQ(table.text(row, "pose"), "A");
  EXPECT_EQ(table.text(row, "step"), "");
}

TEST(ColumnTable, TheSeparatorIsTheOneThatGivesTheColumns) {
  for (const char* text : {"1,2,3\n", "1;2;3\n", "1\t2\t3\n", "1  2 3\n", "1;2;3;;;\n"}) {
    Tabled given;
    given.options.columns = "x_m y_m z_m";
    given.text = text;
    const ColumnTable table({given.file, given.text, given.options});
    EXPECT_DOUBLE_EQ(table.number(Tabled::rowsOf(table).front(), "z"), 3.0) << text;
  }
}

TEST(ColumnTable, RefusesWrongColumnsAndRows) {
  Tabled given;
  given.text = "1;2;3\n1;2\n";
  given.options.columns = "x_mm y_mm z_mm";
  expectSays(given.refusal(), {"t.csv:2", "2 cells", "expected 3 cells"});
  given.text = "1;2;3\n1;2";
  expectSays(given.refusal(), {"t.csv:2", "ends in the middle"});
  given.text = "1,5,2,5,3,5\n";
  expectSays(given.refusal(), {"6 cells", "decimal comma"});
  given.options.columns = "x_mm y_mm x_m";
  expectSays(given.refusal(), {"x_m", "once"});
  given.options.columns = "x y_mm z_mm";
  expectSays(given.refusal(), {"'x'", "with its unit"});
  given.options.columns = "x_mm y_mm z_mm";
  given.options.separator = "||";
  expectSays(given.refusal(), {"separator", "one character, tab or blank"});
  given.options = {};
  given.text = "\n\n";
  expectSays(given.refusal(), {"there are none"});
  given.text = "x_mm,y_mm,z_mm\n";
  expectSays(given.refusal(), {"below the header"});
}

}  // namespace delimited_text_test
}  // namespace stiffscope
