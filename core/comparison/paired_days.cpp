#include "core/comparison/paired_days.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_map>

#include "core/calibration/fitted_day.h"
#include "core/comparison/matched_postures.h"

namespace stiffscope::comparison {

using calibration::ArmFit;
using calibration::EffectPart;
using calibration::UnloadedEffect;

namespace {

std::vector<std::size_t> firstReadings(const calibration::UnloadedDay& day) {
  std::vector<std::size_t> first;
  std::size_t at = 0;
  for (const calibration::Posture& posture : day.postures) {
    first.push_back(at);
    at += posture.readings.size();
  }
  return first;
}

bool same(const EffectPart& a, const EffectPart& b) {
  return a.effect == b.effect && a.detail == b.detail && a.order == b.order &&
         a.terms.front().name == b.terms.front().name;
}

/// Variance of a coordinate by the tracker's declared noise, mean of a day's readings, m^2.
double declaredNoise(const calibration::UnloadedDay& day) {
  double sum = 0.0, count = 0.0;
  for (const calibration::Posture& posture : day.postures) {
    for (const calibration::Reading& reading : posture.readings) sum += reading.covariance.trace() / 3.0, ++count;
  }
  return sum / std::max(1.0, count);
}

}  // namespace

CommonReadings commonReadings(const calibration::UnloadedDay& before, const calibration::UnloadedDay& after) {
  CommonReadings common;
  std::unordered_map<std::string, std::size_t> postures, targets;
  for (std::size_t i = 0; i < after.postures.size(); ++i)
    postures[after.pose_ids[static_cast<std::size_t>(after.postures[i].pose)]] = i;
  for (std::size_t t = 0; t < after.targets.size(); ++t) targets[after.targets[t]] = t;
  for (std::size_t t = 0; t < before.targets.size(); ++t) {
    const auto other = targets.find(before.targets[t]);
    if (other == targets.end()) continue;
    common.targets[0].push_back(static_cast<int>(t));
    common.targets[1].push_back(static_cast<int>(other->second));
  }
  const auto sameReflector = [&](int own, int other) {
    return before.targets[static_cast<std::size_t>(own)] == after.targets[static_cast<std::size_t>(other)];
  };
  const std::vector<std::size_t> first_before = firstReadings(before), first_after = firstReadings(after);
  for (std::size_t i = 0; i < before.postures.size(); ++i) {
    const calibration::Posture& own = before.postures[i];
    const auto found = postures.find(before.pose_ids[static_cast<std::size_t>(own.pose)]);
    if (found == postures.end()) continue;
    const calibration::Posture& other = after.postures[found->second];
    if ((own.q - other.q).cwiseAbs().maxCoeff() > MatchLimits().angle) continue;
    ++common.postures;
    for (std::size_t r = 0; r < own.readings.size(); ++r) {
      for (std::size_t s = 0; s < other.readings.size(); ++s) {
        if (sameReflector(own.readings[r].target, other.readings[s].target))
          common.readings.push_back({{i, first_before[i] + r}, {found->second, first_after[found->second] + s}});
      }
    }
  }
  return common;
}

bool ofMachine(const EffectPart& part) {
  switch (part.effect) {
    case UnloadedEffect::kinematic_error:
    case UnloadedEffect::joint_compliance:
    case UnloadedEffect::gravity_compensator:
    case UnloadedEffect::link_compliance:
    case UnloadedEffect::bearing_tilt:
    case UnloadedEffect::base_compliance:
    case UnloadedEffect::transmission_error:
    case UnloadedEffect::ratio_error:
    case UnloadedEffect::backlash:
    case UnloadedEffect::read_back_error:
      return true;
    case UnloadedEffect::tracker_drift:
    case UnloadedEffect::frame_error:
    case UnloadedEffect::target_motion:
    case UnloadedEffect::thermal_growth:
    case UnloadedEffect::scale_error:
      break;
  }
  return false;
}

PairedDays::PairedDays(std::array<calibration::Calibration, 2> days) : days_(std::move(days)) {
  matchReadings();
  fit();
  setCovariances();
}

void PairedDays::matchReadings() {
  const auto used = [&](std::size_t k, const Place& place) { return days_[k].best().fit.weights[place.reading] > 0.0; };
  CommonReadings found = commonReadings(day(0), day(1));
  std::erase_if(found.readings, [&](const CommonReading& one) { return !used(0, one.before) || !used(1, one.after); });
  targets = std::move(found.targets);
  common_ = std::move(found.readings);
  postures_common = found.postures;
  const std::size_t fewer = std::min(day(0).postures.size(), day(1).postures.size());
  const double readings = 3.0 * static_cast<double>(common_.size());
  constexpr double kEnough = 2.0;  // coordinates a parameter
  same_postures = 2 * postures_common >= fewer && readings >= kEnough * days_[0].geometry().fit.parameters;
}

std::vector<EffectPart> PairedDays::partsOf(std::size_t k) const {
  std::vector<EffectPart> parts;
  for (const EffectPart& part : days_[k].best().fit.parts) {
    if (!ofMachine(part)) parts.push_back(part);
  }
  if (same_postures) {
    // Not chosen: what joints give by own weight is the one effect that a change of the machine shows beside geometry.
    if (day(0).masses_known && day(1).masses_known) {
      for (EffectPart& part : calibration::jointCompliances(day(k))) parts.push_back(std::move(part));
    }
    return parts;
  }
  for (std::size_t other = 0; other < 2; ++other) {
    for (const EffectPart& part : days_[other].best().fit.parts) {
      if (ofMachine(part) &&
          std::none_of(parts.begin(), parts.end(), [&](const EffectPart& known) { return same(known, part); }))
        parts.push_back(part);
    }
  }
  return parts;
}

void PairedDays::fit() {
  std::array<std::vector<EffectPart>, 2> parts{partsOf(0), partsOf(1)};
  constexpr int kTurns = 4;
  for (int turn = 0; turn < kTurns; ++turn) {
    for (std::size_t k = 0; k < 2; ++k) fitDay(k, parts[k]);
    std::vector<EffectPart> refused;
    for (const ArmFit& fit : fits) {
      std::size_t term = 0;
      for (const EffectPart& part : fit.parts) {
        if (fit.refused[term]) refused.push_back(part);
        term += part.terms.size();
      }
    }
    if (refused.empty()) break;
    for (std::vector<EffectPart>& of : parts) {
      std::erase_if(of, [&](const EffectPart& part) {
        return std::any_of(refused.begin(), refused.end(), [&](const EffectPart& one) { return same(one, part); });
      });
    }
  }
}

void PairedDays::fitDay(std::size_t k, const std::vector<EffectPart>& parts) {
  const ArmFit& best = days_[k].best().fit;
  std::vector<double> weights = best.weights;
  if (same_postures) {
    std::fill(weights.begin(), weights.end(), 0.0);
    for (const CommonReading& one : common_) weights[(k == 0 ? one.before : one.after).reading] = 1.0;
  }
  fits[k] =
      calibration::fitArm(day(k), best.place, parts, {.robust = false, .weights = weights}, &days_[k].geometry().fit);
  residuals_[k] = calibration::residualsOf(day(k), fits[k]);
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] > 0.0) sum += residuals_[k][i].squaredNorm(), ++count;
  }
  left[k] = std::sqrt(sum / std::max(1.0, count));
  rows[k] = 3.0 * count;
}

