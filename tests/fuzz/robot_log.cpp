#include "core/interchange/robot_log.h"

#include "tests/fuzz/expect_input_error.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace stiffscope;
  for (const int joints : {6, 7}) {
    interchange::LogOptions options;
    options.joints = joints;
    fuzz::expectInputError([&] { interchange::parseRobotLog("robot.txt", fuzz::textOf(data, size), options); });
  }
  return 0;
}
