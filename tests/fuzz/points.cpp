#include "core/io/read_points.h"
#include "tests/fuzz/expect_input_error.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace stiffscope;
  fuzz::expectInputError([&] { io::parsePoints(fuzz::textOf(data, size), "points.txt"); });
  return 0;
}
