#include "core/extended_model/remarks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <cmath>

#include "reports/words/entry_words.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"
#include "reports/words/remarks.h"

namespace stiffscope::reports {

std::string extendedModelWords(extended_model::RemarkId id, const RemarkValues& values) {
  using enum extended_model::RemarkId;
  switch (id) {
    case diagnosis_has_no_gap:
      return "the diagnosis has no gap to look at, so nothing is added: " + words(values.remark(0));
    case diagnosis_names_none:
      return "the diagnosis names no effect: nothing is added";
    case diagnosis_finds_unknown:
      return "the diagnosis also finds a gap that no effect explains (unknown): nothing can be added for it";
    case diagnosis_finds_only_unknown:
      return "the diagnosis finds a gap that no effect explains (unknown): there is nothing to add, and the model "
             "stays as it is";
    case effects_do_not_help:
      return "the effects that fit best leave more on postures held out than joint springs alone: none is added";
    case effects_make_negative:
      return "the effects that fit best make a stiffness negative, and so does nearly every size of them that the data "
             "allow: none is added, though one may hide";
    case sizes_leave_none_negative:
      return "the effects that fit best make a stiffness negative: they are added in the middle of the sizes that the "
             "data allow and that leave none negative";
    case springs_contradicted:
      return "every stiffness is negative: wrench and readings contradict each other, and no model of the machine is "
             "looked for";
    case taken_of_a_class:
      return fmt::format("{} is added because it fits best; this data cannot tell it from {}", nameOfId(values.name(0)),
                         nameOfId(fmt::format("{}", fmt::join(values.names(1), " or "))));
    case no_gap_to_fit:
      return "there is no gap to fit it to: " + words(values.remark(0));
    case lacks_what_shows_it:
      return "this campaign cannot show that effect: " + words(values.remark(0));
    case reflector_takes_no_part:
      return fmt::format("{} takes no part: of so many reflectors the first {} are looked at", values.name(0),
                         values.count(1));
    case not_told_from_stiffnesses:
      return "these postures and loads cannot tell it from stiffnesses and geometry, or only with sizes that no "
             "machine has";
    case not_read_in_all_steps:
      return "no reflector read in all its load steps, so the effects cannot be taken off";
    case moves_while_load_stands:
      return fmt::format(
          "readings under a standing load move on by {:.2g} % of the displacement from the first repeat to the last: "
          "stiffness here is that of loads that stand as long, and what came before is in its uncertainty",
          100.0 * values.number(0));
    case changes_over_the_day:
      return fmt::format(
          "all joints give {:.2g} % {} at the end of the day than at its beginning ({:.1f} standard uncertainties): "
          "stiffness here is the day's mean, and its change is in the uncertainty",
          100.0 * std::abs(values.number(0)), values.number(0) > 0.0 ? "more" : "less", std::abs(values.number(1)));
    case residual_beyond_noise:
      // Of what no effect explains the chi-square says nothing: it is in its noise.
      return (values.number(3) > 0.0
                  ? fmt::format("more than the tracker's noise is left in the readings: once a posture {} at the "
                                "largest load",
                                withMicro(lengthWords(values.number(3), 1)))
                  : fmt::format("more than noise is left in the readings: {:.3g} times its chi-square, {:.3g} by "
                                "springs alone",
                                values.number(0), values.number(1))) +
             (values.count(2) != 0 ? "; no effect that is known here explains it, and the stiffnesses are apparent ones"
                                   : "");
  }
  return {};
}

}  // namespace stiffscope::reports
