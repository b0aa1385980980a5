#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/diagnosis/diagnosis.h"

namespace stiffscope::blind {

/// What a diagnosis gives back of one campaign.
struct DiagnosisAnswer {
  Verdict verdict;
  std::vector<EffectClass> classes;
};
using Diagnose = std::function<DiagnosisAnswer(const Campaign&)>;

/// An answer as it is frozen: names only.
struct Answer {
  struct Entry {
    std::vector<std::string> effects;  ///< empty: unknown
    std::string detail;
  };
  struct Promise {
    std::vector<std::string> effects;
    double value = 0.0, low = 0.0, high = 0.0, explained = 0.0;  ///< of the shrink
  };
  std::string name;
  std::vector<Entry> entries;     ///< empty: none
  std::vector<Promise> promises;  ///< best class first
  std::string failure;            ///< why there is no answer
};

Answer answerOf(const std::string& name, const DiagnosisAnswer& given);

/// One line a case: case,verdict,details,classes,failure. Verdict: "none", or entries joined by '+', each the
/// members of one joined by '|', or "unknown". Details joined by '+', classes by ';':
/// members|...:value:low:high:explained.
std::string answersCsv(const std::vector<Answer>& answers);

/// Reads it back. Throws InputError where a line is not of that form.
std::vector<Answer> readAnswers(const std::string& file, const std::string& bytes);

}  // namespace stiffscope::blind
