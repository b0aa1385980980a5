#include "core/accuracy/diagnose_accuracy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <utility>

#include "core/accuracy/where_next.h"
#include "core/calibration/family_fit.h"
#include "core/numerics/resampling.h"

namespace stiffscope::accuracy {

namespace {

using calibration::Calibration;
using calibration::SelectedEffect;

constexpr double kNominalLimit =
    0.7e-3;  ///< m rms per coordinate, 1.2 mm in space: uncalibrated arms in order do better

/// An effect that moves the reflectors by less than this share of the readings' noise does not matter.
constexpr double kLeastSize = 0.4;

/// An effect of which this score is expected in what each fold leaves of the day has to be there: odds of four to one.
constexpr double kEnough = 3.0;

/// Beside `unknown` an effect is named where no more than this share of the gap's squares beyond noise stays.
constexpr double kMostLeft = 0.25;

double rmsOf(const std::vector<double>& squares) {
  return std::sqrt(std::accumulate(squares.begin(), squares.end(), 0.0));
}

/// 1 - after / before of held-out squares by posture. The interval has what resampling the postures does to it, and
/// what other divisions into folds do, whose sums are `before_by` and `after_by`, that of these squares first (none:
/// the postures alone): the postures say nothing of what the fits to the other folds have in common.
diagnosis::Shrink shrinkOf(const std::vector<double>& before, const std::vector<double>& after,
                           const std::vector<double>& before_by, const std::vector<double>& after_by) {
  diagnosis::Shrink shrink;
  // Too few postures to choose effects from: nothing was held out, nothing shrinks.
  if (before.empty()) return shrink;
  const auto of = [](double was, double is) { return was > 0.0 ? 1.0 - std::sqrt(is / was) : 0.0; };
  shrink.value = of(rmsOf(before) * rmsOf(before), rmsOf(after) * rmsOf(after));
  constexpr int kSamples = 1000;
  constexpr std::uint64_t kSeed = 1;
  std::mt19937_64 random(kSeed);
  std::vector<double> values;
  for (int sample = 0; sample < kSamples; ++sample) {
    double was = 0.0, is = 0.0;
    numerics::drawWithReplacement(random, before.size(), [&](std::size_t k) { was += before[k], is += after[k]; });
    if (!before_by.empty()) {
      const std::size_t division = static_cast<std::size_t>(sample) % before_by.size();
      was *= before_by[division] / before_by.front();
      is *= after_by[division] / after_by.front();
    }
    values.push_back(of(was, is));
  }
  // About the draws' own middle, which is of all divisions, and the value of one.
  const numerics::BootstrapSpread spread =
      numerics::bootstrapSpread(std::move(values), static_cast<double>(before.size()));
  shrink.low = std::min(shrink.value, spread.middle - spread.below);
  shrink.high = std::min(1.0, std::max(shrink.value, spread.middle + spread.above));
  return shrink;
}

/// Squares of a model's held-out residuals by posture, readings that were rejected left out.
std::vector<double> heldOutSquares(const Calibration& calibration, const calibration::ModelResult& model) {
  std::vector<double> squares;
  std::size_t at = 0;
  for (const calibration::Posture& posture : calibration.day.postures) {
    double sum = 0.0;
    for (std::size_t k = 0; k < posture.readings.size(); ++k, ++at) {
      if (calibration.best().fit.weights[at] > 0.0 && model.held_out_residuals[at].allFinite())
        sum += model.held_out_residuals[at].squaredNorm();
    }
    squares.push_back(sum);
  }
  return squares;
}

/// The same in variance, less noise: shares of the gap's squares beyond noise.
double explainedOf(double before, double after, double noise) {
  const double gap = before * before - noise * noise;
  return gap > 0.0 ? std::clamp((before * before - after * after) / gap, 0.0, 1.0) : 0.0;
}

class Decider {
 public:
  Decider(const preparation::PreparedCampaign& prepared, AccuracyDiagnosis& result)
      : prepared_(prepared), calibration_(result.ofCause()), result_(result) {}

  void run() {
    measureGap();
    for (const SelectedEffect& one : calibration_.selected.effects) judge(one);
    nameGeometry();
    nameUnknown();
    explain();
    sortClasses();
  }

 private:
  static double whole(const calibration::ArmFit& fit, double noise) { return std::hypot(noise, fit.model_sd); }

