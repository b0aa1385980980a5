#include "reports/words/remark_words.h"

#include <fmt/format.h>
#include <stdexcept>
#include <typeindex>
#include <unordered_map>

#include "reports/words/remarks.h"

namespace stiffscope::reports {

namespace {

using Words = std::string (*)(int id, const RemarkValues& values);

/// The function for the remarks of one library, by the enumeration that it takes.
template <class Id, std::string (*kWords)(Id, const RemarkValues&)>
std::pair<const std::type_index, Words> of() {
  return {typeid(Id), [](int id, const RemarkValues& values) { return kWords(static_cast<Id>(id), values); }};
}

const std::unordered_map<std::type_index, Words>& families() {
  static const std::unordered_map<std::type_index, Words> all{
      of<comparison::RemarkId, &comparisonWords>(),        of<compensation::RemarkId, &compensationWords>(),
      of<diagnosis::RemarkId, &diagnosisWords>(),          of<effects::RemarkId, &effectsWords>(),
      of<extended_model::RemarkId, &extendedModelWords>(), of<planning::RemarkId, &planningWords>(),
      of<validation::RemarkId, &validationWords>(),
  };
  return all;
}

}  // namespace

template <class Value>
const Value& RemarkValues::get(std::size_t place) const {
  const Value* value = place < remark_.values.size() ? std::get_if<Value>(&remark_.values[place]) : nullptr;
  if (value == nullptr) {
    throw std::logic_error(
        fmt::format("remark {} of {}: no such value at place {}", remark_.id, remark_.family.name(), place));
  }
  return *value;
}

template const double& RemarkValues::get<double>(std::size_t) const;
template const std::int64_t& RemarkValues::get<std::int64_t>(std::size_t) const;
template const std::string& RemarkValues::get<std::string>(std::size_t) const;
template const std::vector<double>& RemarkValues::get<std::vector<double>>(std::size_t) const;
template const std::vector<std::int64_t>& RemarkValues::get<std::vector<std::int64_t>>(std::size_t) const;
template const std::vector<std::string>& RemarkValues::get<std::vector<std::string>>(std::size_t) const;
template const std::vector<Remark>& RemarkValues::get<std::vector<Remark>>(std::size_t) const;

std::string RemarkValues::words(std::size_t place) const { return reports::words(remarks(place).at(0)); }

std::string words(const Remark& remark) {
  if (remark.empty()) return {};
  const auto family = families().find(remark.family);
  if (family == families().end()) throw std::logic_error(fmt::format("no words for {}", remark.family.name()));
  return family->second(remark.id, RemarkValues(remark));
}

std::vector<std::string> words(const std::vector<Remark>& remarks) {
  std::vector<std::string> all;
  for (const Remark& remark : remarks) all.push_back(words(remark));
  return all;
}

}  // namespace stiffscope::reports
