#include "core/input/input_error.h"

#include <fmt/format.h>

#include "core/input/one_line.h"

namespace stiffscope {

std::string inputMessage(const InputPlace& place, std::string_view value, std::string_view finding) {
  constexpr std::size_t kLongestValue = 80;
  constexpr std::size_t kLongestText = 1000;
  std::string text = oneLine(place.file, kLongestText);
  if (place.line > 0) text += fmt::format(":{}", place.line);
  if (!text.empty()) text += ": ";
  if (!place.column.empty()) text += fmt::format("{}: ", oneLine(place.column, kLongestValue));
  if (!value.empty()) text += fmt::format("'{}': ", oneLine(value, kLongestValue));
  return text + oneLine(finding, kLongestText);
}

InputError::InputError(InputPlace place, std::string value, std::string expectation)
    : std::runtime_error(inputMessage(place, value, expectation)),
      place_(std::move(place)),
      value_(std::move(value)),
      expectation_(std::move(expectation)) {}

}  // namespace stiffscope
