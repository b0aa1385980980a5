#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/accuracy/remarks.h"
#include "core/io/units.h"
#include "reports/words/entry_words.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/remarks.h"

namespace stiffscope::reports {

std::string accuracyWords(accuracy::RemarkId id, const RemarkValues& values) {
  using accuracy::RemarkId;
  const auto effect = [&] { return nameOfId(values.name(0)); };
  const auto effects = [&](const char* between) {
    std::vector<std::string> names;
    for (const std::string& id : values.names(0)) names.push_back(nameOfId(id));
    return fmt::format("{}", fmt::join(names, between));
  };
  const auto ids = [&] { return effects(", "); };
  switch (id) {
    case RemarkId::left_by_geometry:
      return fmt::format(
          "The calibrated geometry leaves {} rms per coordinate; the readings' noise alone would "
          "leave {}.",
          lengthWords(values.number(0), 1), lengthWords(values.number(1), 1));
    case RemarkId::no_effect_passes:
      return fmt::format(
          "No effect of the vocabulary is beyond chance, predicts postures that were held out, and moves "
          "the reflectors by {} rms or more.",
          lengthWords(values.number(0), 1));
    case RemarkId::effects_not_asked:
      return fmt::format("Effects were not asked for: {} postures, which takes {}.", values.count(0), values.count(1));
    case RemarkId::geometry_off_nominal:
      return fmt::format(
          "The URDF's geometry misses by {:.2f} mm rms per coordinate, more than the {:.2f} mm of arms as "
          "they are delivered.",
          values.number(0) / io::kMillimetre, values.number(1) / io::kMillimetre);
    case RemarkId::not_explained:
      return fmt::format(
          "{} rms per coordinate beyond noise stay that no effect of the vocabulary explains "
          "({} may).",
          lengthWords(values.number(0), 1), lengthWords(values.number(1), 1));
    case RemarkId::not_looked_into:
      return fmt::format("{} rms per coordinate beyond noise stay ({} may); what makes them was not asked for.",
                         lengthWords(values.number(0), 1), lengthWords(values.number(1), 1));
    case RemarkId::candidates_only:
      return fmt::format(
          "Beside that, {} {} no more than candidates: with them in the model {:.0f} % of the gap's "
          "squares beyond noise stay ({:.0f} % may).",
          effects(" and "), values.names(0).size() > 1 ? "are" : "is", 100.0 * values.number(1),
          100.0 * values.number(2));
    case RemarkId::not_in_every_fold:
      return fmt::format("{} is found in all postures together but not in each fold's others: it is a candidate only.",
                         capitalised(effect()));
    case RemarkId::less_than_unknown:
      return fmt::format(
          "{} moves the reflectors by {} rms, less than the {} that nothing explains and "
          "that it may be a part of: a candidate only.",
          capitalised(effect()), lengthWords(values.number(1), 1), lengthWords(values.number(2), 1));
    case RemarkId::too_small:
      return fmt::format("{} is beyond chance but moves the reflectors by {} rms only ({} would matter).",
                         capitalised(effect()), lengthWords(values.number(1), 1), lengthWords(values.number(2), 1));
    case RemarkId::nests_show_station:
      return fmt::format("The floor nests show that the station {}, by up to {} where the arm was read.",
                         values.count(0) != 0 ? "jumped" : "drifted", lengthWords(values.number(1), 0));
    case RemarkId::nests_stand:
      return "The floor nests stand still: the station did not move.";
    case RemarkId::needs_masses:
      return "the URDF states no masses: what the own weight does has no size";
    case RemarkId::measure_under_load:
      return fmt::format(
          "Hang known weights on the flange and read the same postures with and without them ({}): only "
          "what gives by weight moves, and each part by its own lever.",
          ids());
    case RemarkId::measure_nests:
      return fmt::format(
          "Read three floor nests or more between the postures ({}): only the station's motion shows in "
          "them.",
          ids());
    case RemarkId::measure_moves:
      return fmt::format(
          "Approach the same postures from either side, by short and by long moves, and after a pause "
          "({}).",
          ids());
    case RemarkId::measure_repeats:
      return fmt::format(
          "Come back to a few postures again and again over the day, all reflectors each time ({}): what "
          "follows time then stands apart from what follows the posture.",
          ids());
    case RemarkId::measure_scale_bar:
      return fmt::format(
          "Read a calibrated length in two places of the workspace, at the beginning and at the end of the "
          "day ({}).",
          ids());
    case RemarkId::measure_more_postures:
      return fmt::format(
          "Measure more shapes of the arm, each joint over all of its range beside the others at rest "
          "({}).",
          ids());
    case RemarkId::measure_temperature:
      return fmt::format(
          "Write the arm's temperature beside the postures (`temperature_c` in `states`), over a day that "
          "warms and cools ({}).",
          ids());
    case RemarkId::measure_enough:
      return fmt::format("Measure at least {} postures: with fewer no effect is asked for.", values.count(0));
  }
  return {};
}

}  // namespace stiffscope::reports
