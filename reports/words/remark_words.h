#pragma once

#include <string>
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
  /// Of the only remark at this place, in words.
  std::string words(std::size_t place) const;

 private:
  template <class Value>
  const Value& get(std::size_t place) const;

  const Remark& remark_;
};

/// A remark in words: a sentence, or a part of one without its full stop, as its maker meant it. Empty where there is
/// nothing to say. The words of each library are in the file that bears its name.
std::string words(const Remark& remark);

std::vector<std::string> words(const std::vector<Remark>& remarks);

}  // namespace stiffscope::reports
