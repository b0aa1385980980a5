#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace stiffscope::io {

/// Names in order of first appearance, each with its index; looking one up makes no string.
class NameList {
 public:
  /// Index of `name`, -1 where it is not listed.
  int find(std::string_view name) const {
    const auto found = index_.find(name);
    return found == index_.end() ? -1 : found->second;
  }

  /// Index of `name`, which is appended where it is not listed yet.
  int add(std::string_view name) {
    // Rows of one posture follow one another.
    if (!names_.empty() && names_[static_cast<std::size_t>(latest_)] == name) return latest_;
    latest_ = find(name);
    if (latest_ >= 0) return latest_;
    latest_ = static_cast<int>(names_.size());
    names_.emplace_back(name);
    index_.emplace(names_.back(), latest_);
    return latest_;
  }

  /// Adds those of another list, in their order; the index here of each of them.
  std::vector<int> addAll(const NameList& others) {
    std::vector<int> indices;
    indices.reserve(others.names_.size());
    for (const std::string& name : others.names_) indices.push_back(add(name));
    return indices;
  }

  const std::vector<std::string>& names() const { return names_; }

 private:
  struct Hash {
    using is_transparent = void;
    std::size_t operator()(std::string_view text) const { return std::hash<std::string_view>{}(text); }
  };

  std::vector<std::string> names_;
  int latest_ = 0;
  std::unordered_map<std::string, int, Hash, std::equal_to<>> index_;
};

}  // namespace stiffscope::io
