#include <gtest/gtest.h>

#include <fmt/format.h>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <regex>
#include <set>
#include <sstream>

#include "core/interchange/point_file.h"
#include "core/interchange/robot_log.h"
#include "tests/core/interchange/refusal.h"

// Published exports, which are not part of this repository: folders OWNER/NAME as the public repositories have them, in
// STIFFSCOPE_PUBLIC_EXAMPLES or beside the checkout in public-examples. Each is read again here by a few lines of its
// own, which know that one file and nothing of the formats.

namespace stiffscope {
namespace public_examples_test {

namespace fs = std::filesystem;
using namespace interchange;

fs::path examples() {
  const char* const named = std::getenv("STIFFSCOPE_PUBLIC_EXAMPLES");
  return named != nullptr ? fs::path(named) : fs::path(STIFFSCOPE_SOURCE_DIR "/../public-examples");
}

/// Files of a folder with an extension, in order; empty where it is not there.
std::vector<fs::path> filesIn(const std::string& folder, const std::string& extension) {
  std::vector<fs::path> files;
  std::error_code none;
  for (const auto& entry : fs::recursive_directory_iterator(examples() / folder, none)) {
    if (entry.path().extension() == extension) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

#define SKIP_WITHOUT(files) \
  if ((files).empty()) GTEST_SKIP() << "no such published export in " << examples()

std::vector<std::string> linesOfFile(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) {
    while (!line.empty() && (line.back() == '\r' || line.back() == '\0')) line.pop_back();
    lines.push_back(line);
  }
  return lines;
}

std::vector<std::string> split(const std::string& line, char separator) {
  std::vector<std::string> cells;
  std::istringstream text(line);
  for (std::string cell; std::getline(text, cell, separator);) {
    const std::size_t from = cell.find_first_not_of(" \t"), to = cell.find_last_not_of(" \t");
    cells.push_back(from == std::string::npos ? "" : cell.substr(from, to - from + 1));
  }
  return cells;
}

double withComma(std::string cell) {
  std::replace(cell.begin(), cell.end(), ',', '.');
  return std::strtod(cell.c_str(), nullptr);
}

// Decimals of a file to the last digit of a double; a unit multiplies them once.
constexpr double kExact = 1e-15;

TEST(PublicExamples, SpatialAnalyzersExports) {
  const auto files = filesIn("20korvin01/IVR_Ue3/data/tracker", ".txt");
  SKIP_WITHOUT(files);
  for (const fs::path& file : files) {
    const PointFile read = readPointFile(file);
    EXPECT_EQ(read.format, PointFormat::sa) << file;
    const bool header = linesOfFile(file).front().starts_with("//");
    EXPECT_EQ(read.frame, header ? "A::WORLD" : "") << file;
    std::size_t at = 0, number = 0;
    for (const std::string& line : linesOfFile(file)) {
      ++number;
      if (line.empty() || line.starts_with("//")) continue;
      const std::vector<std::string> cells = split(line, ',');
      ASSERT_LT(at, read.points.size()) << file;
      const PointReading& point = read.points[at++];
      const std::size_t names = header ? 3 : 1;
      EXPECT_EQ(point.line, number);
      EXPECT_EQ(point.name, cells[names - 1]);
      if (header) {
        EXPECT_EQ(point.collection(), cells[0]);
        EXPECT_EQ(point.group(), cells[1]);
      }
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(point.point[static_cast<Eigen::Index>(k)], 1e-3 * std::strtod(cells[names + k].c_str(), nullptr),
                    kExact);
      EXPECT_FALSE(point.sigma);
      ASSERT_EQ(point.time.has_value(), header);
      if (!header) continue;
      // "02/12/25 16:38:29": the twelfth of February.
      const std::string& time = cells[6];
      EXPECT_EQ(isoTime(*point.time),
                fmt::format("20{}-{}-{}T{}", time.substr(6, 2), time.substr(0, 2), time.substr(3, 2), time.substr(9)));
    }
    EXPECT_EQ(at, read.points.size()) << file;
    // Without a header three names repeat, ten times each.
    if (!header) {
      ASSERT_EQ(read.points.size(), 30u);
      EXPECT_EQ(read.points.back().occurrence, 10);
    }
  }
}

TEST(PublicExamples, OpenIndysProject) {
  const auto files = filesIn("OpenIndy/OpenIndy/res-rt/example", ".xml");
  SKIP_WITHOUT(files);
  std::ifstream in(files.front());
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  const PointFile read = readPointFile(files.front());
  EXPECT_EQ(read.format, PointFormat::openindy);
  std::size_t at = 0;
  const std::regex reading("<reading [^>]*>"), measurement("<measurement [^>]*>");
  for (auto one = std::sregex_iterator(text.begin(), text.end(), reading); one != std::sregex_iterator(); ++one) {
    const std::size_t from = static_cast<std::size_t>(one->position()), to = text.find("</reading>", from);
    const std::string body = text.substr(from, to - from);
    const auto valueOf = [&](const std::string& type, const std::string& attribute) {
      for (auto m = std::sregex_iterator(body.begin(), body.end(), measurement); m != std::sregex_iterator(); ++m) {
        const std::string element = m->str();
        if (element.find("type=\"" + type + "\"") == std::string::npos) continue;
        const std::size_t value = element.find(attribute + "=\"") + attribute.size() + 2;
        return std::strtod(element.c_str() + value, nullptr);
      }
      return std::nan("");
    };
    const double azimuth = valueOf("azimuth", "value"), zenith = valueOf("zenith", "value"),
                 distance = valueOf("distance", "value");
    if (std::isnan(azimuth)) continue;
    ASSERT_LT(at, read.points.size());
    const PointReading& point = read.points[at++];
    const Eigen::Vector3d expected(distance * std::sin(zenith) * std::cos(azimuth),
                                   distance * std::sin(zenith) * std::sin(azimuth), distance * std::cos(zenith));
    EXPECT_LT((point.point - expected).norm(), 1e-14 * distance);
    EXPECT_FALSE(point.name.empty());
    // Along and across the beam, whatever the axes: the sum of variances is that of distance and both arcs.
    const double along = valueOf("distance", "sigma"), by_azimuth = valueOf("azimuth", "sigma"),
                 by_zenith = valueOf("zenith", "sigma");
    const double sum =
        along * along + std::pow(distance * by_zenith, 2) + std::pow(distance * std::sin(zenith) * by_azimuth, 2);
    if (sum > 0.0)
      EXPECT_NEAR(point.sigma.value().squaredNorm(), sum, 1e-12 * sum);
    else
      EXPECT_FALSE(point.sigma);
    const std::string element = one->str();
    const std::size_t time = element.find("time=\"");
    if (time != std::string::npos) EXPECT_EQ(isoTime(point.time.value()).substr(0, 19), element.substr(time + 6, 19));
  }
  EXPECT_GE(at, 30u);
  EXPECT_EQ(at, read.points.size());
}

TEST(PublicExamples, Semicolons) {
  const auto files = filesIn("RABKKK/LaserTrackerPoseData4KinIdent", ".xyz");
  SKIP_WITHOUT(files);
  for (const fs::path& file : files) {
    const PointFile read = readPointFile(file);
    EXPECT_EQ(read.format, PointFormat::xyz) << file;
    std::size_t at = 0;
    for (const std::string& line : linesOfFile(file)) {
      if (line.empty()) continue;
      const std::vector<std::string> cells = split(line, ';');
      ASSERT_LT(at, read.points.size()) << file;
      EXPECT_EQ(read.points[at].name, cells[0]);
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(read.points[at].point[static_cast<Eigen::Index>(k)],
                    1e-3 * std::strtod(cells[k + 1].c_str(), nullptr), kExact);
      ++at;
    }
    EXPECT_EQ(at, read.points.size()) << file;
  }
}

TEST(PublicExamples, SemicolonsAndDecimalCommas) {
  const auto files = filesIn("christianlandgraf/ipa-robot-accuracy", ".csv");
  SKIP_WITHOUT(files);
  for (const fs::path& file : files) {
    if (!file.filename().string().starts_with("measurements")) continue;
    const std::vector<std::string> lines = linesOfFile(file), names = split(lines.front(), ';');
    FileOptions options;
    options.decimal_comma = true;
    options.skip = 1;
    options.target = "T-Mac";
    const bool scatter = std::find(names.begin(), names.end(), "measurement_std_x") != names.end();
    for (const std::string& name : names) {
      std::string column = "-";
      for (const std::string axis : {"x", "y", "z"}) {
        if (name == "measurement_" + axis) column = axis + "_mm";
        if (name == "measurement_std_" + axis) column = "u" + axis + "_mm";
      }
      options.columns += (options.columns.empty() ? "" : " ") + column;
    }
    const PointFile read = readPointFile(file, options);
    std::size_t at = 0, lost = 0;
    const auto place = [&](const std::string& name) {
      return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    };
    for (std::size_t i = 1; i < lines.size(); ++i) {
      if (lines[i].empty()) continue;
      const std::vector<std::string> cells = split(lines[i], ';');
      const Eigen::Vector3d point(withComma(cells[place("measurement_x")]), withComma(cells[place("measurement_y")]),
                                  withComma(cells[place("measurement_z")]));
      if (point.isZero(0.0)) {
        ++lost;
        continue;
      }
      ASSERT_LT(at, read.points.size()) << file;
      EXPECT_EQ(read.points[at].line, i + 1);
      EXPECT_LT((read.points[at].point - 1e-3 * point).norm(), 4.0 * kExact) << file << i;
      if (scatter && read.points[at].sigma)
        EXPECT_NEAR(read.points[at].sigma->y(), 1e-3 * withComma(cells[place("measurement_std_y")]), kExact);
      ++at;
    }
    EXPECT_EQ(at, read.points.size()) << file;
    EXPECT_EQ(lost, read.skipped.size()) << file;
    // Times that a spreadsheet rounded are none, and without the decimal comma nothing is read.
    options.decimal_comma = false;
    EXPECT_THROW(readPointFile(file, options), io::InputError) << file;
    options.decimal_comma = true;
    options.columns.replace(0, 1, "time");
    if (lines[1].find("E+") != std::string::npos && lines[1].find("E+") < lines[1].find(';'))
      interchange_test::expectSays(interchange_test::refusalOf([&] { readPointFile(file, options); }), {"spreadsheet"});
    else
      EXPECT_TRUE(readPointFile(file, options).points.front().time) << file;
  }
}

TEST(PublicExamples, PointsInTheOrderOfJoints) {
  const auto files = filesIn("RABKKK/LaserTrackerPoseData4KinIdent", ".csv");
  SKIP_WITHOUT(files);
  FileOptions options;
  options.columns = "x_mm y_mm z_mm - - - - - - - - - - - - - - - - - -";
  LogOptions log_options;
  log_options.table.columns = "- - - - - - - - - - - - - - - q1_deg q2_deg q3_deg q4_deg q5_deg q6_deg";
  for (const fs::path& file : files) {
    if (file.filename() != "N1N2N3Jval.csv") continue;
    const PointFile read = readPointFile(file, options);
    const RobotLog log = readRobotLog(file, log_options);
    ASSERT_EQ(read.points.size(), log.samples.size());
    const std::vector<std::string> lines = linesOfFile(file);
    for (std::size_t i = 0; i < read.points.size(); ++i) {
      std::istringstream numbers(lines[i]);
      std::vector<double> row;
      for (double number = 0.0; numbers >> number;) row.push_back(number);
      ASSERT_EQ(row.size(), 21u);
      EXPECT_NEAR(read.points[i].point.z(), 1e-3 * row[2], kExact);
      for (std::size_t j = 0; j < 6; ++j)
        EXPECT_NEAR(log.samples[i].figures[static_cast<Eigen::Index>(j)], row[15 + j] * std::numbers::pi / 180.0,
                    kExact);
    }
  }
}

TEST(PublicExamples, KarelLogs) {
  const auto files = filesIn("Pecniks/lidar-robot-demo", ".csv");
  SKIP_WITHOUT(files);
  for (const fs::path& file : files) {
    if (file.string().find("KAREL") == std::string::npos) continue;
    const RobotLog log = readRobotLog(file);
    EXPECT_EQ(log.format, LogFormat::fanuc_karel);
    const std::vector<std::string> lines = linesOfFile(file);
    std::size_t at = 0;
    for (std::size_t i = 1; i < lines.size(); ++i) {
      if (lines[i].empty()) continue;
      const std::vector<std::string> cells = split(lines[i], ';');
      ASSERT_LT(at, log.samples.size());
      const JointSample& sample = log.samples[at++];
      EXPECT_EQ(sample.line, i + 1);
      EXPECT_NEAR(sample.time_s.value(), 1e-3 * std::strtod(cells[0].c_str(), nullptr), 1e-12);
      for (std::size_t k = 0; k < 6; ++k) {
        EXPECT_NEAR(sample.figures[static_cast<Eigen::Index>(k)],
                    std::strtod(cells[7 + k].c_str(), nullptr) * std::numbers::pi / 180.0, kExact);
        const double pose = std::strtod(cells[1 + k].c_str(), nullptr);
        if (k < 3)
          EXPECT_NEAR(sample.tool_pose.position[static_cast<Eigen::Index>(k)], 1e-3 * pose, kExact);
        else
          EXPECT_NEAR(sample.tool_pose.rpy[static_cast<Eigen::Index>(k) - 3], pose * std::numbers::pi / 180.0, kExact);
      }
    }
    EXPECT_EQ(at, log.samples.size()) << file;
  }
}

/// Six numbers behind marks that follow one another, of every match of `target` in a text, in degrees.
void expectTargets(const RobotLog& log, const std::string& text, const std::regex& target) {
  std::size_t at = 0;
  for (auto one = std::sregex_iterator(text.begin(), text.end(), target); one != std::sregex_iterator(); ++one) {
    ASSERT_LT(at, log.samples.size());
    for (int j = 0; j < 6; ++j)
      EXPECT_NEAR(
          log.samples[at].figures[j],
          std::strtod((*one)[static_cast<std::size_t>(j) + 2].str().c_str(), nullptr) * std::numbers::pi / 180.0,
          kExact);
    EXPECT_NE(log.samples[at].name.find((*one)[1].str()), std::string::npos);
    ++at;
  }
  EXPECT_EQ(at, log.samples.size());
  EXPECT_GT(at, 0u);
}

std::string textOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {(std::istreambuf_iterator<char>(in)), {}};
}

TEST(PublicExamples, FanucPrograms) {
  const auto files = filesIn("GilbertPan97/HandEyeSync/data", ".ls");
  SKIP_WITHOUT(files);
  std::string joints;
  for (int j = 1; j <= 6; ++j) joints += fmt::format("[^{{}}]*?J{}\\s*=\\s*([-+.\\d]+)\\s*deg", j);
  const std::regex target("P\\[(\\d+)[^\\]]*\\]\\{" + joints);
  for (const fs::path& file : files) {
    const std::string text = textOf(file);
    // Most of them have targets in space in the arm's group, and a joint in another.
    if (!std::regex_search(text, target)) {
      interchange_test::expectSays(interchange_test::refusalOf([&] { readRobotLog(file); }), {"joint angles"});
      continue;
    }
    SCOPED_TRACE(file);
    expectTargets(readRobotLog(file), text, target);
  }
}

TEST(PublicExamples, KukaData) {
  const auto files = filesIn("antcsny/Data-collection-app-V2/robot/KRL", ".dat");
  SKIP_WITHOUT(files);
  std::string axes = "A1 ([-+.\\d]+)";
  for (int j = 2; j <= 6; ++j) axes += fmt::format(",A{} ([-+.\\d]+)", j);
  for (const fs::path& file : files) {
    SCOPED_TRACE(file);
    expectTargets(readRobotLog(file), textOf(file), std::regex("DECL AXIS (\\w+)=\\{" + axes));
  }
}

TEST(PublicExamples, RokaesTargets) {
  const auto files = filesIn("dongjy-s/LM_PyTorch/data", ".csv");
  SKIP_WITHOUT(files);
  std::string numbers = "([-+.\\d]+)";
  for (int j = 2; j <= 6; ++j) numbers += "\\s*,\\s*([-+.\\d]+)";
  for (const fs::path& file : files) {
    if (file.filename() != "joint_angle.csv") continue;
    const RobotLog log = readRobotLog(file);
    EXPECT_EQ(log.format, LogFormat::rapid);
    EXPECT_EQ(log.samples.size(), 30u);
    expectTargets(log, textOf(file), std::regex("jointtarget (\\w+) = j:\\{" + numbers));
  }
}

TEST(PublicExamples, UniversalRobotsAt125Hz) {
  const auto files = filesIn("FinnLinxxx/akig/source/ForwardKinematics/Markus", ".txt");
  SKIP_WITHOUT(files);
  LogOptions rate;
  rate.rate_hz = 125.0;
  FileOptions points;
  points.columns = "x_m y_m z_m";
  points.skip = 1;
  for (const fs::path& file : files) {
    const std::vector<std::string> lines = linesOfFile(file);
    std::vector<std::vector<double>> rows;
    for (std::size_t i = 1; i < lines.size(); ++i) {
      std::istringstream numbers(lines[i]);
      rows.emplace_back();
      for (double number = 0.0; numbers >> number;) rows.back().push_back(number);
      if (rows.back().empty()) rows.pop_back();
    }
    if (file.filename().string().starts_with("UR5")) {
      const RobotLog log = readRobotLog(file, rate);
      EXPECT_EQ(log.format, LogFormat::ur);
      ASSERT_EQ(log.samples.size(), rows.size());
      for (std::size_t i = 0; i < rows.size(); ++i) {
        EXPECT_NEAR(log.samples[i].time_s.value(), static_cast<double>(i) / 125.0, 1e-12);
        for (std::size_t j = 0; j < 6; ++j) EXPECT_EQ(log.samples[i].figures[static_cast<Eigen::Index>(j)], rows[i][j]);
      }
    } else {
      const PointFile read = readPointFile(file, points);
      ASSERT_EQ(read.points.size(), rows.size());
      for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(read.points[i].point.y(), rows[i][1]);
    }
  }
}

}  // namespace public_examples_test
}  // namespace stiffscope
