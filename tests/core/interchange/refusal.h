#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/io/input_error.h"

namespace stiffscope::interchange_test {

/// What an InputError of `run` says; empty where it throws none.
template <class Run>
std::string refusalOf(const Run& run) {
  try {
    run();
  } catch (const io::InputError& error) {
    return error.what();
  }
  return {};
}

inline void expectSays(const std::string& said, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) EXPECT_NE(said.find(part), std::string::npos) << part << " in: " << said;
}

}  // namespace stiffscope::interchange_test
