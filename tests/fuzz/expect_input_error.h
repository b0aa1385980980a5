#pragma once

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include "core/io/input_error.h"

// What libFuzzer calls, and the replay of the tests too: one input, which no parser may answer with anything else than
// a result or an InputError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace stiffscope::fuzz {

inline std::string_view textOf(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Runs `parse`; an InputError must be one line of bounded length that says what was expected. Other exceptions pass
/// on, and end the run.
template <class Parse>
void expectInputError(const Parse& parse) {
  try {
    parse();
  } catch (const io::InputError& error) {
    const std::string_view text = error.what();
    constexpr std::size_t kLongestMessage = 2500;  // file and finding 1000 each, column and value 80
    const bool one_line = text.find_first_of("\n\r") == std::string_view::npos && text.size() < kLongestMessage;
    if (!one_line || error.expectation().find("expected") == std::string::npos) std::abort();
  }
}

}  // namespace stiffscope::fuzz
