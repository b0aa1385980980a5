#include <gtest/gtest.h>

#include <algorithm>

#include "core/interchange/point_file.h"
#include "tests/core/interchange/refusal.h"

// Times of day and comments of the export. Small files; none is a part of a published one.

namespace stiffscope {
namespace spatial_analyzer_test {

using namespace interchange;
using interchange_test::expectSays;

PointFile read(const std::string& text) { return parsePointFile("day.txt", text, {}); }

/// The export of one row with `time` behind x y z, between `separator`.
PointFile timed(const std::string& separator, const std::vector<std::string>& time) {
  std::string text = "// X, Y, Z (mm)\nMain";
  for (const char* cell : {"P10", "2296.337", "-2416.231", "1000.123"}) text += separator + cell;
  for (const std::string& cell : time) text += separator + cell;
  return read(text + "\n");
}

TEST(SpatialAnalyzerTimes, HalvesOfTheDayMayStandInACellOfTheirOwn) {
  for (const std::string separator : {"   ", ",  ", "\t"}) {
    for (const std::vector<std::string>& cells : {std::vector<std::string>{"02/12/2025", "08:00:02", "PM"},
                                                  {"02/12/2025", "8:00:02 pm"},
                                                  {"02/12/2025 08:00:02", "PM"},
                                                  {"02/12/2025 8:00:02 PM"}}) {
      SCOPED_TRACE(separator + cells.back());
      const PointFile file = timed(separator, cells);
      ASSERT_TRUE(file.points[0].time);
      EXPECT_EQ(isoTime(*file.points[0].time), "2025-02-12T20:00:02");
      EXPECT_TRUE(file.warnings.empty()) << file.warnings.front();
    }
  }
  EXPECT_EQ(isoTime(timed("   ", {"02/12/2025", "12:00:02", "AM"}).points[0].time.value()), "2025-02-12T00:00:02");
  // One blank apart, the names are told by the decimals.
  EXPECT_EQ(isoTime(read("// X, Y, Z (mm)\nMain P10 2296.337 -2416.231 1000.123 02/12/2025 08:00:02 PM\n")
                        .points[0]
                        .time.value()),
            "2025-02-12T20:00:02");
}

TEST(SpatialAnalyzerTimes, ALoneHalfOfTheDayGoesWithItsTime) {
  for (const std::vector<std::string>& cells : {std::vector<std::string>{"08:00:02", "PM"}, {"8:00:02 PM"}}) {
    const PointFile file = timed(",  ", cells);
    EXPECT_FALSE(file.points[0].time);
    ASSERT_EQ(file.warnings.size(), 1u);
    expectSays(file.warnings[0], {":2", "without its date"});
  }
}

TEST(SpatialAnalyzerTimes, WhatIsNoTimeThatCanBeReadIsSaid) {
  const auto says = [](const PointFile& file, const std::string& cell) {
    return std::any_of(file.warnings.begin(), file.warnings.end(), [&](const std::string& warning) {
      return warning.find(":2") != std::string::npos && warning.find("'" + cell + "'") != std::string::npos &&
             warning.find("no time that can be read") != std::string::npos &&
             warning.find("month first") != std::string::npos;
    });
  };
  for (const std::string separator : {"   ", ",  "}) {
    EXPECT_TRUE(says(timed(separator, {"31/12/2025 08:00:02"}), "31/12/2025 08:00:02"));
    EXPECT_TRUE(says(timed(separator, {"31/12/2025", "08:00:02"}), "31/12/2025 08:00:02"));
    EXPECT_TRUE(says(timed(separator, {"02/12/2025 25:00:02"}), "02/12/2025 25:00:02"));
    EXPECT_FALSE(timed(separator, {"31/12/2025", "08:00:02"}).points[0].time);
  }
  // Colons of a comment beside a time are none of a time.
  EXPECT_EQ(timed(",  ", {"02/12/2025 08:00:02", "1:2"}).warnings.size(), 1u);
}

const std::string kSigmaRow = "P1,  10.0000,  20.0000,  30.0000,  0.0200,  0.0300,  0.0600,  0.0700\n";

double sigmaOf(const std::string& comment) {
  return read(comment + "\n// X, Y, Z (mm), U-x, U-y, U-z, U-mag\n" + kSigmaRow).points[0].sigma.value()[0];
}

bool statesCoverage(const std::string& comment) {
  const PointFile file = read(comment + "\n// X, Y, Z (mm), U-x, U-y, U-z, U-mag\n" + kSigmaRow);
  return std::none_of(file.warnings.begin(), file.warnings.end(), [](const std::string& warning) {
    return warning.find("coverage is not stated") != std::string::npos;
  });
}

TEST(ExportComments, OnlyWhatIsAboutUncertaintiesStatesTheirCoverage) {
  for (const char* other : {"// Humidity 95 %", "// Battery 68 %", "// Luftfeuchte: 95,0 %", "// 95 % of 20 readings",
                            "// Outliers beyond 3 sigma are left out"}) {
    EXPECT_NEAR(sigmaOf(other), 20e-6, 1e-12) << other;
    EXPECT_FALSE(statesCoverage(other)) << other;
  }
  for (const char* stated :
       {"// 95 %", "// 2 sigma", "// Uncertainty 95.0 % Confidence", "// Unsicherheiten 95,0 % Vertrauensbereich",
        "// Incertitudes : intervalle de confiance de 95 %", "// Incertidumbre 95 %", "// 2.0 Sigma (95.4 %)",
        "// \xE4\xB8\x8D\xE7\xA2\xBA\xE3\x81\x8B\xE3\x81\x95 95%", "// U-x, U-y, U-z, U-mag: 95 %"}) {
    EXPECT_NEAR(sigmaOf(stated), 10e-6, 1e-12) << stated;
    EXPECT_TRUE(statesCoverage(stated)) << stated;
  }
  // Of two levels in one comment it is not known which is meant.
  EXPECT_FALSE(statesCoverage("// Humidity 95 %, uncertainty of it 2 %"));
}

TEST(ExportComments, OnlyAxesArePolar) {
  for (const char* other :
       {"// Temperature 20 (deg C)",
        "// Temperature [\xC2\xB0"
        "C] 20.5",
        "// Tilt 0.01 (deg)", "// Turned about Z by 90 (deg)", "// Target radius (mm) 19.05, grade [A]"})
    EXPECT_EQ(read(std::string(other) + "\n// X, Y, Z (mm)\nP1,  1.0,  2.0,  3.0\n").points.size(), 1u) << other;
  for (const char* polar :
       {"// AXES = POLAR: R, Theta, Z (mm, deg)", "// R (mm), Theta (deg), Phi (deg)",
        "// ACHSEN = KUGEL: R, Theta, Phi (Meter, Grad)", "// Az, El, D (rad)", "// \xE8\xBB\xB8 (mm, \xE5\xBA\xA6)",
        "// Hz, V (gon), D (m)", "// X, Y, Z (mm), turned (deg)"})
    expectSays(interchange_test::refusalOf([&] { read(std::string(polar) + "\nP1,  1.0,  2.0,  3.0\n"); }),
               {":1", "Cartesian"});
}

TEST(ExportComments, CoordinatesAreInTheOrderOfTheAxes) {
  const std::string rows = "G, P1, 100.000, 200.000, 300.000\n";
  const auto expectPoint = [&](const std::string& comment, double x, double y, double z) {
    EXPECT_LT((1e3 * read("// 'A::B'\n" + comment + "\n" + rows).points.at(0).point - Eigen::Vector3d(x, y, z)).norm(),
              1e-9)
        << comment;
  };
  expectPoint("// Group, Point, X [mm], Y [mm], Z [mm]", 100, 200, 300);
  expectPoint("// Group, Point, Y [mm], X [mm], Z [mm]", 200, 100, 300);
  expectPoint("// Group, Point, Z [mm], Y [mm], X [mm]", 300, 200, 100);
  expectPoint("// y in mm, z in mm, x in mm (mm)", 300, 100, 200);
  expectPoint("// ACHSEN: Z  X  Y  (Millimeter)", 200, 300, 100);
  // Small letters are words: y in Spanish, z in Polish.
  expectPoint("// Ejes y puntos: X, Y y Z (mm)", 100, 200, 300);
  expectPoint("// Punkty z osi: X, Y, Z (mm)", 100, 200, 300);
  // A comment of something else says nothing of the columns.
  expectPoint("// X, Y, Z (mm)\n// Z is up, X to the front, Y to the left", 100, 200, 300);
  // What is no list, or has a sign, is not guessed.
  for (const char* comment : {"// Group, Point, -X [mm], Y [mm], Z [mm]", "// Y value [mm], X value [mm], Z value [mm]",
                              "// X, Y, Z (mm)\n"
                              "// Y, X, Z (mm)"})
    EXPECT_NE(interchange_test::refusalOf([&] {
                read("// 'A::B'\n" + std::string(comment) + "\n" + rows);
              }).find("expected the axes"),
              std::string::npos)
        << comment;
}

TEST(ExportComments, UncertaintiesAreInTheOrderOfTheirLabels) {
  const std::string row = "G, P1, 100.000, 200.000, 300.000, 0.0200, 0.0300, 0.0600, 0.0700\n";
  const auto sigmas = [&](const std::string& comment) {
    return Eigen::Vector3d(1e6 * read("// 1 sigma\n" + comment + "\n" + row).points.at(0).sigma.value());
  };
  const auto near = [](const Eigen::Vector3d& found, double x, double y, double z) {
    return (found - Eigen::Vector3d(x, y, z)).norm() < 1e-9;
  };
  EXPECT_TRUE(near(sigmas("// X, Y, Z (mm), U-x, U-y, U-z, U-mag"), 20, 30, 60));
  EXPECT_TRUE(near(sigmas("// Y, X, Z (mm), U-y, U-x, U-z, U-mag"), 30, 20, 60));
  EXPECT_TRUE(near(sigmas("// Y, X, Z (mm), U-x, U-y, U-z, U-mag"), 20, 30, 60));
  EXPECT_TRUE(near(sigmas("// Z, Y, X (mm)"), 60, 30, 20));
}

TEST(ExportComments, CoverageMayStandInBracketsWithTheAxes) {
  const std::string row = "G, P1, 100.000, 200.000, 300.000, 0.020, 0.030, 0.060, 0.070\n";
  const auto sigma = [&](const std::string& columns) {
    return 1e6 * (*read("// Group, Point, X [mm], Y [mm], Z [mm], " + columns + "\n" + row).points.at(0).sigma)[0];
  };
  EXPECT_NEAR(sigma("U-x, U-y, U-z, U-mag (95%)"), 10.0, 1e-9);
  EXPECT_NEAR(sigma("U-x [mm], U-y [mm], U-z [mm], U-mag [mm] (2 sigma)"), 10.0, 1e-9);
  EXPECT_NEAR(sigma("U-x, U-y, U-z, U-mag [mm, 95 %]"), 10.0, 1e-9);
  EXPECT_NEAR(sigma("U-x, U-y, U-z, U-mag (95.0 % Confidence)"), 10.0, 1e-9);
  EXPECT_NEAR(sigma("U-x, U-y, U-z, U-mag (1 sigma)"), 20.0, 1e-9);
  EXPECT_NE(interchange_test::refusalOf([&] { sigma("U-x, U-y, U-z, U-mag (furlong)"); }).find("'furlong'"),
            std::string::npos);
}

}  // namespace spatial_analyzer_test
}  // namespace stiffscope
