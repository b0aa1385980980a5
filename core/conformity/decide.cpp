#include "core/conformity/decide.h"

#include <algorithm>
#include <cmath>

namespace stiffscope::conformity {

namespace {

using identification::CoverageInterval;

/// A quantity, or why there is none.
struct Sought {
  std::optional<Measured> measured;
  Missing missing = Missing::nothing;
  bool upper_bound = false;  ///< the quantity may be anything below the interval's upper end
};

Sought found(double value, const CoverageInterval& interval) {
  if (!std::isfinite(value)) return {std::nullopt, Missing::not_identified};
  if (std::isnan(interval.low) || std::isnan(interval.high)) return {std::nullopt, Missing::no_uncertainty};
  return {Measured{value, interval}, Missing::nothing};
}

/// value -+ 1.96 u.
Sought foundNormal(double value, double sd) {
  const double expanded = identification::kNormalFactor * sd;
  return found(value, {value - expanded, value + expanded});
}

Sought stiffness(const DayResult& day, int joint) {
  if (day.identification == nullptr) return {std::nullopt, Missing::not_of_such_a_day};
  const identification::MethodResult& shown = day.identification->of(identification::bestMethod(*day.identification));
  if (!shown.available) return {std::nullopt, Missing::not_identified};
  const robot::JointMask& identifiable = shown.estimate.identifiable;
  if (joint >= static_cast<int>(identifiable.size())) return {std::nullopt, Missing::no_such_joint};
  if (!identifiable[static_cast<std::size_t>(joint)]) return {std::nullopt, Missing::not_identified};
  // The interval that is stated, by its farther end as U is; one that is open above still has a lower end.
  const double k = shown.estimate.stiffness(joint);
  const CoverageInterval stated = identification::stiffnessInterval(shown.estimate, joint);
  if (!std::isfinite(stated.low) && !std::isfinite(stated.high)) return {std::nullopt, Missing::no_uncertainty};
  if (!std::isfinite(stated.low) || !std::isfinite(stated.high)) return found(k, stated);
  const double u = std::max(k - stated.low, stated.high - k);
  return found(k, {k - u, k + u});
}

Sought compensated(const DayResult& day, bool at_wrist) {
  if (day.identification == nullptr) return {std::nullopt, Missing::not_of_such_a_day};
  const identification::MethodResult& shown = day.identification->of(identification::bestMethod(*day.identification));
  const auto& at = at_wrist ? shown.at_wrist : shown.at_targets;
  if (!shown.available || !at) return {std::nullopt, Missing::not_identified};
  // Of fewer the deviation over the subsets, which are then a handful, holds the share in 90 % at most.
  constexpr std::size_t kFewest = 6;
  if (shown.subsets.compliances.empty() || day.identification->cases.size() < kFewest)
    return {std::nullopt, Missing::no_uncertainty};
  return foundNormal(at->subsets.held_out, at->held_out_sd);
}

/// Where the softest direction is least stiff; its interval's lower end is the least over all postures. A joint of
/// unknown stiffness can only make some direction softer than those that it does not move: then this is an upper bound.
Sought softest(const DayResult& day) {
  if (day.identification == nullptr) return {std::nullopt, Missing::not_of_such_a_day};
  if (day.workspace == nullptr) return {std::nullopt, Missing::not_identified};
  std::optional<Measured> least;
  bool upper_bound = false;
  for (const workspace::PointStiffness& posture : day.workspace->postures) {
    upper_bound = upper_bound || !posture.unknown.empty();
    if (posture.of_model.empty()) continue;
    const workspace::DirectionalCompliance& soft = posture.of_model.front();
    const CoverageInterval interval = soft.stiffnessInterval();
    if (!least) least = Measured{soft.stiffness(), interval};
    least->value = std::min(least->value, soft.stiffness());
    least->interval.low = std::min(least->interval.low, interval.low);
    least->interval.high = std::min(least->interval.high, interval.high);
  }
  if (!least) return {std::nullopt, Missing::not_identified};
  if (upper_bound) least->interval.low = 0.0;
  Sought sought = found(least->value, least->interval);
  sought.upper_bound = upper_bound;
  return sought;
}

Sought avoided(const DayResult& day) {
  if (day.avoided == nullptr) return {std::nullopt, Missing::not_of_such_a_day};
  if (!day.avoided->available) return {std::nullopt, Missing::not_identified};
  return found(day.avoided->share, {day.avoided->low, day.avoided->high});
}

/// Of one reading the tracker's noise along the error; of the rms over n readings its n-th root.
Sought positionError(const DayResult& day, bool calibrated, bool largest) {
  if (day.calibration == nullptr) return {std::nullopt, Missing::not_of_such_a_day};
  const calibration::Calibration& calibration = *day.calibration;
  if (!calibration.reason.empty() || calibration.models.empty()) return {std::nullopt, Missing::not_identified};
  const calibration::ModelResult& model =
      calibrated ? calibration.best() : calibration.of(calibration::CalibratedModel::nominal);
  if (model.held_out.readings == 0) return {std::nullopt, Missing::not_identified};
  if (!(calibration.noise > 0.0)) return {std::nullopt, Missing::no_uncertainty};
  if (largest) return foundNormal(model.held_out.largest, calibration.noise);
  return foundNormal(model.held_out.rms, calibration.noise / std::sqrt(static_cast<double>(model.held_out.readings)));
}

/// The largest |distance - nominal| of axes that were measured. What is largest of all is no less than any of them:
/// both ends of its interval are the largest of theirs.
Sought linkDifference(const DayResult& day) {
  if (day.swept == nullptr) return {std::nullopt, Missing::not_of_such_a_day};
  if (!day.swept->sag_removed && !day.swept->sag_in_uncertainty) return {std::nullopt, Missing::sag_left_in};
  std::optional<Measured> largest;
  for (const frames::LinkGeometry& link : day.swept->links) {
    if (!link.distance_sd) continue;
    const Sought one = foundNormal(std::abs(link.distance - link.nominal_distance), *link.distance_sd);
    if (!one.measured) continue;
    if (!largest) largest = one.measured;
    largest->value = std::max(largest->value, one.measured->value);
    largest->interval.low = std::max(largest->interval.low, one.measured->interval.low);
    largest->interval.high = std::max(largest->interval.high, one.measured->interval.high);
  }
  return largest ? Sought{largest, Missing::nothing} : Sought{std::nullopt, Missing::not_identified};
}

Sought sought(Quantity quantity, const DayResult& day) {
  switch (quantity) {
    case Quantity::compensated_at_reflectors:
      return compensated(day, false);
    case Quantity::compensated_at_wrist:
      return compensated(day, true);
    case Quantity::softest:
      return softest(day);
    case Quantity::avoided:
      return avoided(day);
    case Quantity::nominal_rms:
      return positionError(day, false, false);
    case Quantity::nominal_largest:
      return positionError(day, false, true);
    case Quantity::calibrated_rms:
      return positionError(day, true, false);
    case Quantity::calibrated_largest:
      return positionError(day, true, true);
    case Quantity::link_difference:
      return linkDifference(day);
    default:
      return stiffness(day, static_cast<int>(quantity));
  }
}

Decision notEvaluated(const Limit& limit, Missing missing) {
  return {limit, std::nullopt, Verdict::not_evaluated, false, missing};
}

/// Of an upper bound: what lies below it somewhere. It keeps `most` with its upper end, and misses `least` for sure
/// where even that end is below it; nothing else follows.
Decision decideBelow(const Limit& limit, const Measured& bound) {
  const Decision decision = decide(limit, bound);
  const bool fails = limit.least && bound.interval.high < *limit.least;
  return decision.verdict == Verdict::pass || fails ? decision : notEvaluated(limit, Missing::not_identified);
}

}  // namespace

Decision decide(const Limit& limit, const Measured& measured) {
  const auto keeps = [&limit](double low, double high) {
    return (!limit.least || low >= *limit.least) && (!limit.most || high <= *limit.most);
  };
  Decision decision{limit, measured, Verdict::fail, false, Missing::nothing};
  if (keeps(measured.interval.low, measured.interval.high)) decision.verdict = Verdict::pass;
  decision.in_guard_band = decision.verdict == Verdict::fail && keeps(measured.value, measured.value);
  return decision;
}

std::vector<Decision> decide(const Limits& limits, const DayResult& day) {
  std::vector<Decision> decisions;
  for (const Limit& limit : limits.limits) {
    const Sought one = sought(limit.quantity, day);
    decisions.push_back(!one.measured     ? notEvaluated(limit, one.missing)
                        : one.upper_bound ? decideBelow(limit, *one.measured)
                                          : decide(limit, *one.measured));
  }
  return decisions;
}

Verdict overall(const std::vector<std::vector<Decision>>& by_day) {
  Verdict verdict = Verdict::pass;
  const std::size_t limits = by_day.empty() ? 0 : by_day.front().size();
  for (std::size_t i = 0; i < limits; ++i) {
    bool evaluated = false, lacking = false;
    for (const std::vector<Decision>& day : by_day) {
      if (day[i].verdict == Verdict::fail) return Verdict::fail;
      evaluated = evaluated || day[i].verdict == Verdict::pass;
      lacking = lacking || (day[i].verdict == Verdict::not_evaluated && day[i].missing != Missing::not_of_such_a_day);
    }
    if (!evaluated || lacking) verdict = Verdict::not_evaluated;
  }
  return limits == 0 ? Verdict::not_evaluated : verdict;
}

}  // namespace stiffscope::conformity
