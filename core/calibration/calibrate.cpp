#include "core/calibration/calibrate.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "core/calibration/fitted_day.h"
#include "core/effects/effect.h"
#include "core/numerics/parallel.h"

namespace stiffscope::calibration {

namespace {

/// All models of one set of postures.
struct ModelFits {
  bool placed = false;
  std::vector<std::pair<CalibratedModel, ArmFit>> fits;
  SelectedEffects selected;
};

std::function<int(int)> innerFolds(const CalibrationOptions& options, int inner, int postures) {
  // Blocks that hold one piece of every fold: of each fold's others every inner fold has its share. Where there are too
  // few postures for that, smaller ones: no inner fold may be empty.
  int block = std::max(1, options.folds * options.fold_size);
  if ((inner - 1) * block >= postures) block = std::max(1, postures / (2 * inner));
  return [block, inner](int pose) { return (pose / block) % inner; };
}

/// Whether the scatter fell so far that a small effect or a wrong reading may have hidden in it. On long days there are
/// so many readings that none does.
bool worthAnotherLook(const ArmFit& geometry, const ArmFit& effects, const SelectionOptions& options) {
  constexpr double kMuchLess = 0.7;
  const std::size_t postures =
      geometry.weights.size() / std::max<std::size_t>(1, geometry.place.targets_at_zero.size());
  return !effects.parts.empty() && postures <= options.search_postures &&
         effects.model_sd < kMuchLess * geometry.model_sd;
}

/// Readings as an arm would show them that has the axes, base and reflectors of a fit and no effects.
UnloadedDay asRigid(const UnloadedDay& day, ArmFit fit) {
  fit.parts.clear();
  fit.stations.clear();
  fit.sizes.resize(0);
  const Eigen::Isometry3d points_from_base = fit.place.base_from_points.inverse();
  const FittedDay fitted(day, fit);
  UnloadedDay rigid = day;
  numerics::smallWorkOnAllCores(rigid.postures.size(), [&](std::size_t i) {
    Posture& posture = rigid.postures[i];
    const frames::PlacedPosture placed(fitted.arm(), posture.q);
    for (Reading& reading : posture.readings)
      reading.point = points_from_base * fitted.reflector(placed, reading).position;
  });
  return rigid;
}

/// See Calibration::nominal_misses.
double nominalMisses(const UnloadedDay& day, const ArmFit& found) {
  const UnloadedDay rigid = asRigid(day, found);
  const FitOptions options{.axes = false, .robust = false, .weights = found.weights};
  const ArmFit nominal = fitArm(rigid, found.place, {}, options);
  PositionErrors errors;
  addErrors(residualsOf(rigid, nominal), found.weights, errors);
  return errors.rms / std::sqrt(3.0);
}

ModelFits fitModels(const UnloadedDay& day, const std::vector<double>& weights, const CalibrationOptions& options,
                    int divisions = 0) {
  ModelFits models;
  const auto place = placeArm(day, weights);
  if (!place) return models;
  models.placed = true;
  const ArmFit first = fitArm(day, *place, {}, {.weights = weights});
  SelectionOptions selection;
  selection.inner_fold = innerFolds(options, selection.inner_folds, static_cast<int>(day.pose_ids.size()));
  selection.outer_folds = options.folds;
  selection.outer_fold = [&](int pose) { return foldOf(pose, options); };
  selection.divisions = divisions;
  SelectedEffects selected = selectEffects(day, first, selection);
  ArmFit effects = fitArm(day, *place, selected.parts, {.weights = weights}, &first);
  if (worthAnotherLook(first, effects, selection)) {
    // What hid in the scatter that those effects made: the geometry with their fit's noise and right readings.
    ArmFit again = fitArm(day, *place, {}, {.robust = false, .weights = effects.weights}, &first);
    again.model_sd = effects.model_sd;
    selected = selectEffects(day, again, selection);
    effects = fitArm(day, *place, selected.parts, {.weights = weights}, &first);
  }
  models.selected = std::move(selected);
  const FitOptions right{.robust = false, .weights = effects.weights};
  const FitOptions without_axes{.axes = false, .robust = false, .weights = effects.weights};
  ArmFit geometry = fitArm(day, *place, {}, right, &first);
  models.fits.emplace_back(CalibratedModel::nominal, fitArm(day, *place, {}, without_axes));
  if (day.masses_known) {
    ArmFit gravity = fitArm(day, *place, jointCompliances(day), right, &geometry);
    models.fits.emplace_back(CalibratedModel::geometry, std::move(geometry));
    models.fits.emplace_back(CalibratedModel::gravity, std::move(gravity));
  } else {
    models.fits.emplace_back(CalibratedModel::geometry, std::move(geometry));
  }
  models.fits.emplace_back(CalibratedModel::effects, std::move(effects));
  return models;
}

/// Of the declared tracker, rms per coordinate.
double noiseOf(const UnloadedDay& day, const std::vector<double>& weights) {
  double sum = 0.0, used = 0.0;
  std::size_t at = 0;
  for (const Posture& posture : day.postures) {
    for (const Reading& reading : posture.readings) {
      if (weights[at++] > 0.0) sum += reading.covariance.trace() / 3.0, ++used;
    }
  }
  return std::sqrt(sum / std::max(1.0, used));
}

std::vector<preparation::RejectedReading> rejectedOf(const campaign::Campaign& campaign, const UnloadedDay& day,
                                                     const ArmFit& fit) {
  std::vector<preparation::RejectedReading> rejected;
  const std::vector<Eigen::Vector3d> residuals = residualsOf(day, fit);
  std::size_t at = 0;
  for (const Posture& posture : day.postures) {
    for (const Reading& reading : posture.readings) {
      if (fit.weights[at] <= 0.0)
        rejected.push_back(
            {campaign.loading->file, reading.line, Remark(RemarkId::off_the_model, residuals[at].norm())});
      ++at;
    }
  }
  return rejected;
}

std::vector<Remark> notIdentifiable(const ArmFit& fit) {
  std::vector<Remark> remarks;
  for (int k = 0; k < fit.places().axes(); ++k) {
    const int axis = k / 4 + 1, which = k % 4;
    if (std::find(fit.held.begin(), fit.held.end(), k) != fit.held.end()) {
      // Base and joint 1's zero take all of axis 1 and two numbers of axis 2.
      remarks.push_back(Remark(axis <= 2 ? RemarkId::choice_of_frame : RemarkId::not_seen, axis, which));
      continue;
    }
    constexpr double kOfPrior = 0.5;
    const double prior = which < 2 ? kAxisShiftPrior : kAxisTiltPrior;
    if (fit.sd(k) > kOfPrior * prior) remarks.push_back(Remark(RemarkId::hardly_seen, axis, which, fit.sd(k)));
  }
  return remarks;
}

std::vector<Remark> notesOf(CalibratedModel model, const ArmFit& fit, std::size_t postures) {
  std::vector<Remark> notes;
  std::size_t k = 0;
  for (const EffectPart& part : fit.parts) {
    for (const EffectTerm& term : part.terms) {
      if (fit.refused[k++])
        notes.push_back(Remark(RemarkId::negative_compliance, std::string(idOf(part.effect)), term.name));
    }
  }
  if (model == CalibratedModel::effects && fit.parts.empty()) {
    notes.push_back(postures < kFewestForEffects ? Remark(RemarkId::too_few_for_effects, postures, kFewestForEffects)
                                                 : Remark(RemarkId::no_effect_predicts));
  }
  return notes;
}

}  // namespace

const ModelResult& Calibration::of(CalibratedModel model) const {
  for (const ModelResult& one : models) {
    if (one.model == model) return one;
  }
  throw std::out_of_range("no such model in this calibration");
}

namespace {

/// As a fit has them.
OwnCompliances compliancesOf(const UnloadedDay& day, const ArmFit& fit) {
  OwnCompliances own{JointVector::Zero(day.arm.joints()),
                     Eigen::VectorXd::Zero(static_cast<Eigen::Index>(day.bending.size()))};
  Eigen::Index next = 0;
  for (const EffectPart& part : fit.parts) {
    for (const EffectTerm& term : part.terms) {
      const double size = fit.sizes[next++];
      if (term.compliance_of >= 0) own.joints[term.compliance_of] += size;
      for (std::size_t k = 0; k < day.bending.size(); ++k) {
        const BendingTerm& of = day.bending[k];
        if (effects::kEffectIds[of.effect] == idOf(part.effect) && of.name == term.name)
          own.bending[static_cast<Eigen::Index>(k)] += size;
      }
    }
  }
  return own;
}

/// Joint compliances by the own weight beside the geometry, without other effects: good to what those take from them,
/// and the sag changes the torques by a thousandth.
std::optional<OwnCompliances> compliancesAlone(const UnloadedDay& day) {
  const std::vector<double> all = weightsWhere(day, [](int) { return true; });
  const auto place = placeArm(day, all);
  if (!place) return std::nullopt;
  const ArmFit geometry = fitArm(day, *place, {}, {.weights = all});
  const ArmFit gravity = fitArm(day, *place, jointCompliances(day), {.weights = all}, &geometry);
  if (!gravity.done) return std::nullopt;
  return compliancesOf(day, gravity);
}

/// Whether anything that both fits found is another by more than a tenth of its standard uncertainty.
bool differ(const ArmFit& one, const ArmFit& other) {
  constexpr double kShare = 0.1;
  if (one.free != other.free) return true;
  const auto all = [](const ArmFit& fit) {
    Eigen::VectorXd values(fit.steps.size() + fit.sizes.size());
    values << fit.steps, fit.sizes;
    return values;
  };
  const Eigen::VectorXd change = all(one) - all(other);
  return std::any_of(other.free.begin(), other.free.end(),
                     [&](int place) { return std::abs(change[place]) > kShare * other.sd(place); });
}

/// All models of the whole day. Where what bearings, links and base give under the weight changes how it pulls on them,
/// the arm is let sag by them, too, and effects are sought once more. Once is enough: what a first fit errs by is a
/// twentieth of them, and a twentieth of that changes nothing.
ModelFits fitWholeDay(UnloadedDay& day, const CalibrationOptions& options) {
  const std::vector<double> all = weightsWhere(day, [](int) { return true; });
  ModelFits models = fitModels(day, all, options, options.divisions);
  if (!models.placed) return models;
  const ArmFit& rigid = models.fits.back().second;
  const OwnCompliances own = compliancesOf(day, rigid);
  if (!rigid.done || own.bending.isZero(0.0)) return models;
  UnloadedDay sagged = day;
  letSag(own, sagged);
  const ArmFit fit = fitArm(sagged, rigid.place, rigid.parts, {.robust = false, .weights = rigid.weights}, &rigid);
  if (!fit.done || !differ(rigid, fit)) return models;
  letSag(compliancesOf(day, fit), sagged);
  ModelFits again = fitModels(sagged, all, options, options.divisions);
  // What does not last was no compliance.
  if (!again.placed || compliancesOf(day, again.fits.back().second).bending.isZero(0.0)) return models;
  day = std::move(sagged);
  return again;
}

Calibration calibrateBy(const campaign::Campaign& campaign, const CalibrationOptions& options) {
  Calibration result;
  result.day = unloadedDay(campaign, options.angles);
  UnloadedDay& day = result.day;
  const std::size_t readings = day.readings();
  if (readings == 0) {
    result.reason = Remark(RemarkId::no_unloaded_readings);
    return result;
  }
  const Eigen::Index parameters =
      frames::ArmParameters(day.arm.axes()).count(day.targets.size()) - frames::ArmParameters::kBase;
  if (3 * static_cast<Eigen::Index>(readings) <= parameters) {
    result.reason = Remark(RemarkId::too_few_readings, readings, parameters);
    return result;
  }

  if (day.masses_known) {
    if (const auto compliance = compliancesAlone(day)) letSag(*compliance, day);
  }

  // The whole day first, then each fold's others, without the readings that the whole day rejects.
  std::vector<ModelFits> fits(static_cast<std::size_t>(options.folds) + 1);
  fits.front() = fitWholeDay(day, options);
  if (!fits.front().placed) {
    result.reason = Remark(RemarkId::not_placed);
    return result;
  }
  const std::vector<double> right = fits.front().fits.back().second.weights;
  numerics::onAllCores(static_cast<std::size_t>(options.folds), [&](std::size_t fold) {
    std::vector<double> others =
        weightsWhere(day, [&](int pose) { return foldOf(pose, options) != static_cast<int>(fold); });
    for (std::size_t i = 0; i < others.size(); ++i) others[i] *= right[i];
    fits[fold + 1] = fitModels(day, others, options);
  });
  result.selected = std::move(fits.front().selected);
  for (std::size_t k = 1; k < fits.size(); ++k)
    result.selected_by_others.push_back(std::move(fits[k].selected.effects));
  result.noise = noiseOf(day, right);
  for (std::size_t m = 0; m < fits.front().fits.size(); ++m) {
    ModelResult model;
    model.model = fits.front().fits[m].first;
    model.fit = std::move(fits.front().fits[m].second);
    if (!model.fit.done) {
      result.reason = Remark(RemarkId::not_settling);
      return result;
    }
    addErrors(residualsOf(day, model.fit), right, model.fitted);
    model.held_out_residuals.assign(readings, Eigen::Vector3d::Constant(std::nan("")));
    bool all_predicted = true;
    for (int fold = 0; fold < options.folds; ++fold) {
      const ModelFits& others = fits[static_cast<std::size_t>(fold) + 1];
      std::vector<double> of_fold = weightsWhere(day, [&](int pose) { return foldOf(pose, options) == fold; });
      if (std::all_of(of_fold.begin(), of_fold.end(), [](double weight) { return weight == 0.0; })) continue;
      all_predicted = all_predicted && others.placed;
      if (!others.placed) continue;
      const std::vector<Eigen::Vector3d> residuals = residualsOf(day, others.fits[m].second, of_fold);
      for (std::size_t i = 0; i < of_fold.size(); ++i) {
        if (of_fold[i] > 0.0) model.held_out_residuals[i] = residuals[i];
        of_fold[i] *= right[i];
      }
      addErrors(residuals, of_fold, model.held_out);
    }
    if (!all_predicted || model.held_out.readings == 0) {
      // Of some postures alone it would be held against figures of all.
      model.held_out = {std::nan(""), std::nan(""), 0};
      model.held_out_residuals.assign(readings, Eigen::Vector3d::Constant(std::nan("")));
    }
    model.notes = notesOf(model.model, model.fit, day.postures.size());
    result.models.push_back(std::move(model));
  }
  result.rejected = rejectedOf(campaign, day, result.best().fit);
  result.nominal_misses = nominalMisses(day, result.best().fit);
  result.not_identifiable = notIdentifiable(result.geometry().fit);
  if (!day.masses_known) result.notes.push_back(Remark(RemarkId::no_masses));
  return result;
}

}  // namespace

Calibration calibrate(const campaign::Campaign& campaign, const CalibrationOptions& options) {
  Calibration result = calibrateBy(campaign, options);
  const double largest = largestDifference(campaign);
  if (!result.reason.empty() || largest == 0.0) return result;
  CalibrationOptions otherwise = options;
  const bool by_report = options.angles == JointAngles::reported;
  otherwise.angles = by_report ? JointAngles::commanded : JointAngles::reported;
  const Calibration other = calibrateBy(campaign, otherwise);
  if (!other.reason.empty()) return result;
  const Calibration &reported = by_report ? result : other, &commanded = by_report ? other : result;
  result.angles = compareAngles(result.day, {reported.best().fit.weights, reported.best().held_out_residuals},
                                {commanded.best().fit.weights, commanded.best().held_out_residuals});
  result.angles->joints = commandedJoints(campaign);
  result.angles->largest = largest;
  return result;
}

Calibration calibrate(const preparation::PreparedCampaign& prepared, const CalibrationOptions& options) {
  const preparation::NoiseModel& noise = prepared.noise;
  if (!prepared.preparation.declared || !noise.known || !(noise.degrees > 0.0))
    return calibrate(prepared.campaign, options);
  campaign::Campaign campaign = prepared.campaign;
  campaign.tracker = preparation::asNoisyAs(*prepared.preparation.declared, {noise.along_factor, noise.across_factor});
  return calibrate(campaign, options);
}

}  // namespace stiffscope::calibration