void PairedDays::setCovariances() {
  const std::array<FitEquations, 2> equations{FitEquations(day(0), fits[0]), FitEquations(day(1), fits[1])};
  for (std::size_t k = 0; k < 2; ++k) {
    std::vector<Eigen::VectorXd> residuals;
    for (const calibration::PostureEquations& of : equations[k].equations) residuals.push_back(of.residual);
    if (same_postures) residuals = differences(k, equations[k]);
    ErrorComponents errors = errorComponents(equations[k], residuals, leastCoordinate(k));
    if (same_postures) errors.coordinate *= 0.5, errors.angle *= 0.5;  // a day's half of the difference's
    covariances[k] = covarianceBy(equations[k], errors);
  }
}

double PairedDays::leastCoordinate(std::size_t k) const {
  const std::array<double, 2> noise{declaredNoise(day(0)), declaredNoise(day(1))};
  const double whitened_by = noise[k] + fits[k].model_sd * fits[k].model_sd;
  const double declared = same_postures ? noise[0] + noise[1] : noise[k];
  constexpr double kLeast = 1e-6;  // readings to the same digits are no evidence of no noise
  return whitened_by > 0.0 ? std::max(kLeast, declared / whitened_by) : kLeast;
}

std::vector<Eigen::VectorXd> PairedDays::differences(std::size_t k, const FitEquations& equations) const {
  // Readings of a posture stand in `common_` in the order of the day before; in the equations in that of day k.
  std::unordered_map<std::size_t, std::vector<CommonReading>> by_posture;
  for (const CommonReading& one : common_) by_posture[(k == 0 ? one.before : one.after).posture].push_back(one);
  std::vector<Eigen::VectorXd> all;
  for (std::size_t p = 0; p < equations.postures.size(); ++p) {
    std::vector<CommonReading>& readings = by_posture[equations.postures[p]];
    std::sort(readings.begin(), readings.end(), [k](const CommonReading& a, const CommonReading& b) {
      return k == 0 ? a.before.reading < b.before.reading : a.after.reading < b.after.reading;
    });
    Eigen::VectorXd apart(equations.equations[p].residual.size());
    for (std::size_t r = 0; r < readings.size(); ++r) {
      apart.segment<3>(3 * static_cast<Eigen::Index>(r)) =
          equations.equations[p].whitening[r] *
          (residuals_[1][readings[r].after.reading] - residuals_[0][readings[r].before.reading]);
    }
    all.push_back(std::move(apart));
  }
  return all;
}

}  // namespace stiffscope::comparison
