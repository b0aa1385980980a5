#include "core/interchange/robot_log.h"

#include "tests/fuzz/expect_input_error.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace stiffscope;
  fuzz::expectInputError([&] { interchange::parseRobotLog("robot.txt", fuzz::textOf(data, size)); });
  return 0;
}
