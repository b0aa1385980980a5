#pragma once

#include <fmt/format.h>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "core/accuracy/remarks.h"
#include "core/audit/remarks.h"
#include "core/calibration/remarks.h"
#include "core/comparison/remarks.h"
#include "core/compensation/remarks.h"
#include "core/diagnosis/remarks.h"
#include "core/effects/remarks.h"
#include "core/elastic_model/remarks.h"
#include "core/extended_model/remarks.h"
#include "core/fleet/remarks.h"
#include "core/frames/remarks.h"
#include "core/identification/remarks.h"
#include "core/mistakes/remarks.h"
#include "core/planning/remarks.h"
#include "core/preparation/remarks.h"
#include "core/toolpath/remarks.h"
#include "core/validation/remarks.h"
#include "metrology/remark.h"
#include "metrology/remarks.h"

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

// One function an enumeration: the sentence for each of its remarks, by a switch without a default, so that the
// compiler warns of a remark without words. Defined in the file that bears the library's name (audit_remarks.cpp; what
// its checks judge by and what they lack in audit_limit_remarks.cpp).
std::string accuracyWords(accuracy::RemarkId id, const RemarkValues& values);
std::string auditWords(audit::RemarkId id, const RemarkValues& values);
std::string auditControllerWords(audit::ControllerRemarkId id, const RemarkValues& values);
std::string auditLimitWords(audit::LimitId id, const RemarkValues& values);
std::string auditMissingWords(audit::MissingId id, const RemarkValues& values);
std::string calibrationWords(calibration::RemarkId id, const RemarkValues& values);
std::string comparisonWords(comparison::RemarkId id, const RemarkValues& values);
std::string compensationWords(compensation::RemarkId id, const RemarkValues& values);
std::string diagnosisWords(diagnosis::RemarkId id, const RemarkValues& values);
std::string effectsWords(effects::RemarkId id, const RemarkValues& values);
std::string elasticModelWords(elastic_model::RemarkId id, const RemarkValues& values);
std::string extendedModelWords(extended_model::RemarkId id, const RemarkValues& values);
std::string fleetWords(fleet::RemarkId id, const RemarkValues& values);
std::string framesWords(frames::RemarkId id, const RemarkValues& values);
std::string identificationWords(identification::RemarkId id, const RemarkValues& values);
std::string metrologyWords(metrology::RemarkId id, const RemarkValues& values);
std::string mistakesWords(mistakes::RemarkId id, const RemarkValues& values);
std::string planningWords(planning::RemarkId id, const RemarkValues& values);
std::string preparationWords(preparation::RemarkId id, const RemarkValues& values);
std::string toolpathWords(toolpath::RemarkId id, const RemarkValues& values);
std::string validationWords(validation::RemarkId id, const RemarkValues& values);

}  // namespace stiffscope::reports
