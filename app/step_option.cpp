#include "app/step_option.h"

#include "core/input/input_error.h"
#include "core/input/numbers.h"

namespace stiffscope {

std::optional<int> loadStepNamed(const std::string& step, const std::string& also) {
  if (step.empty()) return std::nullopt;
  const std::optional<int> number = parseInteger(step);
  if (!number) {
    throw InputError(
        {"--step"}, step,
        (also.empty() ? "expected the number of one load step" : "expected a load step's number") + also);
  }
  return number;
}

}  // namespace stiffscope
