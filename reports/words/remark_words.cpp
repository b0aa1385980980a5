#include "reports/words/remark_words.h"

#include <fmt/format.h>
#include <stdexcept>
#include <typeindex>
#include <unordered_map>

#include "reports/words/remarks.h"

namespace stiffscope::reports {

namespace {

using FamilyWords = std::string (*)(int id, const RemarkValues& values);

/// The function for the remarks of one enumeration.
template <class Id, std::string (*kWords)(Id, const RemarkValues&)>
std::pair<const std::type_index, FamilyWords> of() {
  return {typeid(Id), [](int id, const RemarkValues& values) { return kWords(static_cast<Id>(id), values); }};
}

const std::unordered_map<std::type_index, FamilyWords>& families() {
  static const std::unordered_map<std::type_index, FamilyWords> all{
      of<accuracy::RemarkId, &accuracyWords>(),
      of<audit::RemarkId, &auditWords>(),
      of<audit::ControllerRemarkId, &auditControllerWords>(),
      of<audit::LimitId, &auditLimitWords>(),
      of<audit::MissingId, &auditMissingWords>(),
      of<calibration::RemarkId, &calibrationWords>(),
      of<comparison::RemarkId, &comparisonWords>(),
      of<compensation::RemarkId, &compensationWords>(),
      of<diagnosis::RemarkId, &diagnosisWords>(),
      of<effects::RemarkId, &effectsWords>(),
      of<elastic_model::RemarkId, &elasticModelWords>(),
      of<extended_model::RemarkId, &extendedModelWords>(),
      of<fleet::RemarkId, &fleetWords>(),
      of<frames::RemarkId, &framesWords>(),
      of<identification::RemarkId, &identificationWords>(),
      of<metrology::RemarkId, &metrologyWords>(),
      of<mistakes::RemarkId, &mistakesWords>(),
      of<planning::RemarkId, &planningWords>(),
      of<preparation::RemarkId, &preparationWords>(),
      of<toolpath::RemarkId, &toolpathWords>(),
      of<validation::RemarkId, &validationWords>(),
  };
  return all;
}

}  // namespace

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
