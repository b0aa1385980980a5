#include "core/interchange/point_file.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/interchange/refusal.h"

// Small files in the grammar of each format; none is a part of a published one.

namespace stiffscope {
namespace point_file_test {

using interchange::FileOptions;
using interchange::parsePointFile;
using interchange::PointFile;
using interchange::PointFormat;
using interchange::Skip;

// A coordinate in mm with six decimals is exact to half a unit of the last of 16 digits.
constexpr double kExact = 1e-15;

PointFile read(const std::string& text, const FileOptions& options = {}) {
  return parsePointFile("day.txt", text, options);
}

std::string refusal(const std::string& text, const FileOptions& options = {}) {
  return interchange_test::refusalOf([&] { read(text, options); });
}

using interchange_test::expectSays;

void expectNear(const Eigen::Vector3d& found, double x, double y, double z) {
  EXPECT_LT((found - Eigen::Vector3d(x, y, z)).norm(), kExact) << found.transpose();
}

const std::string kSa =
    "// SpatialAnalyzer SA 2031.1 ( x64 )  \n"
    "// Points Relative to Coordinate Frame 'Cell::BASE'\n"
    "// AXES = CARTESIAN: X,  Y,  Z (mm)\n"
    "Run,  Main,  1,  1500.123456,  -20.500000,  300.250000,  03/04/31 09:08:07\n"
    "Run,  Main,  2,  1500.223456,  -20.600000,  300.350000,  03/04/31 09:08:07\n"
    "Run,  Main,  1,  1501.123456,  -21.500000,  301.250000,  03/04/31 09:08:09\n";

TEST(SpatialAnalyzer, CommasNamesTimesAndFrame) {
  const PointFile file = read(kSa);
  EXPECT_EQ(file.format, PointFormat::sa);
  EXPECT_EQ(file.frame, "Cell::BASE");
  ASSERT_EQ(file.points.size(), 3u);
  EXPECT_EQ(file.points[1].collection(), "Run");
  EXPECT_EQ(file.points[1].group(), "Main");
  EXPECT_EQ(file.points[1].name, "2");
  expectNear(file.points[0].point, 1.500123456, -0.0205, 0.30025);
  EXPECT_FALSE(file.points[0].sigma);
  ASSERT_TRUE(file.points[2].time);
  EXPECT_EQ(isoTime(*file.points[2].time), "2031-03-04T09:08:09");  // the month stands first
  EXPECT_EQ(file.points[2].line, 6u);
  EXPECT_EQ(file.points[0].occurrence, 1);
  EXPECT_EQ(file.points[2].occurrence, 2);  // the same name again
  EXPECT_TRUE(file.warnings.empty());
}

TEST(SpatialAnalyzer, AnotherLanguageBlanksAndUncertainties) {
  const PointFile file = read(
      "// SpatialAnalyzer SA 2031.1\n"
      "// Punkte beziehn sich auf Koordinatensisthem 'Zelle 4::Roboterbasis'\n"
      "// Unsicherheiten 95.0 % Vertrauensbereich\n"
      "// ACHSEN = KARTESICH: X   Y   Z (Meter)   U-x   U-y   U-z   U-mag\n"
      "Tag   Haupt   P10   1.250000   -2.500000   0.125000   0.000020   0.000030   0.000060   0.000070   02/03/31 "
      "10:00:00\n"
      "Tag   Haupt   nominal 1   1.000000   2.000000   3.000000   00:00:00\n"
      "Tag   Haupt   nominal 2   1.500000   2.000000   3.000000               00:00:00\n");
  EXPECT_EQ(file.frame, "Zelle 4::Roboterbasis");
  ASSERT_EQ(file.points.size(), 3u);
  expectNear(file.points[0].point, 1.25, -2.5, 0.125);
  ASSERT_TRUE(file.points[0].sigma);
  expectNear(*file.points[0].sigma, 10e-6, 15e-6, 30e-6);  // 95 % is k = 2
  EXPECT_EQ(file.points[1].name, "nominal 1");
  EXPECT_FALSE(file.points[1].sigma);
  EXPECT_FALSE(file.points[1].time);
  expectNear(file.points[2].point, 1.5, 2.0, 3.0);
}

TEST(SpatialAnalyzer, OneSigmaAndInches) {
  const PointFile file = read(
      "// Relative to 'A::WORLD'\n// 1.0 Sigma (68.3 %)\n// X, Y, Z (Inches), U-x, U-y, U-z, U-mag\n"
      "G,  P1,  10.0000,  20.0000,  30.0000,  0.0010,  0.0010,  0.0010,  0.0017,  01/02/31 10:00:00\n");
  expectNear(file.points[0].point, 0.254, 0.508, 0.762);
  EXPECT_EQ(file.points[0].group(), "G");
  EXPECT_EQ(file.points[0].collection(), "");
  EXPECT_NEAR((*file.points[0].sigma)[0], 25.4e-6, 1e-12);
}

TEST(SpatialAnalyzer, TargetsAloneRepeatOnceAPose) {
  const PointFile file = read(
      "1,  100.000001,  2.000000,  3.000000\n2,  4.000000,  5.000000,  6.000000\n1,  7.000000,  8.000000,  "
      "9.000000\n2,  1.000000,  1.500000,  2.000000\n");
  EXPECT_EQ(file.format, PointFormat::sa);
  ASSERT_EQ(file.points.size(), 4u);
  EXPECT_EQ(file.points[2].name, "1");
  EXPECT_EQ(file.points[2].occurrence, 2);
  ASSERT_EQ(file.warnings.size(), 2u);  // neither unit nor axes are stated
  expectSays(file.warnings[0], {"no unit", "millimetres"});
  expectSays(file.warnings[1], {"names the axes", "Cartesian"});
}

TEST(SpatialAnalyzer, NumericNamesAreNoCoordinates) {
  // Six cells: three names and x y z, not one name, x y z and two target offsets.
  const PointFile file = read("// 'A::B'\n// X, Y, Z (m)\n1,  2,  3,  4.500000,  5.500000,  6.500000\n");
  EXPECT_EQ(file.points[0].collection(), "1");
  expectNear(file.points[0].point, 4.5, 5.5, 6.5);
}

TEST(SpatialAnalyzer, TargetOffsetsAreNotUncertainties) {
  const PointFile file = read("// X, Y, Z (mm)\nA,  G,  P1,  1.000000,  2.000000,  3.000000,  0.000000,  19.050000\n");
  EXPECT_FALSE(file.points[0].sigma);
  ASSERT_EQ(file.warnings.size(), 1u);
  expectSays(file.warnings[0], {"target offsets"});
}

TEST(SpatialAnalyzer, ScientificNotation) {
  const PointFile file =
      read("// X, Y, Z (m)\nP1,  1.5000000000000000e+000,  -2.5000000000000000e-001,  0.0000000000000000e+000\n");
  expectNear(file.points[0].point, 1.5, -0.25, 0.0);
}

/// Rows of the writer: cells between a delimiter of its three.
std::string rowsOf(const std::vector<std::vector<std::string>>& rows, const std::string& delimiter) {
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) text += (i > 0 ? delimiter : "") + row[i];
    text += "\r\n";
  }
  return text;
}

