#include "core/interchange/day_description.h"

#include "tests/fuzz/expect_input_error.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace stiffscope;
  fuzz::expectInputError([&] {
    std::vector<std::string> warnings;
    interchange::parseDayDescription("DAY.xml", fuzz::textOf(data, size), warnings);
  });
  return 0;
}
