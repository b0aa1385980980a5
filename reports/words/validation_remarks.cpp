#include "core/validation/remarks.h"

#include "reports/words/remarks.h"

namespace stiffscope::reports {

std::string validationWords(validation::RemarkId id, const RemarkValues&) {
  using enum validation::RemarkId;
  switch (id) {
    case singles_right:
      return "singles: the effect and nothing else";
    case singles_from_2_first:
      return "size 2 and more: the effect first, in a class of at most three";
    case singles_from_5_first:
    case singles_from_5_alone:
      return "the same, of size 5 and more";
    case singles_from_2_alone:
      return "alone, of size 2 and more";
    case singles_from_2_found:
      return "size 2 and more: the effect, perhaps with others";
    case clean_alarmed:
      return "clean machines: something was said";
    case clean_alarmed_noise_right:
      return "the same, the tracker's noise declared right";
    case clean_alarmed_noise_wrong:
      return "the same, declared wrong";
    case outside_unknown:
      return "outside the vocabulary: unknown was said, and no name";
    case outside_from_2_unknown:
      return "the same, of size 2 and more";
    case outside_apart_unknown:
      return "the same, two noises and more from what any effect can do";
    case outside_from_2_none:
      return "outside the vocabulary, size 2 and more: none was said";
    case outside_wrongly_named:
      return "outside the vocabulary: an effect was named";
    case outside_unknown_beside_a_name:
      return "the same, unknown beside it";
    case as_is_right:
      return "machines as they are: of their effects, and nothing else";
    case as_is_wrongly_named:
      return "machines as they are: an effect was named that is not there";
    case as_is_unknown:
      return "machines as they are: unknown was said, alone or beside";
    case as_is_none:
      return "machines as they are: none was said";
    case as_is_effects_found:
      return "effects of machines as they are: named";
    case as_is_effects_from_2_found:
      return "the same, of size 2 and more";
    case doubles_right:
      return "doubles: both and nothing else";
    case doubles_found:
      return "doubles: both, perhaps with others";
    case doubles_one_found:
      return "doubles: at least one";
    case details_right:
      return "joint, pair or reflector named as it is, where the effect is right";
    case cases_failed:
      return "no answer at all";
    case shrinks_seen_covered:
      return "the promised interval holds the shrink that can be seen";
  }
  return {};
}

}  // namespace stiffscope::reports