TEST(SpatialAnalyzer, EveryDelimiterAndFormOfName) {
  const std::string header =
      "// Points Relative to Coordinate Frame 'A::BASE'\r\n// X, Y, Z (mm), U-x, U-y, U-z, U-mag\r\n// 68.3 %\r\n";
  for (const std::string delimiter : {",  ", "   ", "\t"}) {
    for (std::size_t names = 0; names <= 3; ++names) {
      std::vector<std::vector<std::string>> rows;
      for (int i = 1; i <= 3; ++i) {
        std::vector<std::string> row{"Day 1", "Main", "P" + std::to_string(i)};
        row.erase(row.begin(), row.end() - static_cast<std::ptrdiff_t>(names));
        for (const std::string cell : {"1500.125", "-20.500", "300.250", "0.020", "0.030", "0.060", "0.070"})
          row.push_back(cell);
        row.push_back("03/04/31 09:08:0" + std::to_string(i));
        rows.push_back(row);
      }
      const PointFile file = read(header + rowsOf(rows, delimiter));
      ASSERT_EQ(file.points.size(), 3u) << delimiter << names;
      EXPECT_EQ(file.points[1].name, names > 0 ? "P2" : "");
      EXPECT_EQ(file.points[1].group(), names > 1 ? "Main" : "");
      EXPECT_EQ(file.points[1].collection(), names > 2 ? "Day 1" : "");
      expectNear(file.points[1].point, 1.500125, -0.0205, 0.30025);
      expectNear(file.points[1].sigma.value(), 20e-6, 30e-6, 60e-6);
      EXPECT_EQ(isoTime(file.points[1].time.value()), "2031-03-04T09:08:02");
      EXPECT_TRUE(file.warnings.empty()) << file.warnings.front();
    }
  }
}

