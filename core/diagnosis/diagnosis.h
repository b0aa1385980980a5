#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/diagnosis/effect.h"

namespace stiffscope {

/// 1 - rms after / rms before, on postures that took no part in the fit.
struct Shrink {
  double value = 0.0;
  double low = 0.0, high = 0.0;  ///< 95 %, the selection repeated inside
};

/// Effects that this data cannot tell apart, as one candidate.
struct EffectClass {
  std::vector<Effect> effects;
  std::string detail;      ///< the pair, the reflector, the joint that it names; empty where nothing is named
  double score = 0.0;      ///< what the ranking goes by; larger is better
  Shrink shrink;
  double explained = 0.0;  ///< the same in variance, less noise
};

/// One member of a verdict: effects that cannot be told apart, or `unknown` where `effects` is empty.
struct VerdictEntry {
  std::vector<Effect> effects;
  std::string detail;
};

/// What a diagnosis says is present. Empty `entries`: none.
struct Verdict {
  std::vector<VerdictEntry> entries;
  std::string reason;  ///< in words, with the free evidence that was used
};

/// The gap of the deflection, rms per coordinate, m.
struct Gap {
  double before = 0.0, noise = 0.0, after = 0.0;
};

}  // namespace stiffscope
