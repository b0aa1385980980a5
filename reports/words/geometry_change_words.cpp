#include "reports/words/geometry_change_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/io/units.h"

namespace stiffscope::reports {

using comparison::CauseEvidence, comparison::ChangeCause, comparison::NumberKind;

namespace {

constexpr double kMilliradian = 1e-3, kPartPerMillion = 1e-6;

std::string probability(double p) { return p < 1e-4 ? "p < 0.0001" : fmt::format("p {:.4f}", p); }

/// A turn of one unknown, in the units of a controller and of a metrologist.
std::string turnWords(const comparison::Uncertain& turn) {
  return fmt::format("{:.4f} deg ({:.3f} +- {:.3f} mrad)", turn.value / io::kDegree, turn.value / kMilliradian,
                     turn.expanded() / kMilliradian);
}

std::string bestCauseWords(const comparison::GeometryChange& change) {
  const CauseEvidence& best = change.causes.front();
  std::string text =
      fmt::format("{}: {}", change.explained() ? "One cause explains it" : "No single cause explains it; the best is",
                  causeWords(best));
  text += fmt::format(". It takes {:.0f} of chi-square; {} ({})", best.chi2,
                      change.explained() ? "what it leaves is chance" : "what it leaves is more than chance",
                      probability(best.left_p));
  if (change.causes.size() > 1) {
    const CauseEvidence& second = change.causes[1];
    text += fmt::format(". Next: {}, worse by {:.1f} of BIC", causeWords(second), second.bic - best.bic);
  }
  return text + ".";
}

}  // namespace

const char* nameOf(NumberKind kind) {
  switch (kind) {
    case NumberKind::joint_zero:
      return "joint_zero";
    case NumberKind::along:
      return "along";
    case NumberKind::distance:
      return "distance";
    case NumberKind::twist:
      return "twist";
    case NumberKind::off_x:
      return "off_x";
    case NumberKind::off_y:
      return "off_y";
    case NumberKind::tilt_x:
      return "tilt_x";
    case NumberKind::tilt_y:
      return "tilt_y";
    case NumberKind::tilt:
      break;
  }
  return "tilt";
}

std::string nameOf(const CauseEvidence& evidence) {
  switch (evidence.cause) {
    case ChangeCause::joint_zero:
      return "joint_zero";
    case ChangeCause::link:
      return "link";
    case ChangeCause::axis:
      return "axis";
    case ChangeCause::growth:
      return "growth";
    case ChangeCause::reflectors:
      return "reflectors";
    case ChangeCause::turn_about_last:
      break;
  }
  return fmt::format("turn_about_{}", evidence.axis);
}

std::string numberName(const comparison::GeometryNumber& number) {
  const int axis = number.axis, next = axis + 1;
  switch (number.kind) {
    case NumberKind::joint_zero:
      return number.joint > 0 ? fmt::format("zero of joint {}", number.joint) : fmt::format("zero of axis {}", axis);
    case NumberKind::along:
      return fmt::format("axis {} along axis {}", next, axis);
    case NumberKind::distance:
      return fmt::format("distance of axes {} and {}", axis, next);
    case NumberKind::twist:
      return fmt::format("angle of axes {} and {}", axis, next);
    case NumberKind::off_x:
      return fmt::format("axis {} off axis {}, x", next, axis);
    case NumberKind::off_y:
      return fmt::format("axis {} off axis {}, y", next, axis);
    case NumberKind::tilt_x:
      return fmt::format("tilt of axis {} to x of axis {}", next, axis);
    case NumberKind::tilt_y:
      return fmt::format("tilt of axis {} to y of axis {}", next, axis);
    case NumberKind::tilt:
      break;
  }
  return fmt::format("tilt of axis {} against axis {}", next, axis);
}

std::string causeWords(const CauseEvidence& evidence) {
  switch (evidence.cause) {
    case ChangeCause::joint_zero:
      return fmt::format("the zero of joint {} moved by {}{}", evidence.joint, turnWords(*evidence.size),
                         evidence.same_line > 0
                             ? fmt::format(", or what turns axis {} did, which looks the same", evidence.same_line)
                             : std::string());
    case ChangeCause::link:
      return fmt::format("link {} bent: what axis {} and all beyond stand on moved against axis {}", evidence.axis,
                         evidence.axis + 1, evidence.axis);
    case ChangeCause::axis:
      return fmt::format("axis {} moved between its neighbours", evidence.axis);
    case ChangeCause::growth:
      return fmt::format("all lengths of the arm grew by {:.1f} +- {:.1f} ppm", evidence.size->value / kPartPerMillion,
                         evidence.size->expanded() / kPartPerMillion);
    case ChangeCause::reflectors:
      return "reflectors sit elsewhere on the flange";
    case ChangeCause::turn_about_last:
      break;
  }
  if (evidence.joint == 0)
    return fmt::format("all reflectors turned about axis {}: {}", evidence.axis, turnWords(*evidence.size));
  return fmt::format("all reflectors turned about axis {}, or the zero of joint {} moved, which looks the same: {}",
                     evidence.axis, evidence.joint, turnWords(*evidence.size));
}

std::vector<std::string> changeWords(const comparison::GeometryChange& change) {
  std::vector<std::string> sentences;
  const double moved = change.at_targets / io::kMillimetre, chance = change.at_targets_sd / io::kMillimetre;
  if (change.machine_changed) {
    sentences.push_back(fmt::format(
        "The machine changed: {} of an unchanged one, {} numbers together. The reflectors stand {:.3f} mm (rms) "
        "elsewhere by it, base and reflectors fitted again; chance alone makes {:.3f} mm.",
        probability(change.machine_p), change.unknowns, moved, chance));
  } else {
    sentences.push_back(fmt::format(
        "{} changed beyond chance: {}, {} numbers together. A change of all of {:.3f} mm (rms) at the reflectors is "
        "what chance makes.",
        change.effects_changed ? "No length, angle or zero of the arm" : "Nothing of the machine",
        probability(change.machine_p), change.unknowns, chance));
  }
  if (change.effects_changed)
    sentences.push_back(fmt::format("What the model has beside the geometry did change ({} of the same sizes): {}.",
                                    probability(change.effects_p), fmt::join(change.effects, ", ")));
  if (change.reflectors_moved) {
    const bool turned = !change.causes.empty() && change.causes.front().cause == ChangeCause::turn_about_last &&
                        change.causes.front().joint > 0;
    sentences.push_back(fmt::format(
        "Reflectors moved on the flange ({}), which is no change of the machine{}.", probability(change.reflectors_p),
        turned ? fmt::format(" unless joint {}'s zero moved", change.causes.front().joint) : std::string()));
  } else if (!change.reflectors.empty()) {
    sentences.push_back(fmt::format("Reflectors did not move beyond chance ({}).", probability(change.reflectors_p)));
  }
  if (!change.causes.empty()) sentences.push_back(bestCauseWords(change));
  return sentences;
}

}  // namespace stiffscope::reports
