#include "reports/words/calibration_words.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "core/calibration/remarks.h"
#include "core/io/units.h"
#include "reports/words/entry_words.h"
#include "reports/words/remark_words.h"
#include "reports/words/remarks.h"

namespace stiffscope::reports {

const char* nameOf(calibration::CalibratedModel model) {
  switch (model) {
    case calibration::CalibratedModel::nominal:
      return "nominal";
    case calibration::CalibratedModel::geometry:
      return "geometry";
    case calibration::CalibratedModel::gravity:
      return "gravity";
    case calibration::CalibratedModel::effects:
      break;
  }
  return "effects";
}

std::vector<std::string> effectIdsOf(const calibration::ArmFit& fit) {
  std::vector<std::string> ids;
  std::size_t k = 0;
  for (const calibration::EffectPart& part : fit.parts) {
    bool in_model = false;
    for (std::size_t t = 0; t < part.terms.size(); ++t) in_model = !fit.refused[k++] || in_model;
    const std::string id(idOf(part.effect));
    if (in_model && std::find(ids.begin(), ids.end(), id) == ids.end()) ids.push_back(id);
  }
  return ids;
}

std::string geometryCaution(const calibration::Calibration& calibration) {
  std::vector<std::string> names;
  for (const std::string& id : effectIdsOf(calibration.best().fit)) names.push_back(nameOfId(id));
  if (names.empty()) return {};
  return fmt::format(
      "The geometry alone has taken in what it could of {}: by it positions are best where nothing else is "
      "corrected for, its axes are not the arm's, and their uncertainty is that of a machine without such effects. "
      "The arm's own axes are those fitted with the effects (axes_with_effects in JSON), for whoever corrects for "
      "the effects, too",
      fmt::join(names, ", "));
}

std::string growthFromWords(const calibration::GrowthFrom& from) {
  if (!from.any()) return {};
  std::string mean, state;
  if (from.temperature_c) {
    mean = fmt::format("{:.1f} degrees C, the mean over the day's postures", *from.temperature_c);
    state = "at that temperature";
  }
  if (from.first_posture) {
    mean += mean.empty() ? "the first posture of the day" : ", and from the first of them";
    state += state.empty() ? "as it then was" : " and time";
  }
  return fmt::format(
      "Growth is counted from {}: the axes fitted with the effects, and the lengths between them, are those of the arm "
      "{}; the geometry alone is that of the day's average",
      mean, state);
}

std::string foldWords(const calibration::CalibrationOptions& options) {
  return fmt::format(
      "held out: each of {} folds predicted by what the others fit; posture i is in fold (i / {}) mod {}",
      options.folds, options.fold_size, options.folds);
}

namespace {

/// What is said of one compliance after the other, of all of an effect at once.
std::vector<Remark> negativeTogether(const std::vector<Remark>& notes) {
  using calibration::RemarkId;
  std::vector<Remark> together;
  for (const Remark& note : notes) {
    const auto same = std::find_if(together.begin(), together.end(), [&note](const Remark& other) {
      return note.is(RemarkId::negative_compliance) && other.is(RemarkId::negative_compliance) &&
             RemarkValues(note).name(0) == RemarkValues(other).name(0);
    });
    if (same == together.end()) {
      together.push_back(note);
      continue;
    }
    *same = Remark(RemarkId::negative_compliance, RemarkValues(note).name(0),
                   fmt::format("{}, {}", RemarkValues(*same).name(1), RemarkValues(note).name(1)));
  }
  for (Remark& note : together) {
    if (note.is(RemarkId::negative_compliance))
      note = Remark(RemarkId::negative_compliance, std::string(RemarkValues(note).name(0)),
                    shortDetail(RemarkValues(note).name(1)));
  }
  return together;
}

}  // namespace

std::vector<std::string> modelNotes(const calibration::Calibration& calibration) {
  std::vector<std::string> notes;
  for (const calibration::ModelResult& model : calibration.models) {
    for (const Remark& note : negativeTogether(model.notes))
      notes.push_back(fmt::format("{}: {}", nameOf(model.model), words(note)));
  }
  return notes;
}

const char* nameOf(calibration::JointAngles angles) {
  return angles == calibration::JointAngles::reported ? "reported" : "commanded";
}

std::string angleWords(const calibration::AngleComparison& angles, calibration::JointAngles used) {
  std::string text = fmt::format(
      "joint angles: the fullest model predicts held-out postures to {:.4f} mm from the reported angles and to {:.4f} "
      "mm from the commanded ones, which differ by up to {:.4f} deg: ",
      angles.reported.rms / io::kMillimetre, angles.commanded.rms / io::kMillimetre, angles.largest / io::kDegree);
  if (!angles.better) return text + "neither fits significantly better";
  text += fmt::format("the {} fit better ({:.1f} standard uncertainties)", nameOf(*angles.better),
                      std::abs(angles.significance));
  if (*angles.better != used) text += fmt::format("; `--angles {}` uses them", nameOf(*angles.better));
  return text;
}

std::string partName(const calibration::EffectPart& part) {
  const std::string name = nameOfId(idOf(part.effect));
  if (part.order) return fmt::format("{} ({}, order {:g})", name, part.detail, *part.order);
  return part.detail.empty() ? name : fmt::format("{} ({})", name, part.detail);
}

std::vector<JointStiffness> stiffnessOf(const calibration::ArmFit& fit) {
  std::vector<JointStiffness> joints(fit.start.size());
  Eigen::Index k = 0;
  for (const calibration::EffectPart& part : fit.parts) {
    for (const calibration::EffectTerm& term : part.terms) {
      const double compliance = fit.sizes[k], sd = fit.sd(static_cast<int>(fit.steps.size() + k));
      // A compliance that may as well be zero is that of no stiffness.
      if (term.compliance_of >= 0 && part.effect == calibration::UnloadedEffect::joint_compliance &&
          compliance > 2.0 * sd) {
        JointStiffness& of = joints.at(static_cast<std::size_t>(term.compliance_of));
        of.value = 1.0 / compliance;
        of.sd = sd / (compliance * compliance);
      }
      ++k;
    }
  }
  return joints;
}

}  // namespace stiffscope::reports
