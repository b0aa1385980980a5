#include "app/option_values.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

namespace stiffscope {

namespace {

std::string whyEmpty(const std::string& value) { return value.empty() ? "expected a value; it is empty" : ""; }

std::string whyNotFinite(const std::string& value) {
  return std::isfinite(std::strtod(value.c_str(), nullptr)) ? "" : "'" + value + "': expected a finite number";
}

std::string whyNotUnsigned(const std::string& value) {
  std::uint64_t number = 0;
  const char* const end = value.data() + value.size();
  const auto [stopped, error] = std::from_chars(value.data(), end, number);
  return error == std::errc() && stopped == end ? "" : "'" + value + "': expected a whole number from 0 to 18446744073709551615";
}

}  // namespace

void checkOptionValues(CLI::App& app) {
  for (CLI::App* command : app.get_subcommands(nullptr)) {
    for (CLI::Option* option : command->get_options()) {
      const std::string type = option->get_type_name();
      if (option->get_type_size() == 0) continue;  // a flag
      option->check(whyEmpty, "");
      if (type.starts_with("FLOAT")) option->check(whyNotFinite, "");
      if (type.starts_with("UINT")) option->check(whyNotUnsigned, "");
    }
  }
}

}  // namespace stiffscope
