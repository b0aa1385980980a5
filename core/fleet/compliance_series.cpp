#include "core/fleet/fleet.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/comparison/matched_postures.h"
#include "core/numerics/distributions.h"
#include "metrology/tail_probability.h"

namespace stiffscope::fleet {

namespace {

constexpr double kManyDegrees = 1e6;
constexpr double kChangedMisfit = 0.01;

/// Mean of [from, to) less mean of [begin, from).
Eigen::VectorXd stepWeights(std::size_t days, std::size_t begin, std::size_t first, std::size_t end) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(days));
  for (std::size_t t = begin; t < end; ++t) {
    weights[static_cast<Eigen::Index>(t)] =
        t < first ? -1.0 / static_cast<double>(first - begin) : 1.0 / static_cast<double>(end - first);
  }
  return weights;
}

}  // namespace

bool CampaignResult::hasUnknown() const {
  return std::any_of(effects.begin(), effects.end(),
                     [](const EffectFound& one) { return one.effects == std::vector<std::string>{"unknown"}; });
}

Stated Step::share() const {
  const double u = difference.expanded() / before, value = difference.value / before;
  return {value, value - u, value + u};
}

ComplianceSeries::ComplianceSeries(const std::vector<const CampaignResult*>& days,
                                   std::optional<identification::Method> method)
    : days_(days), method_(method) {
  std::map<std::string, std::vector<std::pair<const LoadedPosture*, std::size_t>>> known;
  for (const CampaignResult* day : days_) {
    std::vector<std::size_t> places;
    for (const LoadedPosture& posture : day->loaded_postures) {
      auto& same_id = known[posture.pose];
      const auto same = std::find_if(same_id.begin(), same_id.end(), [&](const auto& other) {
        return comparison::corresponds(other.first->q, other.first->force, posture.q, posture.force);
      });
      if (same == same_id.end()) {
        same_id.emplace_back(&posture, place_count_);
        places.push_back(place_count_++);
      } else {
        places.push_back(same->second);
      }
    }
    places_.push_back(std::move(places));
  }
  for (const std::vector<std::size_t>& places : places_)
    same_postures_ = same_postures_ && places.size() == place_count_;
}

const SpringsOfDay& ComplianceSeries::springs(std::size_t day) const {
  return method_ ? days_[day]->springs[static_cast<std::size_t>(*method_)] : days_[day]->own_weight;
}

double ComplianceSeries::pOfNothing(const comparison::Uncertain& number) {
  if (!std::isfinite(number.sd) || !(number.sd > 0.0) || !(number.dof > 0.0)) return 1.0;
  const double t = number.value / number.sd;
  return metrology::fTail(t * t, 1, number.dof);
}

std::size_t ComplianceSeries::posturesOfAll() const {
  std::vector<std::size_t> seen(place_count_);
  for (const std::vector<std::size_t>& places : places_) {
    for (const std::size_t place : places) ++seen[place];
  }
  return static_cast<std::size_t>(std::count(seen.begin(), seen.end(), days()));
}

bool ComplianceSeries::has(int joint) const {
  for (std::size_t t = 0; t < days(); ++t) {
    if (!springs(t).identifiable[static_cast<std::size_t>(joint)]) return false;
  }
  return days() > 0;
}

double ComplianceSeries::pooledScatter(int joint, const std::vector<std::size_t>& first_days) const {
  const std::size_t segments = first_days.size();
  double sum = 0.0;
  for (std::size_t s = 0; s < segments; ++s) {
    const std::size_t begin = first_days[s], end = s + 1 < segments ? first_days[s + 1] : days();
    std::vector<double> mean(place_count_, 0.0);
    const auto eachInfluence = [&](const auto& use) {
      for (std::size_t t = begin; t < end; ++t) {
        for (std::size_t p = 0; p < places_[t].size(); ++p) use(places_[t][p], springs(t).influences[p][joint]);
      }
    };
    eachInfluence([&](std::size_t place, double g) { mean[place] += g / static_cast<double>(end - begin); });
    eachInfluence([&](std::size_t place, double g) { sum += (g - mean[place]) * (g - mean[place]); });
  }
  return sum / static_cast<double>(days() - segments);
}

comparison::Uncertain ComplianceSeries::contrast(int joint, const Eigen::VectorXd& weights,
                                                 const std::vector<std::size_t>& first_days) const {
  return contrastBy(Scatter::of_the_sum_where_larger, joint, weights, first_days);
}

comparison::Uncertain ComplianceSeries::contrastBy(Scatter choice, int joint, const Eigen::VectorXd& weights,
                                                   const std::vector<std::size_t>& first_days) const {
  comparison::Uncertain result;
  std::vector<double> by_place(place_count_, 0.0);
  double shared = 0.0, dof = kManyDegrees;
  for (std::size_t t = 0; t < days(); ++t) {
    const double w = weights[static_cast<Eigen::Index>(t)];
    const SpringsOfDay& day = springs(t);
    result.value += w * day.compliance[joint];
    shared += w * w * day.shared[joint];
    dof = std::min(dof, day.dof[joint]);
    for (std::size_t p = 0; p < places_[t].size(); ++p) by_place[places_[t][p]] += w * day.influences[p][joint];
  }
  double scatter = 0.0;
  for (const double one : by_place) scatter += one * one;
  if (same_postures_ && days() > first_days.size()) {
    const double pooled = weights.squaredNorm() * pooledScatter(joint, first_days);
    const double pooled_dof = dof * static_cast<double>(days() - first_days.size());
    const int own = std::max(1, static_cast<int>(std::lround(dof)));
    if (pooled > 0.0 &&
        (choice == Scatter::pooled || metrology::fTail(scatter / pooled, own, pooled_dof) > kChangedMisfit)) {
      scatter = pooled, dof = pooled_dof;
    }
  }
  const double total = scatter + shared;
  result.sd = std::sqrt(total);
  const double ratio = scatter > 0.0 ? total / scatter : kManyDegrees;  // what is shared counts as known
  result.dof = std::min(kManyDegrees, dof * ratio * ratio);
  return result;
}

