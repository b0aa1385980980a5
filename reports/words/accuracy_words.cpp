#include "reports/words/accuracy_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/io/units.h"
#include "reports/words/calibration_words.h"
#include "reports/words/day_words.h"
#include "reports/words/entry_words.h"
#include "reports/words/listed.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"
#include "reports/words/rich_text.h"
#include "reports/words/unloaded_effect_words.h"

namespace stiffscope::reports {

using calibration::CalibratedModel;

const char* modelWords(CalibratedModel model) {
  switch (model) {
    case CalibratedModel::nominal:
      return "nominal (URDF)";
    case CalibratedModel::geometry:
      return "geometry calibrated";
    case CalibratedModel::gravity:
      return "geometry and own weight";
    case CalibratedModel::effects:
      break;
  }
  return "geometry and effects";
}

const char* shortModelWords(CalibratedModel model) {
  switch (model) {
    case CalibratedModel::nominal:
      return "nominal";
    case CalibratedModel::geometry:
      return "calibrated";
    case CalibratedModel::gravity:
      return "with own weight";
    case CalibratedModel::effects:
      break;
  }
  return "with effects";
}

std::string millimetres(double metres) { return significant(metres / io::kMillimetre, 3) + "\u00a0mm"; }

namespace {

/// "0.158 mm rms (0.283 mm at most)"
std::string errorWords(const calibration::ModelResult& model) {
  const bool held_out = model.held_out.readings > 0;
  const calibration::PositionErrors& errors = held_out ? model.held_out : model.fitted;
  return fmt::format("{} rms ({} at most)", millimetres(errors.rms), millimetres(errors.largest));
}

/// With the audit's sentence: behind what was found, or before it where the audit refuses the day.
std::string withAudit(const ReportCampaign& one, const std::string& found) {
  if (one.audit == nullptr) return found;
  const std::string meaning = auditMeaning(*one.audit, kindOf(one));
  const bool refused = one.audit->verdict == preparation::AuditVerdict::fail;
  return refused ? meaning + " " + found : found + " " + meaning;
}

/// What a verdict names, but what it is not known to be where no effect was asked for.
std::string presentIn(const accuracy::AccuracyDiagnosis& accuracy, const std::vector<accuracy::AccuracyEntry>& of) {
  if (accuracy.effects_asked || of.empty()) return presentWords(of);
  return fmt::format("errors beyond noise whose cause was not asked for: {} postures, which takes {}",
                     accuracy.postures, calibration::kFewestForEffects);
}

/// What the verdict names, a geometry that is not the URDF's said for itself: it is nothing besides the geometry.
std::string foundWords(const accuracy::AccuracyDiagnosis& accuracy) {
  std::vector<accuracy::AccuracyEntry> others = accuracy.verdict;
  std::erase_if(others, [](const accuracy::AccuracyEntry& one) {
    return one.effects == std::vector{calibration::UnloadedEffect::kinematic_error};
  });
  if (others.size() == accuracy.verdict.size())
    return fmt::format("Besides the geometry the readings show {}", presentIn(accuracy, accuracy.verdict));
  std::string text =
      fmt::format("The arm is not as its URDF says ({})", effectName(calibration::UnloadedEffect::kinematic_error));
  if (others.empty()) return text + "; what the calibrated geometry leaves is noise, or too small to matter";
  return text + fmt::format("; besides its geometry the readings show {}", presentIn(accuracy, others));
}

std::string causeSentence(const accuracy::AccuracyDiagnosis& accuracy) {
  if (!accuracy.usable) return fmt::format("No cause can be given: {}.", asIs(words(accuracy.unusable_reason)));
  if (accuracy.verdict.empty()) return "What the calibrated geometry leaves is noise, or too small to matter.";
  return fmt::format("{} (see @{{What the geometry misses}}).", asIs(foundWords(accuracy)));
}

}  // namespace

std::string accuracyVerdict(const ReportCampaign& one) {
  const calibration::Calibration& calibration = one.accuracy->calibration;
  if (!calibration.reason.empty()) {
    return withAudit(one, fmt::format("The day could not be calibrated: {}.", asIs(words(calibration.reason))));
  }
  const bool held_out = calibration.geometry().held_out.readings > 0;
  std::string text = fmt::format("In postures {} the nominal arm of the URDF misses the tracker by {}, ",
                                 held_out ? "that took no part" : "it was fitted to",
                                 errorWords(calibration.of(CalibratedModel::nominal)));
  text += fmt::format("the calibrated geometry by {}", errorWords(calibration.geometry()));
  if (!calibration.best().fit.parts.empty()) text += fmt::format(", with effects {}", errorWords(calibration.best()));
  return withAudit(one, text + ". " + causeSentence(*one.accuracy));
}

double largestLinkDifference(const frames::Frames& frames) {
  double off = 0.0;
  for (const frames::LinkGeometry& link : frames.links) {
    if (link.distance_sd) off = std::max(off, std::abs(link.distance - link.nominal_distance));
  }
  return off;
}

std::string sweepsVerdict(const ReportCampaign& one) {
  const frames::Frames& frames = one.identification.frames;
  const auto measured =
      std::count_if(frames.axes.begin(), frames.axes.end(), [](const auto& axis) { return axis.measured; });
  std::string text;
  if (one.campaign.circle_sweeps) {
    text = fmt::format("{} of {} joint axes are found from their circle sweeps", measured, frames.axes.size());
    const double off = largestLinkDifference(frames);
    if (off > 0.0) text += fmt::format("; distances between neighbours are up to {} off the URDF's", millimetres(off));
    text += ".";
  }
  if (one.campaign.wrist_sweep) {
    if (!text.empty()) text += " ";
    text += frames.wrist.measured ? "The wrist centre is found from its sweep."
                                  : fmt::format("The wrist centre is not found: {}.", words(frames.wrist.reason));
  }
  return withAudit(one, text);
}

std::string accuracyFinding(const accuracy::AccuracyDiagnosis& accuracy) {
  if (accuracy.verdict.empty()) {
    const std::string small = accuracy.size_limit > 0.0 ? fmt::format(" (below {}\u00a0µm rms)",
                                                                      fixed(accuracy.size_limit / io::kMicrometre, 1))
                                                        : std::string();
    return fmt::format(
        "The calibrated geometry is enough for this machine on this day: what it leaves is noise, or too small to "
        "matter{}.",
        small);
  }
  return foundWords(accuracy) + ".";
}

std::string asReadWords() {
  return "The cause is looked for in the readings as they were read; accuracy, axes and places are of the readings "
         "with the station's motion taken off.";
}

std::vector<std::string> accuracyMeanings(const accuracy::AccuracyDiagnosis& accuracy) {
  std::vector<std::string> meanings;
  for (const accuracy::AccuracyEntry& entry : accuracy.verdict) {
    for (const calibration::UnloadedEffect effect : entry.effects) {
      const std::string meaning = fmt::format("{}: {}.", capitalised(effectName(effect)), effectMeaning(effect));
      if (std::find(meanings.begin(), meanings.end(), meaning) == meanings.end()) meanings.push_back(meaning);
    }
  }
  return meanings;
}

namespace {

/// Effects of the model that has all of them, each once.
std::vector<std::string> fittedEffects(const accuracy::AccuracyDiagnosis& accuracy) {
  return accuracy.ofCause().models.empty() ? std::vector<std::string>() : effectIdsOf(accuracy.ofCause().best().fit);
}

}  // namespace

bool onlyVerdictFitted(const accuracy::AccuracyDiagnosis& accuracy) {
  const std::vector<std::string> fitted = fittedEffects(accuracy);
  return std::all_of(fitted.begin(), fitted.end(), [&](const std::string& id) {
    return std::any_of(accuracy.verdict.begin(), accuracy.verdict.end(), [&](const accuracy::AccuracyEntry& entry) {
      return std::any_of(entry.effects.begin(), entry.effects.end(),
                         [&](calibration::UnloadedEffect effect) { return idOf(effect) == id; });
    });
  });
}

std::string fittedNames(const accuracy::AccuracyDiagnosis& accuracy) {
  std::vector<std::string> names;
  for (const std::string& id : fittedEffects(accuracy)) names.push_back(nameOfId(id));
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string accuracyFigures(const accuracy::AccuracyDiagnosis& accuracy) {
  const accuracy::AccuracyGap& gap = accuracy.gap;
  if (!(gap.before > 0.0)) return {};
  const auto shown = [](double metres) { return withMicro(lengthWords(metres, 1)); };
  std::string text = fmt::format("Held out, the calibrated geometry leaves {} rms per coordinate", shown(gap.before));
  if (gap.nominal > 0.0) text += fmt::format(" of the nominal arm's {}", shown(gap.nominal));
  if (gap.noise > 0.0) text += fmt::format("; noise alone is {}", shown(gap.noise));
  if (fittedEffects(accuracy).empty() || !(gap.after > 0.0)) return text + ".";
  text += onlyVerdictFitted(accuracy)
              ? ". With the verdict's effects in the model"
              : fmt::format(". With all fitted effects in the model, also those that the verdict does not name ({}),",
                            fittedNames(accuracy));
  text += fmt::format(" {} are left", shown(gap.after));
  const diagnosis::Shrink& shrink = accuracy.shrink_together;
  if (shrink.high > shrink.low) {
    const int places = placesThatTell(100.0 * shrink.low, 100.0 * shrink.high);
    text += fmt::format(": it shrinks by {} (95\u00a0%: {} to {})", percent(shrink.value, places),
                        fixed(100.0 * shrink.low, places), percent(shrink.high, places));
  }
  return text + ".";
}

std::string stiffnessDoubt(const accuracy::AccuracyDiagnosis& accuracy) {
  const auto found =
      std::find_if(accuracy.classes.begin(), accuracy.classes.end(), [](const accuracy::AccuracyClass& one) {
        return std::any_of(one.parts.begin(), one.parts.end(), [](const calibration::EffectPart& part) {
          return part.effect == calibration::UnloadedEffect::joint_compliance;
        });
      });
  if (!accuracy.usable || found == accuracy.classes.end()) return {};
  if (found->in_verdict && found->effects.size() == 1) return {};
  std::vector<calibration::UnloadedEffect> others = found->effects;
  std::erase(others, calibration::UnloadedEffect::joint_compliance);
  return fmt::format(
      "With care: {}{} (@{{What the geometry misses}}). U is of joints that twist, and of nothing else.",
      found->in_verdict ? "joint compliance is named" : "joint compliance is a candidate only",
      others.empty() ? std::string() : fmt::format(", and {} would explain the same", effectNames(others)));
}

std::vector<std::string> accuracyActions(const accuracy::AccuracyDiagnosis& accuracy) {
  std::vector<std::string> actions;
  const auto add = [&actions](const std::string& action) {
    if (std::find(actions.begin(), actions.end(), action) == actions.end()) actions.push_back(action);
  };
  for (const accuracy::AccuracyEntry& entry : accuracy.verdict) {
    // What was not asked for is not beyond the list of effects.
    if (entry.effects.empty() && accuracy.effects_asked) {
      add("Look for what is not in the list of effects (@{What the geometry misses} shows where and when) before the "
          "arm is trusted to less than what is left.");
    }
    for (const calibration::UnloadedEffect effect : entry.effects) {
      const char* doubt = entry.effects.size() > 1 ? "If it is " : "";
      const std::string name = effectName(effect);
      add(fmt::format("{}{}: {}.", doubt, *doubt ? name : capitalised(name), effectRemedy(effect)));
    }
  }
  for (const Remark& one : accuracy.next) {
    const std::string sentence = capitalised(withMicro(words(one)));
    add(sentence.ends_with('.') ? sentence : sentence + ".");
  }
  const calibration::Calibration& calibration = accuracy.calibration;
  if (calibration.reason.empty() && !calibration.models.empty()) {
    const double nominal = calibration.of(CalibratedModel::nominal).held_out.rms;
    const double geometry = calibration.geometry().held_out.rms;
    if (geometry < nominal) {
      const bool alone = effectIdsOf(calibration.best().fit).empty();
      add(fmt::format(
          "Put the calibrated geometry into the controller or the off-line program: `stiffscope calibrate` writes it "
          "as a URDF (`--urdf`) and as a table of axes (`--csv`){}.",
          alone ? ""
                : ", for one that corrects for nothing else; one that corrects for the effects takes the axes fitted "
                  "with them, from the JSON"));
    }
  }
  return actions;
}

std::string morePartsWords(std::size_t count) {
  return fmt::format("And {} more, smaller or within their U; all of them in the table's CSV file and in {}.", count,
                     kListedInResults);
}

std::vector<std::string> notIdentifiableWords(const calibration::Calibration& calibration) {
  // Remarks read "axis 1 place (u): why"; many have one why.
  std::vector<std::pair<std::string, std::string>> by_reason;
  for (const std::string& remark : words(calibration.not_identifiable)) {
    const std::size_t colon = std::min(remark.find(": "), remark.size());
    const std::string what = remark.substr(0, colon), why = remark.substr(colon);
    const auto known =
        std::find_if(by_reason.begin(), by_reason.end(), [&](const auto& one) { return one.first == why; });
    if (known == by_reason.end())
      by_reason.emplace_back(why, what);
    else
      known->second += ", " + what;
  }
  std::vector<std::string> items;
  for (const auto& [why, what] : by_reason) items.push_back(capitalised(what) + why + ".");
  return items;
}

}  // namespace stiffscope::reports
