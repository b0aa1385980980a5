#include "core/input/input_error.h"

#include <fmt/format.h>

namespace stiffscope {

namespace {

std::string oneLine(const std::string& text) {
  constexpr std::size_t kLongest = 80;
  std::string shown;
  for (const char c : text) {
    if (shown.size() >= kLongest) {
      shown += "...";
      break;
    }
    const auto code = static_cast<unsigned char>(c);
    shown += (code < 0x20 || code == 0x7f) ? '?' : c;
  }
  return shown;
}

std::string message(const InputPlace& place, const std::string& value, const std::string& expectation) {
  std::string text = place.file;
  if (place.line > 0) text += fmt::format(":{}", place.line);
  if (!text.empty()) text += ": ";
  if (!place.column.empty()) text += fmt::format("{}: ", oneLine(place.column));
  if (!value.empty()) text += fmt::format("'{}': ", oneLine(value));
  return text + expectation;
}

}  // namespace

InputError::InputError(InputPlace place, std::string value, std::string expectation)
    : std::runtime_error(message(place, value, expectation)),
      place_(std::move(place)),
      value_(std::move(value)),
      expectation_(std::move(expectation)) {}

}  // namespace stiffscope