Step ComplianceSeries::likeliestStep(int joint, std::size_t begin, std::size_t end) const {
  Step best;
  best.joint = joint, best.begin = begin, best.end = end, best.first = end;
  if (end < begin + 2) return best;
  const auto firstDays = [&](std::size_t first) {
    std::vector<std::size_t> segments{0};
    for (const std::size_t one : {begin, first, end}) {
      if (one > segments.back() && one < days()) segments.push_back(one);
    }
    return segments;
  };
  double largest = -1.0;
  for (std::size_t first = begin + 1; first < end; ++first) {
    const comparison::Uncertain step =
        contrastBy(Scatter::pooled, joint, stepWeights(days(), begin, first, end), firstDays(first));
    const double size = step.sd > 0.0 ? std::abs(step.value) / step.sd : 0.0;
    if (size > largest) largest = size, best.first = first;
  }
  best.difference = contrast(joint, stepWeights(days(), begin, best.first, end), firstDays(best.first));
  best.p_value = std::min(1.0, pOfNothing(best.difference) * static_cast<double>(end - begin - 1));
  for (std::size_t t = begin; t < best.first; ++t)
    best.before += springs(t).compliance[joint] / static_cast<double>(best.first - begin);
  return best;
}

void ComplianceSeries::findSteps(int joint, std::size_t begin, std::size_t end, double level,
                                 std::vector<Step>& found) const {
  if (end < begin + 2) return;
  const Step step = likeliestStep(joint, begin, end);
  if (!(step.p_value <= level)) return;
  findSteps(joint, begin, step.first, level, found);
  found.push_back(step);
  findSteps(joint, step.first, end, level, found);
}

std::vector<Step> ComplianceSeries::steps(int joint, double level) const {
  std::vector<Step> found;
  if (has(joint)) findSteps(joint, 0, days(), level, found);
  return found;
}

double ComplianceSeries::detectableStep(int joint, std::size_t first, double level) const {
  if (!has(joint) || first == 0 || first >= days()) return kUnknown;
  const comparison::Uncertain step = contrast(joint, stepWeights(days(), 0, first, days()), {0, first});
  if (!(step.sd > 0.0) || !(step.dof > 0.0)) return kUnknown;
  const double nine_in_ten = numerics::normalLimit(2.0 * 0.1);
  const double limit = numerics::studentLimit(level / static_cast<double>(days() - 1), step.dof) + nine_in_ten;
  double mean = 0.0;
  for (std::size_t t = 0; t < days(); ++t) mean += springs(t).compliance[joint] / static_cast<double>(days());
  return mean > 0.0 ? limit * step.sd / mean : kUnknown;
}

ControlChart ComplianceSeries::chart(int joint, const std::vector<Step>& steps) const {
  ControlChart chart;
  if (!has(joint)) return chart;
  std::vector<std::size_t> first_days{0};
  for (const Step& step : steps) first_days.push_back(step.first);
  const std::size_t base = steps.empty() ? days() : steps.front().first;
  const Eigen::Index count = static_cast<Eigen::Index>(days());
  Eigen::VectorXd centre = Eigen::VectorXd::Zero(count);
  centre.head(static_cast<Eigen::Index>(base)).setConstant(1.0 / static_cast<double>(base));
  chart.centre = contrast(joint, centre, first_days).value;
  double squares = 0.0, expected = 0.0;
  for (std::size_t t = 0; t < days(); ++t) {
    const Eigen::VectorXd own = Eigen::VectorXd::Unit(count, static_cast<Eigen::Index>(t));
    const comparison::Uncertain away = contrast(joint, own - centre, first_days);
    ControlChart::Point point;
    point.value = away.value / chart.centre;
    point.expanded = away.expanded() / chart.centre;
    point.limit = numerics::studentLimit(kOutside, away.dof) * away.sd / chart.centre;
    if (days() < 2) point.expanded = point.limit = kUnknown;  // nothing but itself to differ from
    point.outside = std::abs(point.value) > point.limit;
    chart.points.push_back(point);
    // The same against its own segment.
    const auto next = std::upper_bound(first_days.begin(), first_days.end(), t);
    const std::size_t begin = *(next - 1), end = next == first_days.end() ? days() : *next;
    if (end < begin + 2) continue;
    Eigen::VectorXd segment = Eigen::VectorXd::Zero(count);
    segment.segment(static_cast<Eigen::Index>(begin), static_cast<Eigen::Index>(end - begin))
        .setConstant(1.0 / static_cast<double>(end - begin));
    const comparison::Uncertain within = contrast(joint, own - segment, first_days);
    squares += within.value * within.value, expected += within.sd * within.sd;
  }
  const int free = static_cast<int>(days()) - static_cast<int>(first_days.size());
  if (free >= 3 && expected > 0.0) {
    chart.scatter = std::sqrt(squares / expected);
    chart.scatter_p = metrology::fTail(squares / expected, free, kManyDegrees);
  }
  return chart;
}

}  // namespace stiffscope::fleet
