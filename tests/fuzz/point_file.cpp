#include "core/interchange/point_file.h"

#include "tests/fuzz/expect_input_error.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace stiffscope;
  // As the file shows, and as what the user says of it would have it.
  fuzz::expectInputError([&] { interchange::parsePointFile("points.txt", fuzz::textOf(data, size)); });
  interchange::FileOptions said;
  said.columns = "target x_mm y_mm z_mm time";
  said.decimal_comma = true;
  fuzz::expectInputError([&] { interchange::parsePointFile("points.txt", fuzz::textOf(data, size), said); });
  return 0;
}
