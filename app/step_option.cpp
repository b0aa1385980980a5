#include "app/step_option.h"

#include <charconv>

#include "core/input/input_error.h"

namespace stiffscope {

std::optional<int> loadStepNamed(const std::string& step, const std::string& also) {
  if (step.empty()) return std::nullopt;
  int number = 0;
  const char* end = step.data() + step.size();
  const auto read = std::from_chars(step.data(), end, number);
  if (read.ec != std::errc() || read.ptr != end) {
    throw InputError(
        {"--step"}, step,
        (also.empty() ? "expected the number of one load step" : "expected a load step's number") + also);
  }
  return number;
}

}  // namespace stiffscope
