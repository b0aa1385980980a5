#include "core/io/write_file.h"

#include <gtest/gtest.h>
#include <unistd.h>
#include <filesystem>
#include <fstream>
#include <set>
#include <stdexcept>
#include <string>

namespace stiffscope {
namespace write_file_test {

namespace fs = std::filesystem;

class PartsTest : public ::testing::Test {
 protected:
  PartsTest() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~PartsTest() override { fs::remove_all(folder_); }

  void add(const std::string& name) const { std::ofstream(folder_ / name) << "half\n"; }
  std::set<std::string> names() const {
    std::set<std::string> all;
    for (const auto& entry : fs::directory_iterator(folder_)) all.insert(entry.path().filename().string());
    return all;
  }

  const fs::path folder_ = fs::temp_directory_path() / ("stiffscope-parts-" + std::to_string(::getpid()));
};

TEST_F(PartsTest, OfRunsThatAreGoneAreRemovedAndNothingElse) {
  for (const char* name : {"fleet.csv.123.part", "a.b.4711.part", "fleet.csv", "notes.part", "notes.x1.part",
                           ".12.part", "12.part", "fleet.csv.123.part2"})
    add(name);
  fs::create_directory(folder_ / "folder.5.part");
  fs::create_symlink("fleet.csv", folder_ / "link.5.part");
  io::removeAbandonedParts(folder_);
  EXPECT_EQ(names(), (std::set<std::string>{"fleet.csv", "notes.part", "notes.x1.part", ".12.part", "12.part",
                                            "fleet.csv.123.part2", "folder.5.part", "link.5.part"}));
  io::removeAbandonedParts(folder_ / "none");  // of no folder nothing
}

TEST_F(PartsTest, OfARunThatWritesStay) {
  std::string part;
  io::writeFileWhole(folder_ / "fleet.csv", [&](const io::ByteSink& sink) {
    sink("whole");
    io::removeAbandonedParts(folder_);  // as another run does that begins now
    ASSERT_EQ(names().size(), 1u);
    part = *names().begin();
  });
  EXPECT_EQ(part, "fleet.csv." + std::to_string(::getpid()) + ".part");
  EXPECT_EQ(names(), std::set<std::string>{"fleet.csv"});
  std::string bytes;
  std::ifstream(folder_ / "fleet.csv") >> bytes;
  EXPECT_EQ(bytes, "whole");
}

TEST_F(PartsTest, ARunThatFailsLeavesNone) {
  const auto fails = [](const io::ByteSink& sink) {
    sink("half");
    throw std::runtime_error("no more");
  };
  EXPECT_THROW(io::writeFileWhole(folder_ / "fleet.csv", io::ByteSource(fails)), std::runtime_error);
  EXPECT_TRUE(names().empty());
}

}  // namespace write_file_test
}  // namespace stiffscope
