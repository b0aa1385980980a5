#pragma once

#include <fmt/format.h>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "metrology/remark.h"

namespace stiffscope::reports {

/// The values of a remark as its sentence takes them, by place. Throws std::logic_error where the remark was made with
/// a value of another type, or without it.
class RemarkValues {
 public:
  explicit RemarkValues(const Remark& remark) : remark_(remark) {}

  double number(std::size_t place) const { return get<double>(place); }
  std::int64_t count(std::size_t place) const { return get<std::int64_t>(place); }
  const std::string& name(std::size_t place) const { return get<std::string>(place); }
  const std::vector<double>& numbers(std::size_t place) const { return get<std::vector<double>>(place); }
  const std::vector<std::int64_t>& counts(std::size_t place) const { return get<std::vector<std::int64_t>>(place); }
  const std::vector<std::string>& names(std::size_t place) const { return get<std::vector<std::string>>(place); }
  const std::vector<Remark>& remarks(std::size_t place) const { return get<std::vector<Remark>>(place); }
  /// The only one at this place.
  const Remark& remark(std::size_t place) const { return remarks(place).at(0); }

 private:
  template <class Value>
  const Value& get(std::size_t place) const {
    const Value* value = place < remark_.values.size() ? std::get_if<Value>(&remark_.values[place]) : nullptr;
    if (value == nullptr) {
      throw std::logic_error(
          fmt::format("remark {} of {}: no such value at place {}", remark_.id, remark_.family.name(), place));
    }
    return *value;
  }

  const Remark& remark_;
};

}  // namespace stiffscope::reports
