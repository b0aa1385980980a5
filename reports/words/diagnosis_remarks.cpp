#include "core/diagnosis/remarks.h"

#include <fmt/ranges.h>
#include <numbers>

#include "core/io/units.h"
#include "reports/words/entry_words.h"
#include "reports/words/remark_words.h"
#include "reports/words/remarks.h"

namespace stiffscope::reports {

namespace {

/// "joint 3: 1.2e-07 rad/Nm"; lengths in mm.
std::string fittedPart(const std::string& name, const std::string& unit, const std::vector<double>& parameters) {
  const bool length = unit == "m";
  std::string text = name.empty() ? "" : name + ": ";
  for (std::size_t k = 0; k < parameters.size(); ++k)
    text += fmt::format("{}{:.4g}", k > 0 ? ", " : "", length ? parameters[k] / io::kMillimetre : parameters[k]);
  return text + (length ? " mm" : " " + unit);
}

std::string postureThatSeparates(const RemarkValues& values) {
  std::vector<double> degrees = values.numbers(0);
  for (double& angle : degrees) angle *= 180.0 / std::numbers::pi;
  return fmt::format(
      "a posture at ({:.0f}) deg, pulled by {:.0f} N along {}0: it raises the least separation (chi2, {:.0f} tells "
      "apart) from {:.1f} to {:.1f}",
      fmt::join(degrees, ", "), values.number(1), "xyz"[values.count(2)], values.number(3), values.number(4),
      values.number(5));
}

}  // namespace

std::string diagnosisWords(diagnosis::RemarkId id, const RemarkValues& values) {
  using enum diagnosis::RemarkId;
  switch (id) {
    case readings_not_in_robot_frame:
      return "the readings cannot be brought into the robot's frame: " + words(values.remark(0));
    case no_usable_posture:
      return "no posture has readings unloaded and under load that can be brought into the robot's frame";
    case noise_not_known:
      return words(values.remark(0)) + ": effects cannot be told from noise; state `tracker`";
    case geometry_needs_positions:
      return "absolute unloaded positions (`loading`, or circle sweeps of all axes) are needed";
    case fitted_parts:
      return fmt::format("{}", fmt::join(words(values.remarks(0)), "; "));
    case fitted_part:
      return fittedPart(values.name(0), values.name(1), values.numbers(2));
    case axes_off_nominal:
      return fmt::format("axes up to {:.3f} mm and {:.3f} mrad from the nominal ones", 1e3 * values.number(0),
                         1e3 * values.number(1));
    case left_by_stiffnesses:
      return fmt::format(
          "Stiffnesses alone leave {} rms per coordinate of the deflection, noise alone {} (chi2 per "
          "equation {}{}{:.{}f}).",
          lengthWords(values.number(0), 1), lengthWords(values.number(1), 1),
          values.count(3) != 0 ? "of deflections and positions " : "",
          values.count(4) != 0 ? "with the station's motion taken off " : "", values.number(2),
          values.number(2) < 100.0 ? 2 : 0);
    case no_effect_passes:
      return fmt::format("No effect passes both limits: a fall of BIC of {:.0f}, {} rms after the stiffnesses.",
                         values.number(0), lengthWords(values.number(1), 1));
    case geometry_off_nominal:
      return fmt::format(
          "Besides, the axes found by the sweeps and the unloaded positions put the reflectors {:.2f} mm rms from "
          "where the nominal geometry does ({:.2f} mm is allowed).",
          1e3 * values.number(0), 1e3 * values.number(1));
    case follows_from_geometry:
      return fmt::format("Besides, what looks like {} ({}) is no more than the wrong geometry puts there.",
                         nameOfId(values.name(0)), words(values.remark(1)));
    case deflection_not_explained:
      return fmt::format(
          "Besides, {} rms of the deflection at the largest load are explained by no effect of the vocabulary.",
          lengthWords(values.number(0), 1));
    case positions_not_explained:
      return fmt::format("Besides, {} rms of the unloaded positions are explained by no effect (limit {}).",
                         lengthWords(values.number(0), 1), lengthWords(values.number(1), 1));
    case candidates_only: {
      std::vector<std::string> names;
      for (const std::string& id : values.names(0)) names.push_back(nameOfId(id));
      return fmt::format(
          "Beside that, {} {} no more than {}: with {} in the model {:.0f} % of the gap's squares beyond noise stay "
          "({:.0f} % may).",
          fmt::join(names, " and "), names.size() > 1 ? "are" : "is", names.size() > 1 ? "candidates" : "a candidate",
          names.size() > 1 ? "them" : "it", 100.0 * values.number(1), 100.0 * values.number(2));
    }
    case nests_speak_against_drift:
      return "The floor nests lose their shape: what wanders with the readings is no motion of the tracker as one "
             "body.";
    case moves_while_load_stands:
      return fmt::format(
          "While a load stood the readings moved on by {} rms (t = {:.0f}): {} does not do that, and what creeps looks "
          "like it.",
          lengthWords(values.number(1), 1), values.number(2), nameOfId(values.name(0)));
    case chi_square_significant:
      return fmt::format(
          "What is left is small and yet more than noise: chi2 per equation {:.2f}, by chance no more than {:.2f}.",
          values.number(0), values.number(1));
    case positions_scatter:
      return fmt::format(
          "Unloaded positions scatter little and yet more than noise: {:.2f} times its variance, by chance no more "
          "than {:.2f}.",
          values.number(0), values.number(1));
    case floor_nests:
      return fmt::format("Floor nests: {}.", words(values.remark(0)));
    case positions_take_part:
      return fmt::format("Unloaded absolute positions{} take part in every fit.",
                         values.count(0) != 0 ? " and the sweeps" : "");
    case sweeps_thinned:
      return fmt::format("Of a sweep's readings {} at most took part, spread evenly over it.", values.count(0));
    case postures_thinned:
      return fmt::format("Of {} postures {} took part, spread evenly over those that are loaded.", values.count(0),
                         values.count(1));
    case reflectors_thinned:
      return fmt::format("Of {} reflectors the first {} took part.", values.count(0), values.count(1));
    case spike_hidden:
      return "joint springs and geometry, or the floor nests, hide it here from any size on";
    case posture_that_separates:
      return postureThatSeparates(values);
  }
  return {};
}

}  // namespace stiffscope::reports