TEST(SpatialAnalyzer, WhatElseTheWriterPutsBehindXyzIsSaidAndNotRead) {
  // Offsets, tolerances and weights around the uncertainties; a comment, details and the time in any order.
  const std::vector<std::vector<std::string>> rows{
      {"A", "G", "P1", "1.000000", "2.000000", "3.000000", "0.000000", "19.050000", "0.500000", "0.020000", "0.030000",
       "0.060000", "0.070000", "1.000000", "03/04/31 09:08:07", "after lunch", "RMS 0.002"},
      {"A", "G", "P2", "4.000000", "5.000000", "6.000000", "0.000000", "19.050000", "0.500000", "0.010000", "0.020000",
       "0.020000", "0.030000", "1.000000", "03/04/31 09:08:09", "", "RMS 0.001"}};
  const PointFile file = read("// 'A::B'\n// X, Y, Z (mm)\n// 95 %\n" + rowsOf(rows, ",  "));
  ASSERT_EQ(file.points.size(), 2u);
  EXPECT_EQ(file.points[1].name, "P2");
  expectNear(file.points[1].point, 0.004, 0.005, 0.006);
  expectNear(file.points[1].sigma.value(), 5e-6, 10e-6, 10e-6);
  EXPECT_EQ(isoTime(file.points[1].time.value()), "2031-03-04T09:08:09");
  ASSERT_EQ(file.warnings.size(), 1u);
  expectSays(file.warnings[0], {":4", "no uncertainties are not read"});
  // A row that has such a cell where the others have none is torn.
  expectSays(refusal(kSa + "Run,  Main,  3,  1500.123456,  -20.500000,  300.250000,  03/34/31 09:08:07\n"),
             {":7", "as in the other rows"});
}

TEST(SpatialAnalyzer, CommentsOfOtherScripts) {
  const std::string rows = "G,  P1,  10.0000,  20.0000,  30.0000\n";
  // Full-width letters and brackets, ideographic commas, corner brackets.
  const PointFile japanese = read(
      "// \xE5\xBA\xA7\xE6\xA8\x99\xE7\xB3\xBB \xE3\x80\x8C"
      "A::\xE5\x8E\x9F\xE7\x82\xB9\xE3\x80\x8D\n"
      "// \xE8\xBB\xB8: \xEF\xBC\xB8\xE3\x80\x81\xEF\xBC\xB9\xE3\x80\x81\xEF\xBC\xBA"
      "\xEF\xBC\x88inch\xEF\xBC\x89\n" +
      rows);
  EXPECT_EQ(japanese.frame, "A::\xE5\x8E\x9F\xE7\x82\xB9");
  expectNear(japanese.points[0].point, 0.254, 0.508, 0.762);
  // The same frame in the Japanese code page, whose bytes are none of the Western one.
  const PointFile cp932 = read("// \x8D\xC0\x95\x57\x8C\x6E 'A::\x8C\xB4\x93\x5F'\n// X, Y, Z (mm)\n" + rows);
  EXPECT_EQ(cp932.encoding, interchange::Encoding::cp932);
  EXPECT_EQ(cp932.frame, "A::\xE5\x8E\x9F\xE7\x82\xB9");
  // French words and quotation marks in the Western code page, and as UTF-16.
  const std::string french =
      "// Points relatifs au rep\xE8re \xAB Cellule::MONDE \xBB\n// AXES : X, Y, Z (m\xE8tres)\n";
  EXPECT_EQ(read(french + rows).frame, "Cellule::MONDE");
  expectNear(read(french + rows).points[0].point, 10.0, 20.0, 30.0);
  std::string wide = "\xFF\xFE";
  for (const char c : french + rows) (wide += c) += '\0';  // of these characters the code page is the first of Unicode
  EXPECT_EQ(read(wide).encoding, interchange::Encoding::utf16_le);
  EXPECT_EQ(read(wide).frame, "Cellule::MONDE");
}