  void measureGap() {
    const double per_coordinate = std::sqrt(1.0 / 3.0);
    AccuracyGap& gap = result_.gap;
    gap.noise = calibration_.noise;
    gap.nominal = per_coordinate * calibration_.of(calibration::CalibratedModel::nominal).held_out.rms;
    gap.before = per_coordinate * calibration_.geometry().held_out.rms;
    gap.after = per_coordinate * calibration_.best().held_out.rms;
    before_ = whole(calibration_.geometry().fit, gap.noise);
    after_ = whole(calibration_.best().fit, gap.noise);
    result_.size_limit = kLeastSize * gap.noise;
    // Degrees of freedom: of the readings with the effects, and of what the noise was found from.
    const double rows = 3.0 * static_cast<double>(calibration_.best().fitted.readings);
    const double free = std::max(1.0, rows - calibration_.best().fit.parameters);
    const double degrees = prepared_.noise.degrees;
    constexpr double kSigmas = 3.0, kAsDeclared = 1.6;  // declared noise is right to a quarter
    result_.left_over = gap.noise > 0.0 ? after_ * after_ / (gap.noise * gap.noise) : 0.0;
    result_.left_over_limit = degrees > 0.0 ? 1.0 + kSigmas * std::sqrt(2.0 / free + 2.0 / degrees)
                                            : kAsDeclared + kSigmas * std::sqrt(2.0 / free);
  }

  static bool names(const SelectedEffect& one, UnloadedEffect effect) {
    return one.effect == effect || std::find(one.together.begin(), one.together.end(), effect) != one.together.end() ||
           std::any_of(one.rivals.begin(), one.rivals.end(),
                       [&](const calibration::Rival& rival) { return rival.effect == effect; });
  }

  /// The score that is to be expected where a fold's others choose, which let four fifths of themselves predict the
  /// rest: the likelihood falls with the equations that the geometry leaves free, of which half of a small day has much
  /// less than half, and the price of the terms does not. Below any where those equations are too few for the terms.
  double expectedInOthers(const SelectedEffect& one) const {
    const calibration::ArmFit& fit = calibration_.best().fit;
    const double rows = 3.0 * static_cast<double>(calibration_.best().fitted.readings);
    const double geometry = calibration_.geometry().fit.parameters, terms = static_cast<double>(fit.sizes.size());
    const double folds = static_cast<double>(calibration_.selected_by_others.size());
    const double predicting = 1.0 - 1.0 / calibration::SelectionOptions().inner_folds;
    const double of_all = rows - geometry, of_others = predicting * (1.0 - 1.0 / folds) * rows - geometry;
    if (terms > calibration::kMostSpent * of_others) return -std::numeric_limits<double>::infinity();
    double penalty = 0.0;
    for (const calibration::EffectPart& part : fit.parts) {
      if (part.effect == one.effect ||
          std::find(one.together.begin(), one.together.end(), part.effect) != one.together.end())
        penalty += part.penalty;
    }
    const double price = penalty + calibration::kPriceOfEffect;
    return (one.score + price) * of_others / of_all - penalty * calibration::dearerBy(terms, of_others) -
           calibration::kPriceOfEffect;
  }

  bool inEveryFold(const SelectedEffect& one) const {
    return std::all_of(calibration_.selected_by_others.begin(), calibration_.selected_by_others.end(),
                       [&](const std::vector<SelectedEffect>& others) {
                         return std::any_of(others.begin(), others.end(), [&](const SelectedEffect& other) {
                           return names(other, one.effect) || names(one, other.effect);
                         });
                       });
  }

  /// What starts where too few postures stand on one side for the others of a fold to find it.
  bool startsAside(UnloadedEffect effect) const {
    constexpr std::ptrdiff_t kEnough = 20;
    const auto& postures = calibration_.day.postures;
    return std::any_of(calibration_.selected.parts.begin(), calibration_.selected.parts.end(), [&](const auto& part) {
      if (part.effect != effect || !part.from) return false;
      const auto later = std::count_if(postures.begin(), postures.end(),
                                       [&](const calibration::Posture& posture) { return posture.time >= *part.from; });
      return std::min(later, static_cast<std::ptrdiff_t>(postures.size()) - later) < kEnough;
    });
  }

  void judge(const SelectedEffect& one) {
    AccuracyClass found;
    found.effects.push_back(one.effect);
    found.effects.insert(found.effects.end(), one.together.begin(), one.together.end());
    for (const calibration::Rival& rival : one.rivals) found.effects.push_back(rival.effect);
    found.detail = one.detail;
    found.score = one.score;
    found.shrink =
        shrinkOf(calibration_.selected.before, one.held_out, calibration_.selected.before_by_division, one.by_division);
    found.explained =
        explainedOf(result_.gap.before, (1.0 - found.shrink.value) * result_.gap.before, result_.gap.noise);
    addFitted(one.effect, found);
    for (const UnloadedEffect effect : one.together) addFitted(effect, found);
    const std::string id(idOf(one.effect));
    found.size = one.size;
    found.in_verdict = true;
    if (found.size < result_.size_limit) {
      found.in_verdict = false;
      result_.reasons.emplace_back(RemarkId::too_small, id, found.size, result_.size_limit);
    } else if (expectedInOthers(one) > kEnough && !startsAside(one.effect) && !inEveryFold(one)) {
      found.in_verdict = false;
      withdrawn_ = std::hypot(withdrawn_, found.size);
      result_.reasons.emplace_back(RemarkId::not_in_every_fold, id);
    }
    result_.classes.push_back(std::move(found));
  }

