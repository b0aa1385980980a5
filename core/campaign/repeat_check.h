#pragma once

#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>
#include <unordered_map>

namespace stiffscope {

/// Finds a key that was there before. The parts of a key are compared by value, not as written, so that steps
/// "1" and "01" are the same one; a key of ordinary length costs no allocation of its own.
class RepeatCheck {
 public:
  void add(int part) { addBytes(&part, sizeof part); }

  void add(double part) {
    if (part == 0.0) part = 0.0;  // -0 is the same value and has other bytes
    addBytes(&part, sizeof part);
  }

  /// Texts hold no byte 0, which therefore ends them.
  void add(std::string_view part) {
    key_ += part;
    key_ += '\0';
  }

  /// Ends the key: the line that had it first, or 0 where it is new and now belongs to `line`.
  std::size_t finish(std::size_t line) {
    const auto [entry, is_new] = first_line_.emplace(key_, line);
    key_.clear();
    return is_new ? 0 : entry->second;
  }

 private:
  void addBytes(const void* part, std::size_t size) { key_.append(static_cast<const char*>(part), size); }

  std::string key_;
  std::unordered_map<std::string, std::size_t> first_line_;
};

}  // namespace stiffscope
