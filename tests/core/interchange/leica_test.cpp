#include <gtest/gtest.h>

#include "core/interchange/point_file.h"
#include "tests/core/interchange/refusal.h"

// Which of a table's columns are the coordinates. Small tables; none is a part of a published one.

namespace stiffscope {
namespace leica_test {

using namespace interchange;
using interchange_test::expectSays;

PointFile read(const std::string& text, const FileOptions& options = {}) {
  return parsePointFile("day.csv", text, options);
}

std::string refusal(const std::string& text, const FileOptions& options = {}) {
  return interchange_test::refusalOf([&] { read(text, options); });
}

const std::string kExpanded = ";U(95) X [mm];U(95) Y [mm];U(95) Z [mm]\n";
const std::string kRow = "P10;1000.0;2000.0;300.0;1001.5;2002.5;303.5;0.01;0.01;0.02\n";

void expectMeasured(const std::string& header) {
  const PointFile file = read(header + kExpanded + kRow);
  EXPECT_EQ(file.format, PointFormat::leica) << header;
  ASSERT_EQ(file.points.size(), 1u) << header;
  EXPECT_LT((file.points[0].point - Eigen::Vector3d(1.0015, 2.0025, 0.3035)).norm(), 1e-15) << header;
  EXPECT_NEAR(file.points[0].sigma.value()[2], 10e-6, 1e-12) << header;
}

TEST(LeicaColumns, NominalValuesAreNoCoordinates) {
  expectMeasured("Name;Nominal X [mm];Nominal Y [mm];Nominal Z [mm];X [mm];Y [mm];Z [mm]");
  expectMeasured("Name;Soll X [mm];Soll Y [mm];Soll Z [mm];Ist X [mm];Ist Y [mm];Ist Z [mm]");
  expectMeasured("Name;X ref. [mm];Y ref. [mm];Z ref. [mm];X meas. [mm];Y meas. [mm];Z meas. [mm]");
  expectMeasured("Name;Delta X [mm];Delta Y [mm];Delta Z [mm];X [mm];Y [mm];Z [mm]");
  expectMeasured("Name;Deviation X [mm];Deviation Y [mm];Deviation Z [mm];X [mm];Y [mm];Z [mm]");
  expectMeasured("Name;\xCE\x94 X [mm];\xCE\x94 Y [mm];\xCE\x94 Z [mm];X [mm];Y [mm];Z [mm]");
}

TEST(LeicaColumns, ADeviationIsNoStandardDeviation) {
  const std::string coordinates = "Q0;X [mm];Y [mm];Z [mm];";
  const std::string row = "1;1;2;3;0.25;0.25;0.5\n";
  EXPECT_FALSE(read(coordinates + "Deviation X [mm];Deviation Y [mm];Deviation Z [mm]\n" + row).points[0].sigma);
  const PointFile file = read(coordinates + "Std Deviation X [mm];Std Deviation Y [mm];Std Deviation Z [mm]\n" + row);
  EXPECT_NEAR(file.points[0].sigma.value()[2], 0.5e-3, 1e-12);
}

TEST(LeicaColumns, TwoThatMayBeOneCoordinateAreRefused) {
  expectSays(refusal("Name;X [mm];Y [mm];Z [mm];Actual X [mm];Actual Y [mm];Actual Z [mm]" + kExpanded + kRow),
             {"day.csv:1", "'Actual X [mm]'", "'X [mm]'", "columns"});
  expectSays(refusal("Name;X [mm];Y [mm];Z [mm];U(95) X [mm];U(95) Y [mm];U(95) Z [mm]" + kExpanded + kRow),
             {"day.csv:1", "'U(95) X [mm]'"});
}

TEST(LeicaColumns, WhatIsNotReadIsSaid) {
  const PointFile file = read(
      "No;X [mm];Y [mm];Z [mm];Q0;U(95) X [mm];U(95) Y [mm];U(95) Z [mm];Nominal X [mm];Target;Name;\n"
      "1;1;2;3;1;0.01;0.01;0.02;1;SMR;P10;\n");
  EXPECT_EQ(file.points[0].name, "P10");
  ASSERT_EQ(file.warnings.size(), 1u);
  expectSays(file.warnings[0], {"day.csv:1", "columns that are not read: No, Q0, Nominal X [mm], Target"});
  const PointFile whole = read("Name;X [mm];Y [mm];Z [mm]" + kExpanded + "P10;1;2;3;0.01;0.01;0.02\n");
  EXPECT_TRUE(whole.warnings.empty());
  // Uncertainties of which one is missing are not read, either.
  const PointFile part = read("Name;X [mm];Y [mm];Z [mm];Q0;U(95) X [mm]\nP10;1;2;3;1;0.01\n");
  ASSERT_EQ(part.warnings.size(), 1u);
  expectSays(part.warnings[0], {"not read: Q0, U(95) X [mm]"});
}

TEST(PointFileOptions, ThatAFormatHasNoUseForAreRefused) {
  const std::string leica = "Name;X [mm];Y [mm];Z [mm]" + kExpanded + "P9;1;2;3;0.01;0.01;0.02\nP10;1;2;3;0;0;0\n";
  FileOptions skip;
  skip.skip = 2;
  expectSays(refusal(leica, skip), {"day.csv", "skip", "'2'", "leica"});
  const std::string openindy =
      "<oiProjectData version=\"0.13\" name=\"x\"><stations><station id=\"1\" name=\"S1\"/></stations><geometries>"
      "<geometry id=\"2\" name=\"P10\" type=\"point\"/></geometries><observations><observation id=\"3\" "
      "isValid=\"1\"><station ref=\"1\"/><reading id=\"4\" type=\"cartesian\"><measurements><measurement sigma=\"0\" "
      "value=\"1\" type=\"x\"/><measurement sigma=\"0\" value=\"2\" type=\"y\"/><measurement sigma=\"0\" value=\"3\" "
      "type=\"z\"/></measurements></reading><measuredTargetGeometry ref=\"2\"/></observation></observations>"
      "</oiProjectData>";
  ASSERT_EQ(read(openindy).points.size(), 1u);
  expectSays(refusal(openindy, skip), {"skip", "'2'", "openindy"});
  FileOptions comma;
  comma.decimal_comma = true;
  expectSays(refusal(openindy, comma), {"decimal_comma", "openindy"});
  FileOptions columns;
  columns.columns = "target x_mm y_mm z_mm";
  expectSays(refusal(openindy, columns), {"columns", "openindy"});
  // Numbers of this format may have commas.
  EXPECT_EQ(read("Name;X [mm];Y [mm];Z [mm]" + kExpanded + "P10;1,5;2;3;0,01;0,01;0,02\n", comma).points[0].point.x(),
            1.5e-3);
}

}  // namespace leica_test
}  // namespace stiffscope
