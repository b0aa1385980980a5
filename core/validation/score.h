#pragma once

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/numerics/distributions.h"
#include "core/validation/remarks.h"
#include "core/validation/tables.h"
#include "metrology/remark.h"

namespace stiffscope::validation {

/// How one answer compares with the truth.
struct ScoredCase {
  Label label;
  Answer answer;
  /// Every true effect is a member of some entry. None: nothing was said. Outside: unknown was said and nothing named.
  /// A machine as it is: some true effect is a member of some entry.
  bool found = false;
  /// Found, and nothing else was said; of a machine as it is: and no effect was named that is not there.
  bool right = false;
  bool first = false;  ///< the first entry has the (first) true effect, beside at most two others
  int class_size = 0;  ///< members of the entry with the (first) true effect; 0 where not found
  std::string column;  ///< of the confusion matrix
  /// Outside the vocabulary: noises away from what any one effect can do; empty where that was not measured,
  /// because its size is less.
  std::optional<double> distance;
};

/// Noises away from what any one effect can do: from there on `unknown` is the answer to expect.
constexpr double kApart = 2.0;

struct NamedRate {
  std::string id;
  Remark meaning;  ///< what it counts
  numerics::Rate rate;
};

/// Singles answered right whose size is in [least, below), in noises.
struct SizeClass {
  double least = 0.0;
  double below = std::numeric_limits<double>::infinity();
  numerics::Rate rate = {};
};

struct EffectScore {
  std::string id;
  numerics::Rate all, from_2, from_5;  ///< answered right, by its size
  int answered_none = 0;
  double mean_class_size = 0.0;  ///< of those found
};

/// A promised shrink beside the true one, of a single answered right that shows where shrinks are promised.
struct ShrinkPair {
  std::string name, effect;
  double promised = 0.0, low = 0.0, high = 0.0, truth = 0.0, truth_seen = 0.0;
};

struct Confusion {
  std::vector<std::string> truths, answers;  ///< rows and columns
  std::vector<std::vector<int>> counts;
};

struct Score {
  std::vector<ScoredCase> cases;
  std::vector<NamedRate> rates;
  std::vector<EffectScore> effects;  ///< in the vocabulary's order
  std::vector<EffectScore> outside;  ///< the kinds outside it; right: unknown and nothing else
  std::vector<EffectScore> as_is;    ///< the effects of machines as they are; right: named
  std::vector<SizeClass> by_size;
  std::vector<ShrinkPair> shrinks;
  Confusion confusion;

  const numerics::Rate& rate(const std::string& id) const;  ///< throws std::out_of_range
};

/// Answers against labels, case by case in the labels' order. A class of effects that cannot be told apart
/// counts as right when the true one is among them; how many it had is reported beside it. Unknown says that nothing of
/// the vocabulary explains what is left: beside the name of an effect that is not there it is wrong as well. Throws
/// std::invalid_argument where a label has no answer. `distances`: by case, see ScoredCase. Tables are of
/// `vocabulary`'s effects and kinds.
Score score(const std::vector<Label>& labels, const std::vector<Answer>& answers,
            const std::map<std::string, double>& distances = {},
            const Vocabulary& vocabulary = loadedDays().vocabulary);

}  // namespace stiffscope::validation
