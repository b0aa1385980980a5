#pragma once

#include <string>
#include <vector>

#include "core/blind/case_draw.h"

namespace stiffscope::blind {

/// What is true of one effect of a case.
struct LabelledEffect {
  std::string id;  ///< of the vocabulary, or the kind of one outside it
  std::string detail;
  std::string shows;  ///< deflection, positions or nests
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
};

Label labelOf(const std::string& name, const BlindCase& one);

/// One line a case: case,kind,effects,details,shows,sizes,deflection,positions,shrink,shrink_seen,
/// noise_factor,background,arm,loading; a double's two joined by '+'. Numbers with six significant digits.
std::string labelsCsv(const std::vector<Label>& labels);

/// Reads it back. Throws InputError where a line is not of that form.
std::vector<Label> readLabels(const std::string& file, const std::string& bytes);

/// A number the same everywhere: six significant digits.
std::string shortNumber(double value);

}  // namespace stiffscope::blind
