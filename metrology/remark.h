#pragma once

#include <cstdint>
#include <string>
#include <type_traits>
#include <typeindex>
#include <utility>
#include <variant>
#include <vector>

namespace stiffscope {

struct Remark;

/// What a remark speaks of: numbers in SI units and radians, counts, names, and remarks within it.
using RemarkValue = std::variant<double, std::int64_t, std::string, std::vector<double>, std::vector<std::int64_t>,
                                 std::vector<std::string>, std::vector<Remark>>;

/// What there is to say about a result, without words: why there is none, or what to know before believing it. Each
/// library that remarks has an enumeration `RemarkId`; reports/words has a sentence for each of its enumerators, which
/// the compiler checks, and the units that people read.
struct Remark {
  Remark() = default;

  template <class Id, class... Values>
  requires std::is_enum_v<Id>
  explicit Remark(Id remark_id, Values&&... its) : family(typeid(Id)), id(static_cast<int>(remark_id)) {
    (values.push_back(valueOf(std::forward<Values>(its))), ...);
  }

  /// Nothing to say.
  bool empty() const { return family == std::type_index(typeid(void)); }
  template <class Id>
  bool is(Id remark_id) const {
    return family == std::type_index(typeid(Id)) && id == static_cast<int>(remark_id);
  }
  bool operator==(const Remark&) const = default;

  std::type_index family = typeid(void);  ///< the enumeration
  int id = 0;
  std::vector<RemarkValue> values;

 private:
  template <class Value>
  static RemarkValue valueOf(Value&& value) {
    using Plain = std::remove_cvref_t<Value>;
    if constexpr (std::is_integral_v<Plain> || std::is_enum_v<Plain>) {
      return static_cast<std::int64_t>(value);
    } else if constexpr (std::is_same_v<Plain, Remark>) {
      return std::vector<Remark>{std::forward<Value>(value)};
    } else if constexpr (std::is_same_v<Plain, std::vector<int>> || std::is_same_v<Plain, std::vector<std::size_t>>) {
      return std::vector<std::int64_t>(value.begin(), value.end());
    } else {
      return RemarkValue(std::forward<Value>(value));
    }
  }
};

}  // namespace stiffscope
