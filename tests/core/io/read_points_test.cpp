#include "core/io/read_points.h"

#include <gtest/gtest.h>

#include <fstream>
#include "core/io/input_error.h"

namespace stiffscope {
namespace read_points_test {

std::filesystem::path written(const std::string& text) {
  const auto file = std::filesystem::path(testing::TempDir()) /
                    (std::string("points_") + testing::UnitTest::GetInstance()->current_test_info()->name() + ".txt");
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

/// What is said of a file that cannot be read; empty where it can.
std::string refusal(const std::string& text) {
  try {
    io::readPoints(written(text));
  } catch (const io::InputError& error) {
    return error.what();
  }
  return {};
}

void expectSays(const std::string& text, const std::vector<std::string>& parts) {
  const std::string said = refusal(text);
  for (const std::string& part : parts) EXPECT_NE(said.find(part), std::string::npos) << part << " in: " << said;
}

TEST(ReadPoints, BlanksTabsCommasAndSemicolons) {
  const auto points =
      io::readPoints(written("\xEF\xBB\xBF# a comment\r\n1 2 3\r\n\r\n4\t5\t6 # more\n7,8,9\n-1e-3; 2.5 ;3\n"));
  ASSERT_EQ(points.size(), 4u);
  EXPECT_EQ(points[0], Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(points[1], Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(points[2], Eigen::Vector3d(7, 8, 9));
  EXPECT_EQ(points[3], Eigen::Vector3d(-1e-3, 2.5, 3));
}

TEST(ReadPoints, AnyLineEnd) {
  for (const char* const bytes : {"1 2 3\n4 5 6\n", "1 2 3\r\n4 5 6\r\n", "1 2 3\r4 5 6\r", "1 2 3\r4 5 6"}) {
    const auto points = io::parsePoints(bytes, "p.txt");
    ASSERT_EQ(points.size(), 2u);
    EXPECT_EQ(points[1], Eigen::Vector3d(4, 5, 6));
  }
}

TEST(ReadPoints, AFirstLineWithTheCount) {
  EXPECT_EQ(io::readPoints(written("2\n1 2 3\n4 5 6\n")).size(), 2u);
  EXPECT_EQ(io::readPoints(written("\n# head\n 2 \n1 2 3\n4 5 6")).size(), 2u);
}

TEST(ReadPoints, ACountThatIsNotTheirs) {
  expectSays("3\n1 2 3\n4 5 6\n", {":1", "count", "3", "expected the number of points that follow, 2"});
  expectSays("-2\n1 2 3\n4 5 6\n", {"count", "-2"});
}

TEST(ReadPoints, ACountOnlyStandsFirst) { expectSays("1 2 3\n2\n", {":2", "y", "expected three numbers"}); }

TEST(ReadPoints, TooFewAndTooManyColumns) {
  expectSays("1 2 3\n4 5\n", {":2", "z", "the line ends before this one"});
  expectSays("1 2 3 4\n", {":1", "4", "the line has more"});
}

TEST(ReadPoints, NoNumberAndNotFinite) {
  expectSays("1 2 3\n1 two 3\n", {":2", "y", "two"});
  expectSays("1 2 3\n1 2 nan\n", {":2", "z", "nan"});
  expectSays("inf 2 3\n", {":1", "x", "inf"});
  expectSays("1,,3\n", {":1", "y"});
}

TEST(ReadPoints, AHeaderLineIsRefusedInItsWords) {
  expectSays("x,y,z\n1,2,3\n", {":1", "x", "no header line, or one that begins with #"});
  expectSays("\"x\",\"y\"\n", {"no header line"});
  EXPECT_EQ(io::readPoints(written("# x y z\n1 2 3\n")).size(), 1u);
  // Further down it is a wrong number like any other.
  EXPECT_EQ(refusal("1 2 3\nx y z\n").find("header"), std::string::npos);
}

TEST(ReadPoints, DecimalCommas) {
  // "1,5 2,5 3,5" has six cells: refused, with what to write instead, and not read as points of whole numbers.
  expectSays("1,5 2,5 3,5\n", {":1", "decimal points"});
  expectSays("1,5;2,5;3,5\n", {":1", "decimal points"});
}

TEST(ReadPoints, Empty) {
  expectSays("", {"expected a file that is not empty"});
  expectSays("# nothing\n\n", {"expected points"});
  expectSays("3\n", {"expected points"});
}

TEST(ReadPoints, AFileThatIsNotThere) {
  EXPECT_THROW(io::readPoints(std::filesystem::path(testing::TempDir()) / "no such file"), io::InputError);
}

}  // namespace read_points_test
}  // namespace stiffscope
