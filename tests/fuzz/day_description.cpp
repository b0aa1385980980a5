#include "core/interchange/day_description.h"

#include "tests/fuzz/expect_input_error.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace stiffscope;
  fuzz::expectInputError([&] {
    std::vector<std::string> warnings;
    const interchange::DayDescription day =
        interchange::parseDayDescription("DAY.xml", fuzz::textOf(data, size), warnings);
    // Its patterns meet names of any kind, too.
    for (const interchange::PointsSource& points : day.points) points.names.fieldsIn(points.file);
    for (const interchange::LogSource& log : day.logs) log.names.fieldsIn(log.file);
  });
  return 0;
}
