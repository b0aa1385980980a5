#include <gtest/gtest.h>

#include "tests/app/command.h"

namespace stiffscope {
namespace samples_test {

namespace fs = std::filesystem;

// The line at the head of each specification makes its campaign again, byte for byte.
TEST(Samples, AreWhatTheirSpecificationsMake) {
  for (const std::string name : {"inactive", "active", "unloaded"}) {
    const ScratchFolder scratch;
    const fs::path made = scratch.path() / name;
    const Ran ran = runProgram(
        "simulate '" STIFFSCOPE_SOURCE_DIR "/samples/" + name + ".xml' --out '" + made.string() + "'", scratch.path());
    ASSERT_EQ(ran.status, 0) << ran.err;
    int files = 0;
    for (const auto& entry : fs::directory_iterator(fs::path(STIFFSCOPE_SOURCE_DIR) / "samples" / name)) {
      EXPECT_EQ(contentsOf(entry.path()), contentsOf(made / entry.path().filename())) << entry.path();
      ++files;
    }
    EXPECT_EQ(files, name == "unloaded" ? 5 : 7);  // without sweeps
  }
}

}  // namespace samples_test
}  // namespace stiffscope
