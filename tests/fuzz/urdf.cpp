#include "core/robot/read_urdf.h"
#include "tests/fuzz/expect_input_error.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace stiffscope;
  fuzz::expectInputError([&] { robot::parseUrdf(fuzz::textOf(data, size), "robot.urdf", "base", "flange"); });
  return 0;
}