TEST(SpatialAnalyzer, AppendedExportsAgree) {
  EXPECT_EQ(read(kSa + kSa).points.size(), 6u);
  std::string other = kSa;
  other.replace(other.find("Cell::BASE"), 10, "Cell::PART");
  expectSays(refusal(kSa + other), {":8", "Cell::PART", "one frame", "Cell::BASE"});
  other = kSa;
  other.replace(other.find("(mm)"), 4, "(in)");
  expectSays(refusal(kSa + other), {":9", "'in'", "one unit"});
}

TEST(SpatialAnalyzer, RefusesPolarAxesUnknownUnitsAndTornRows) {
  expectSays(refusal("// AXES = POLAR: R, Theta, Z (mm, deg)\nP1,  1.0,  2.0,  3.0\n"), {":1", "Cartesian"});
  expectSays(refusal("// X, Y, Z (furlong)\nP1,  1.0,  2.0,  3.0\n"), {":1", "furlong", "expected mm, m or inch"});
  expectSays(refusal(kSa + "Run,  Main,  4,  1500.12"), {":7", "the file ends in the middle of this line"});
  expectSays(refusal("P1,  1.000000,  2.000000,  3.000000\nP1,  1.000000,  2.000000,  3.00"),
             {":2", "3.00", "ends in the middle"});
  expectSays(refusal(kSa + "Run,  Main,  4,  1500.123456,  zwei,  3.000000\n"), {":7", "zwei"});
}

TEST(SpatialAnalyzer, DecimalCommas) {
  const std::string text =
      "// X, Y, Z (mm)\nA   G   P1   1500,250000   -20,500000   3,000000\nA   G   P2   1500,250000   -20,500000   "
      "3,000000\n";
  expectSays(refusal(text), {":2", "decimal points", "decimal-comma"});
  FileOptions options;
  options.decimal_comma = true;
  expectNear(read(text, options).points[0].point, 1.50025, -0.0205, 0.003);
  expectSays(refusal(kSa, options), {"decimal"});
}

// Bytes of the Western code page: \xB5 is the micro sign, \xB0 the degree sign.
const std::string kLeica =
    "No,X [mm],Y [mm],Z [mm],U(95) X [\xB5m],U(95) Y [\xB5m],U(95) Z [\xB5m],Q0,Q1,Q2,Q3,Temperature [\xB0"
    "C],Target,Time\r\n"
    "1,1000.5,2000.25,-300.125,20,30.0,40,1,0,0,0,21.5,T-Mac,'11.10.2031 15:06:48.043\r\n"
    "2,0,0,0,0,0,0,1,0,0,0,21.5,T-Mac,'11.10.2031 15:06:49.043\r\n"
    "3,1001.5,2000.25,-300.125,20,30.0,40,1,0,0,0,21.5,T-Mac,'11.10.2031 15:06:50.143\r\n";

TEST(Leica, WesternCodePageExpandedUncertaintiesAndApostrophes) {
  const PointFile file = read(kLeica);
  EXPECT_EQ(file.format, PointFormat::leica);
  EXPECT_EQ(file.encoding, interchange::Encoding::cp1252);
  ASSERT_EQ(file.points.size(), 2u);
  expectNear(file.points[0].point, 1.0005, 2.00025, -0.300125);
  expectNear(*file.points[0].sigma, 10e-6, 15e-6, 20e-6);
  EXPECT_EQ(file.points[0].name, "T-Mac");
  EXPECT_EQ(isoTime(*file.points[0].time), "2031-10-11T15:06:48.043");  // the day stands first
  ASSERT_EQ(file.skipped.size(), 1u);
  EXPECT_EQ(file.skipped[0].line, 3u);
  EXPECT_EQ(file.skipped[0].reason, Skip::lost_beam);
}

