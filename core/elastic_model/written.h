#pragma once

#include <fmt/format.h>
#include <Eigen/Core>
#include <string>
#include <string_view>

namespace stiffscope::elastic_model {

/// The shortest text that reads back as the same number; no negative zero.
inline std::string written(double value) { return fmt::format("{}", value + 0.0); }

inline std::string written(const Eigen::Vector3d& v) {
  return fmt::format("{} {} {}", v.x() + 0.0, v.y() + 0.0, v.z() + 0.0);
}

/// A text as it may stand in a comment of XML, which holds no two hyphens in a row and does not end in one.
inline std::string commentText(std::string_view text) {
  std::string result = " ";
  for (const char c : text) {
    if (c == '-' && result.back() == '-') result += ' ';
    result += c;
  }
  return result + ' ';
}

}  // namespace stiffscope::elastic_model