  void addFitted(UnloadedEffect effect, AccuracyClass& found) const {
    const calibration::ArmFit& fit = calibration_.best().fit;
    Eigen::Index k = 0;
    for (const calibration::EffectPart& part : fit.parts) {
      if (part.effect == effect) found.parts.push_back(part);
      for (std::size_t term = 0; term < part.terms.size(); ++term, ++k) {
        if (part.effect != effect) continue;
        found.sizes.push_back(fit.sizes[k]);
        found.sds.push_back(fit.sd(static_cast<int>(fit.steps.size() + k)));
      }
    }
  }

  void nameGeometry() {
    result_.geometry_limit = kNominalLimit;
    const double off = calibration_.nominal_misses;
    if (off <= kNominalLimit) return;
    result_.geometry_off_nominal = true;
    AccuracyClass one;
    one.effects = {UnloadedEffect::kinematic_error};
    one.score = off * off / (kNominalLimit * kNominalLimit) * 3.0 * static_cast<double>(calibration_.day.readings());
    one.size = off;
    one.shrink = shrinkOf(heldOutSquares(calibration_, calibration_.of(calibration::CalibratedModel::nominal)),
                          heldOutSquares(calibration_, calibration_.geometry()), {}, {});
    one.explained = explainedOf(result_.gap.nominal, result_.gap.before, result_.gap.noise);
    one.in_verdict = true;
    result_.classes.push_back(std::move(one));
    result_.reasons.emplace_back(RemarkId::geometry_off_nominal, off, kNominalLimit);
  }

  /// What stays is `unknown` where noise does not explain it and it matters: against the noise, and against what was
  /// removed, since no effect of the vocabulary is exactly what a machine does.
  void nameUnknown() {
    const double noise = result_.gap.noise;
    // What was withdrawn explains nothing.
    const double left = std::hypot(calibration_.best().fit.model_sd, withdrawn_);
    const double removed = std::sqrt(std::max(0.0, before_ * before_ - after_ * after_ - withdrawn_ * withdrawn_));
    constexpr double kShareOfRemoved = 0.2;
    const double limit = std::max(result_.size_limit, kShareOfRemoved * removed);
    if (result_.left_over <= result_.left_over_limit && withdrawn_ == 0.0) return;
    // What is smaller than what nothing explains may be a part of that.
    for (AccuracyClass& one : result_.classes) {
      if (!one.in_verdict || one.effects.front() == UnloadedEffect::kinematic_error || one.size >= left) continue;
      one.in_verdict = false;
      result_.reasons.emplace_back(RemarkId::less_than_unknown, std::string(idOf(one.effects.front())), one.size, left);
    }
    if (left <= limit) return;
    unknown_ = true;
    result_.reasons.emplace_back(result_.effects_asked ? RemarkId::not_explained : RemarkId::not_looked_into, left,
                                 limit);
    const double stays = 1.0 - explainedOf(before_, std::min(before_, std::hypot(after_, withdrawn_)), noise);
    if (stays <= kMostLeft) return;
    std::vector<std::string> candidates;
    for (AccuracyClass& one : result_.classes) {
      if (!one.in_verdict || one.effects.front() == UnloadedEffect::kinematic_error) continue;
      one.in_verdict = false;
      candidates.emplace_back(idOf(one.effects.front()));
    }
    if (!candidates.empty()) result_.reasons.emplace_back(RemarkId::candidates_only, candidates, stays, kMostLeft);
  }

  void explain() {
    std::vector<Remark> first{Remark(RemarkId::left_by_geometry, before_, result_.gap.noise)};
    if (!result_.effects_asked) {
      first.emplace_back(RemarkId::effects_not_asked, result_.postures, calibration::kFewestForEffects);
    } else if (calibration_.selected.effects.empty()) {
      first.emplace_back(RemarkId::no_effect_passes, result_.size_limit);
    }
    const preparation::DriftModel& nests = prepared_.drift;
    if (nests.moved()) {
      first.emplace_back(RemarkId::nests_show_station, nests.course == preparation::StationCourse::jumped,
                         nests.moved_by);
    } else if (nests.course == preparation::StationCourse::still) {
      first.emplace_back(RemarkId::nests_stand);
    }
    first.insert(first.end(), result_.reasons.begin(), result_.reasons.end());
    result_.reasons = std::move(first);
  }