TEST(Leica, RefusesWrongCells) {
  expectSays(refusal(kLeica + "4,1000.5,2000.25\r\n"), {":5", "3 cells", "expected 14 cells"});
  expectSays(refusal(kLeica + "4,1000.5,2000.25,x,20,30,40,1,0,0,0,21.5,T,'11.10.2031 15:06:48.043\r\n"),
             {":5", "column 4", "'x'"});
  expectSays(refusal(kLeica + "4,1,2,3,20,30,40,1,0,0,0,21.5,T,'31.11.2031 15:06:48.043\r\n"),
             {":5", "31.11.2031", "date"});
}

TEST(Encodings, ShownWantedAndMixed) {
  FileOptions utf8;
  utf8.encoding = interchange::Encoding::utf8;
  expectSays(refusal(kLeica, utf8), {":1", "0xB5", "expected UTF-8", "cp1252"});
  expectSays(refusal(kLeica + "4,1,2,3,2,3,4,1,0,0,0,2,Z\xC3\xA4hler,'11.10.2031 15:06:48.043\r\n"),
             {"one encoding", "line 5"});
  FileOptions western;
  western.encoding = interchange::Encoding::cp1252;
  expectSays(refusal("// f\xC3\xBCr 'A::B'\n// X, Y, Z (mm)\nP1,  1.0,  2.0,  3.0\n", western), {"cp1252", "utf-8"});
  EXPECT_EQ(read(kSa, western).points.size(), 3u);  // ASCII alone is both

  std::string wide = "\xFF\xFE";
  for (const char c : kSa) (wide += c) += '\0';
  EXPECT_EQ(read(wide).encoding, interchange::Encoding::utf16_le);
  EXPECT_EQ(read(wide).points.size(), 3u);
  EXPECT_EQ(read(wide.substr(2)).points.size(), 3u);
  expectSays(refusal(wide, western), {"cp1252", "utf-16le"});
  EXPECT_EQ(read("\xEF\xBB\xBF" + kSa).points.size(), 3u);
  expectSays(refusal("// 'A::B\x81'\nP1,  1.0,  2.0,  3.0\n"), {":1", "0x81"});
}

const std::string kOpenIndy = R"(<oiProjectData version="0.13" name="x">
 <stations><station id="1" name="S1"/></stations>
 <geometries><geometry id="2" name="P10" type="point"/></geometries>
 <observations>
  <observation id="3" isValid="1"><station ref="1"/>
   <reading id="4" time="2031-05-28T15:19:48" face="1" type="polar"><measurements>
    <measurement sigma="0.000001" value="1.5707963267948966" type="azimuth"/>
    <measurement sigma="0.000002" value="1.5707963267948966" type="zenith"/>
    <measurement sigma="0.00001" value="2" type="distance"/></measurements></reading>
   <measuredTargetGeometry ref="2"/></observation>
  <observation id="5" isValid="1"><station ref="1"/>
   <reading id="6" time="2031-05-28T15:20:48" face="2" type="polar"><measurements>
    <measurement sigma="0" value="4.7123889803846899" type="azimuth"/>
    <measurement sigma="0" value="4.7123889803846899" type="zenith"/>
    <measurement sigma="0" value="2" type="distance"/></measurements></reading>
   <measuredTargetGeometry ref="2"/></observation>
  <observation id="7" isValid="0"><station ref="1"/>
   <reading id="8" type="cartesian"><measurements>
    <measurement sigma="0" value="1" type="x"/><measurement sigma="0" value="2" type="y"/>
    <measurement sigma="0" value="3" type="z"/></measurements></reading>
   <measuredTargetGeometry ref="2"/></observation>
 </observations>
</oiProjectData>)";

TEST(OpenIndy, PolarReadingsOfBothFaces) {
  const PointFile file = read(kOpenIndy);
  EXPECT_EQ(file.format, PointFormat::openindy);
  EXPECT_EQ(file.frame, "S1");
  ASSERT_EQ(file.points.size(), 2u);
  expectNear(file.points[0].point, 0.0, 2.0, 0.0);
  // Across by azimuth in x and by zenith in z, along in y.
  expectNear(*file.points[0].sigma, 2e-6, 10e-6, 4e-6);
  EXPECT_LT((file.points[1].point - file.points[0].point).norm(), kExact);  // the second face turns both
  EXPECT_FALSE(file.points[1].sigma);
  EXPECT_EQ(file.points[1].name, "P10");
  EXPECT_EQ(file.points[1].occurrence, 2);
  EXPECT_EQ(isoTime(*file.points[0].time), "2031-05-28T15:19:48");
  ASSERT_EQ(file.skipped.size(), 1u);
  EXPECT_EQ(file.skipped[0].reason, Skip::marked_invalid);
}

