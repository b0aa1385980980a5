#include <gtest/gtest.h>

#include <fstream>

#include "core/conformity/decide.h"
#include "core/io/input_error.h"

namespace stiffscope {
namespace limits_test {

/// A file of limits that goes when the test ends.
class LimitsFile {
 public:
  explicit LimitsFile(const std::string& text)
      : path_(std::filesystem::temp_directory_path() /
              (std::string("limits-") + testing::UnitTest::GetInstance()->current_test_info()->name() + ".csv")) {
    std::ofstream(path_, std::ios::binary) << text;
  }
  ~LimitsFile() { std::filesystem::remove(path_); }
  LimitsFile(const LimitsFile&) = delete;
  LimitsFile& operator=(const LimitsFile&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

TEST(ReadLimits, InSiWithReasonsAndLines) {
  const LimitsFile file(
      "name,least,most,reason\n"
      "k2_nm_per_rad,5e6,,\"plan 17, milling\"\n"
      "\n"
      "calibrated_error_largest_mm,,0.3,contract\n"
      "softest_at_tcp_n_per_um,0.5,2,cell\n"
      "avoided_by_encoders_percent,30,,maker\n");
  const conformity::Limits read = conformity::readLimits(file.path());
  ASSERT_EQ(read.limits.size(), 4u);
  EXPECT_EQ(read.file, file.path().filename().string());
  EXPECT_EQ(read.sha256.size(), 64u);
  EXPECT_EQ(read.limits[0].quantity, conformity::Quantity::k2);
  EXPECT_EQ(read.limits[0].least, 5e6);
  EXPECT_FALSE(read.limits[0].most);
  EXPECT_EQ(read.limits[0].reason, "plan 17, milling");
  EXPECT_EQ(read.limits[1].line, 4u);
  EXPECT_DOUBLE_EQ(*read.limits[1].most, 0.3e-3);
  EXPECT_DOUBLE_EQ(*read.limits[2].least, 0.5e6);  // 0.5 N/um
  EXPECT_DOUBLE_EQ(*read.limits[3].least, 0.30);
}

TEST(ReadLimits, NamesAreInTheOrderOfTheQuantities) {
  const auto& names = conformity::quantityNames();
  for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(static_cast<std::size_t>(names[i].quantity), i);
}

/// What reading says of this text, from the line's number on.
std::string refusal(const std::string& text) {
  const LimitsFile file(text);
  try {
    conformity::readLimits(file.path());
  } catch (const io::InputError& error) {
    const std::string what = error.what(), name = file.path().string();
    EXPECT_EQ(what.rfind(name, 0), 0u) << what;
    return what.substr(name.size());
  }
  return "nothing was refused";
}

TEST(ReadLimits, RefusesWithFileLineAndColumn) {
  const std::string head = "name,least,most,reason\n";
  EXPECT_EQ(refusal(head + "k2_nm_pr_rad,1,,x\n"),
            ":2: name: 'k2_nm_pr_rad': no limit can be on this (did you mean 'k2_nm_per_rad'?)");
  EXPECT_EQ(refusal(head + "k1_nm_per_rad,1,,x\nk1_nm_per_rad,,2,x\n"),
            ":3: name: 'k1_nm_per_rad': line 2 has a limit on this already; least and most may stand in one row");
  EXPECT_EQ(refusal(head + "k1_nm_per_rad,3,2,x\n"), ":2: least: '3': expected no more than most, 2");
  EXPECT_EQ(refusal(head + "k1_nm_per_rad,,,x\n"), ":2: least: expected a number here or in the column most");
  EXPECT_EQ(refusal(head + "k1_nm_per_rad,1,,\n"), ":2: reason: expected who asks for this limit, and why");
  EXPECT_EQ(refusal(head + "k1_nm_per_rad,1,,a, b\n"),
            ":2: 5 cells, expected 4 as in the first line; a reason with a comma stands in double quotes");
  EXPECT_NE(refusal(head + "k1_nm_per_rad,five,,x\n").find(":2: least: 'five': "), std::string::npos);
  EXPECT_EQ(refusal("name,least\nk1_nm_per_rad,1\n"), ":1: reason: this column is missing from the first line");
  EXPECT_EQ(refusal("name,minimum,reason\n"),
            ":1: minimum: not a column of a file of limits; expected name, least, most, reason");
  EXPECT_EQ(refusal(head), ": expected a row below the first line: there is no limit");
}

}  // namespace limits_test
}  // namespace stiffscope