  /// The station from which all is read since the frame moved, and nothing before; empty where there is none such.
  std::string stationTakenUp(const AccuracyClass& one) const {
    const calibration::UnloadedDay& day = calibration_.day;
    if (day.stations.size() < 2 || one.parts.empty() || !one.parts.front().from) return {};
    std::set<int> before, since;
    for (const calibration::Posture& posture : day.postures) {
      for (const calibration::Reading& reading : posture.readings)
        (posture.time < *one.parts.front().from ? before : since).insert(reading.place);
    }
    if (since.size() != 1 || before.contains(*since.begin())) return {};
    return preparation::shownStation(day.stations[static_cast<std::size_t>(*since.begin())]);
  }

  /// What the verdict names before what it does not, each by score; the verdict is made of the former.
  void sortClasses() {
    std::stable_sort(result_.classes.begin(), result_.classes.end(),
                     [](const AccuracyClass& a, const AccuracyClass& b) {
                       return std::pair(a.in_verdict, a.score) > std::pair(b.in_verdict, b.score);
                     });
    for (const AccuracyClass& one : result_.classes) {
      if (!one.in_verdict) continue;
      AccuracyEntry entry{one.effects, one.detail};
      if (one.effects.front() == UnloadedEffect::frame_error) {
        if (prepared_.drift.moved()) entry.detail = "station";
        if (prepared_.drift.course == preparation::StationCourse::still) entry.detail = "robot";
        // The nests, too, may have moved between two stations, which then do not stand as they were joined.
        const std::string taken_up = stationTakenUp(one);
        if (!taken_up.empty() && entry.detail != "station") entry.detail = "robot or " + taken_up;
      }
      result_.verdict.push_back(std::move(entry));
    }
    if (unknown_) result_.verdict.push_back({{}, ""});
  }

  const preparation::PreparedCampaign& prepared_;
  const Calibration& calibration_;
  AccuracyDiagnosis& result_;
  double before_ = 0.0, after_ = 0.0;  ///< rms per coordinate by the fits to the whole day, noise included
  double withdrawn_ = 0.0;             ///< of effects that not every fold confirms
  bool unknown_ = false;
};

/// Effects of the vocabulary that this day cannot be asked for.
void addUntestable(const calibration::UnloadedDay& day, AccuracyDiagnosis& result) {
  const auto missing = [&](UnloadedEffect effect, RemarkId what) {
    result.not_testable.push_back({effect, Remark(what)});
  };
  if (!day.masses_known) {
    for (const UnloadedEffect effect : {UnloadedEffect::link_compliance, UnloadedEffect::bearing_tilt,
                                        UnloadedEffect::base_compliance, UnloadedEffect::gravity_compensator})
      missing(effect, RemarkId::needs_masses);
  }
}

}  // namespace

AccuracyDiagnosis diagnoseAccuracy(const preparation::PreparedCampaign& prepared,
                                   const calibration::CalibrationOptions& options) {
  AccuracyDiagnosis result;
  result.calibration = calibration::calibrate(prepared, options);
  // A station that moved is a cause, which is not there any more where it was taken off.
  if (prepared.preparation.drift.taken_off)
    result.as_read = calibration::calibrate(preparation::asMeasured(prepared), options);
  const Calibration& calibration = result.ofCause();
  result.unusable_reason = result.calibration.reason.empty() ? calibration.reason : result.calibration.reason;
  result.usable = result.unusable_reason.empty();
  if (!result.usable) return result;
  result.postures = static_cast<int>(calibration.day.postures.size());
  result.effects_asked = calibration.day.postures.size() >= calibration::kFewestForEffects;
  result.readings = static_cast<int>(calibration.day.readings());
  addUntestable(calibration.day, result);
  Decider(prepared, result).run();
  const calibration::SelectedEffects& selected = calibration.selected;
  result.shrink_together =
      shrinkOf(heldOutSquares(calibration, calibration.geometry()), heldOutSquares(calibration, calibration.best()),
               selected.before_by_division, selected.after_by_division);
  const auto untestable = [&](UnloadedEffect effect) {
    return std::any_of(result.not_testable.begin(), result.not_testable.end(),
                       [&](const UntestableEffect& one) { return one.effect == effect; });
  };
  for (const auto& [effect, size] : selected.detectable) {
    if (!untestable(effect))
      result.detectable.push_back(
          {effect, std::max(result.size_limit, size * std::hypot(calibration.noise, calibration.best().fit.model_sd))});
  }
  result.where = whereLeft(calibration.day, calibration.geometry().fit);
  result.where_after = whereLeft(calibration.day, calibration.best().fit);
  result.next = nextMeasurements(result);
  return result;
}

AccuracyDiagnosis diagnoseAccuracy(const campaign::Campaign& campaign, const calibration::CalibrationOptions& options) {
  return diagnoseAccuracy(preparation::prepareCampaign(campaign), options);
}

}  // namespace stiffscope::accuracy