TEST(OpenIndy, RefusesWhatIsTorn) {
  expectSays(refusal(kOpenIndy.substr(0, 700)), {"day.txt"});
  std::string lost = kOpenIndy;
  lost.replace(lost.find("<measuredTargetGeometry ref=\"2\""), 31, "<measuredTargetGeometry ref=\"9\"");
  expectSays(refusal(lost), {"ref", "'9'"});
}

TEST(SemicolonXyz, RowsAndRefusals) {
  const PointFile file = read("P1;-1.500;2.250;3.000;;;;\r\nP2;4.0;5.0;6.0;;;;\r\nP3;0;0;0;;;;\r\n");
  EXPECT_EQ(file.format, PointFormat::xyz);
  ASSERT_EQ(file.points.size(), 2u);
  expectNear(file.points[0].point, -1.5e-3, 2.25e-3, 3e-3);
  EXPECT_EQ(file.skipped[0].reason, Skip::lost_beam);
  FileOptions wanted;
  wanted.format = PointFormat::xyz;
  expectSays(refusal("P1;-1,500;2,250;3,000;;;;\r\n", wanted), {":1", "x", "-1,500", "decimal-comma"});
  expectSays(refusal("P1;1.0;2.0;3.0;;;;\r\nP2;1.0;2.0", wanted), {":2", "ends in the middle"});
}

TEST(SemicolonXyz, OneWrongCellIsSaidOfItsLine) {
  const std::string rows = "P1;100.5;200.5;300.5;;;;\nP2;1.5;2.1;3.0;;;;\n";
  expectSays(refusal(rows + "P3;1.5;2,1;3.0;;;;\n"), {"day.txt:3", "y", "'2,1'", "decimal-comma"});
  expectSays(refusal(rows + ";1.5;2.1;3.0;;;;\n"), {"day.txt:3", "NAME;x;y;z"});
  expectSays(refusal("P1;100.5;200.5;300.5;;;;\nP2;1.5;2.1;;;;;\n"), {"day.txt:2", "z"});
  expectSays(refusal("P1;1,5;2,1;3,0\nP2;1,5;2,1;3,0\n"), {"day.txt:1", "x", "'1,5'", "decimal-comma"});
  // A header line is of another table.
  expectSays(refusal("Name;X;Y;Z\nP1;1.5;2.1;3.0\n"), {"day.txt:1", "Name;X;Y;Z", "option columns"});
}

TEST(Columns, NamedByTheUser) {
  FileOptions options;
  options.columns = "time q1_rad - x_mm y_mm z_mm";
  options.separator = ";";
  options.decimal_comma = true;
  options.skip = 1;
  options.target = "P10";
  const PointFile file =
      read("Stamp;Joint;?;X;Y;Z\n20310714163904;0,5;a;2361,9831;-1368,5474;119,39713\n20310714163924;0,5;b;0;0;0,0\n",
           options);
  EXPECT_EQ(file.format, PointFormat::columns);
  ASSERT_EQ(file.points.size(), 1u);
  expectNear(file.points[0].point, 2.3619831, -1.3685474, 0.11939713);
  EXPECT_EQ(file.points[0].name, "P10");
  EXPECT_EQ(isoTime(*file.points[0].time), "2031-07-14T16:39:04");
  EXPECT_EQ(file.skipped[0].line, 3u);
  expectSays(refusal("h\n2,02011E+13;0,5;a;1,0;2,0;3,0\n", options), {":2", "2,02011E+13", "spreadsheet"});
  options.decimal_comma = false;
  expectSays(refusal("h\n20310714163904;0.5;a;2361,9831;-1368,5474;119,39713\n", options), {":2", "x_mm", "2361,9831"});
  options.columns = "x_mm y_mm zz";
  expectSays(refusal("h\n1;2;3\n", options), {"zz", "expected a column"});
}

