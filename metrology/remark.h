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
  // All that makes, copies and ends a remark is compiled once: thousands of places make one.
  Remark();
  Remark(const Remark&);
  Remark(Remark&&) noexcept;
  Remark& operator=(const Remark&);
  Remark& operator=(Remark&&) noexcept;
  ~Remark();

  template <class Id, class... Values>
  requires std::is_enum_v<Id>
  explicit Remark(Id remark_id, Values&&... its) : Remark(std::type_index(typeid(Id)), static_cast<int>(remark_id)) {
    (add(plain(std::forward<Values>(its))), ...);
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
  Remark(std::type_index family_of_id, int remark_id);

  void add(double number);
  void add(std::int64_t count);
  void add(std::string name);
  void add(std::vector<double> numbers);
  void add(std::vector<std::int64_t> counts);
  void add(std::vector<std::string> names);
  void add(std::vector<Remark> remarks);
  void add(const Remark& remark);

  template <class Value>
  static decltype(auto) plain(Value&& value) {
    using Plain = std::remove_cvref_t<Value>;
    if constexpr (std::is_integral_v<Plain> || std::is_enum_v<Plain>) {
      return static_cast<std::int64_t>(value);
    } else if constexpr (std::is_same_v<Plain, std::vector<int>> || std::is_same_v<Plain, std::vector<std::size_t>>) {
      return std::vector<std::int64_t>(value.begin(), value.end());
    } else {
      return std::forward<Value>(value);
    }
  }
};

}  // namespace stiffscope
