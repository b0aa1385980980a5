#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "core/accuracy/accuracy_diagnosis.h"
#include "core/campaign/campaign.h"
#include "core/diagnosis/diagnosis.h"
#include "core/validation/case.h"

namespace stiffscope::validation {

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

/// What a diagnosis said, the name of the case aside. On a day without a load a URDF that misses by more than the
/// stated limit is an entry, kinematic_error.
Answer answerOf(const diagnosis::Verdict& verdict, const std::vector<diagnosis::EffectClass>& classes = {});
Answer answerOf(const accuracy::AccuracyDiagnosis& given);

/// A diagnosis of one campaign. One that cannot answer throws.
using Diagnose = std::function<Answer(const campaign::Campaign&)>;

/// One line a case: case,verdict,details,classes,failure. Verdict: "none", or entries joined by '+', each the
/// members of one joined by '|', or "unknown". Details joined by '+', classes by ';':
/// members|...:value:low:high:explained.
std::string answersCsv(const std::vector<Answer>& answers);

/// Reads it back. Throws InputError where a line is not of that form.
std::vector<Answer> readAnswers(const std::string& file, const std::string& bytes);

/// What is true of one effect of a case.
struct LabelledEffect {
  std::string id;  ///< of the vocabulary, or the kind of one outside it
  std::string detail;
  std::string shows;  ///< deflection, positions, nests or geometry
  double size = 0.0;  ///< in noises, measured by what `shows` names
  double deflection = 0.0, positions = 0.0;
};

/// The truth of one case, as it is written and read back.
struct Label {
  std::string name;
  CaseKind kind = CaseKind::none;
  std::vector<LabelledEffect> effects;
  double shrink = 0.0, shrink_seen = 0.0;  ///< of all its effects; see EffectSize
  double noise_factor = 1.0;               ///< true noise of the tracker over declared
  double background = 0.0;
  std::string arm, loading;
  /// Stiffness of the joints' springs, Nm/rad: where the stiffness changes with torque or time, that without torque at
  /// the start of the day. What an interval of an identification has to hold.
  PerJoint<double> stiffness;
};

Label labelOf(const std::string& name, const BlindCase& one);

/// One line a case: case,kind,effects,details,shows,sizes,deflection,positions,shrink,shrink_seen,
/// noise_factor,background,arm,loading,stiffness_nm_per_rad; of several effects, and of the joints, joined by '+'.
/// Numbers with six significant digits, stiffnesses to a tenth.
std::string labelsCsv(const std::vector<Label>& labels);

/// Reads it back. Throws InputError where a line is not of that form.
std::vector<Label> readLabels(const std::string& file, const std::string& bytes);

/// A number the same everywhere: six significant digits.
std::string shortNumber(double value);

}  // namespace stiffscope::validation