TEST(Columns, NamedByTheFile) {
  const PointFile file = read("target,x_m,y_m,z_m,ux_um,uy_um,uz_um,time_s\nP10,1,2,3,10,20,30,4.25\n");
  EXPECT_EQ(file.format, PointFormat::columns);
  expectNear(*file.points[0].sigma, 10e-6, 20e-6, 30e-6);
  EXPECT_FALSE(file.points[0].time->dated);
  EXPECT_DOUBLE_EQ(file.points[0].time->seconds, 4.25);
}

TEST(SpatialAnalyzer, AUnitThatStandsElsewhereOrIsContradictedIsRefused) {
  const std::string text = "// Units: Inches\n// 'A::B'\nP1,  1.000000,  2.000000,  3.000000\n";
  expectSays(refusal(text), {"inches", "option unit"});
  FileOptions inch;
  inch.unit = "in";
  expectNear(read(text, inch).points[0].point, 0.0254, 0.0508, 0.0762);
  expectSays(refusal(kSa, inch), {"unit", "'in'", "state another"});
  expectSays(refusal(kLeica, inch), {"unit", "leica"});
  FileOptions semicolon;
  semicolon.separator = ";";
  expectSays(refusal(kSa, semicolon), {"separator", "sa"});
}

TEST(SpatialAnalyzer, ATimeWithoutItsDateIsSaid) {
  const PointFile file = read("// X, Y, Z (mm)\nP1,  1.000000,  2.000000,  3.000000,  10:11:12\n");
  EXPECT_FALSE(file.points[0].time);
  ASSERT_EQ(file.warnings.size(), 1u);
  expectSays(file.warnings[0], {":2", "without its date"});
}

TEST(SpatialAnalyzer, TheOriginIsAPoint) {
  EXPECT_EQ(read("// X, Y, Z (mm)\nG,  O,  0.000000,  0.000000,  0.000000\n").points.size(), 1u);
}

TEST(Columns, ALostBeamKeepsItsOccurrence) {
  FileOptions options;
  options.columns = "target x_mm y_mm z_mm";
  const PointFile file = read("P1,1,2,3\nP1,0,0,0\nP1,4,5,6\n", options);
  ASSERT_EQ(file.points.size(), 2u);
  EXPECT_EQ(file.points[1].occurrence, 3);
  ASSERT_EQ(file.lost.size(), 1u);
  EXPECT_EQ(file.lost[0].occurrence, 2);
}

TEST(Columns, PartOfTheUncertaintiesAndNegativeOnesAreRefused) {
  expectSays(refusal("target,x_m,y_m,z_m,ux_um\nP10,1,2,3,10\n"), {"columns", "uy", "all or none"});
  expectSays(refusal("target,x_m,y_m,z_m,ux_um,uy_um,uz_um\nP10,1,2,3,10,-1,10\n"), {":2", "not below zero"});
}

TEST(Columns, WhatTheHeaderNamesAndNobodyReadsIsSaid) {
  const PointFile file = read("target,x_m,y_m,z_m,u_x_um\nP10,1,2,3,10\n");
  ASSERT_EQ(file.warnings.size(), 1u);
  expectSays(file.warnings[0], {":1", "not read", "u_x_um"});
}

TEST(Recognition, RefusesALineThatNoTableHas) {
  const std::string cells = "a,  1.0,  2.0,  3.0\n" + std::string((1 << 20) + 1, ';') + "\n";
  expectSays(refusal(cells), {":2", "at most 1048576 bytes", "1048577"});
}

TEST(Recognition, RefusesTheWrongAndTheAmbiguous) {
  FileOptions leica;
  leica.format = PointFormat::leica;
  expectSays(refusal(kSa, leica), {"leica", "expected sa", "// SpatialAnalyzer"});
  expectSays(refusal("P1 1.0 2.0 3.0\nP2 1.0 2.0 3.0\n"), {"it may be sa or columns"});
  expectSays(refusal("hello\nworld\n"), {"hello", "sa, leica, openindy, xyz, columns"});
  FileOptions sa;
  sa.format = PointFormat::sa;
  EXPECT_EQ(read("P1 1.0 2.0 3.0\n", sa).points.size(), 1u);
  expectSays(refusal("P1,  1e9,  2e9,  3e9\n", sa), {":1", "within 200 m"});
}

}  // namespace point_file_test
}  // namespace stiffscope
