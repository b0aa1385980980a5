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

/// Mean of [begin, end).
Eigen::VectorXd meanWeights(std::size_t days, std::size_t begin, std::size_t end) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(days));
  weights.segment(static_cast<Eigen::Index>(begin), static_cast<Eigen::Index>(end - begin))
      .setConstant(1.0 / static_cast<double>(end - begin));
  return weights;
}

/// Mean of [first, end) less mean of [begin, first).
Eigen::VectorXd stepWeights(std::size_t days, std::size_t begin, std::size_t first, std::size_t end) {
  return meanWeights(days, first, end) - meanWeights(days, begin, first);
}

/// Whether shares of it are known: of what may be zero or less they are not.
bool isAboveItsU(const comparison::Uncertain& compliance) {
  return compliance.value > 0.0 && !(compliance.value <= compliance.expanded());
}

/// Of the level, what two steps have that are found together; one has the rest. Two are rarer, and one is then found as
/// often as if two were not asked of.
constexpr double kShareOfTwo = 0.1;

/// For how much the search for `steps` steps, one or two, among so many days has to be corrected.
double tried(std::size_t days, std::size_t steps) {
  const double dates = static_cast<double>(days) - 1.0;
  if (steps == 2) return 0.5 * dates * (dates - 1.0) / kShareOfTwo;
  return days > 2 ? dates / (1.0 - kShareOfTwo) : dates;
}

}  // namespace

bool CampaignResult::hasUnknown() const {
  return std::any_of(effects.begin(), effects.end(),
                     [](const EffectFound& one) { return one.effects == std::vector<std::string>{"unknown"}; });
}

Stated Step::share() const {
  if (!isAboveItsU(before)) return {};
  const double u = difference.expanded() / before.value, value = difference.value / before.value;
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
    if (pooled > 0.0 && metrology::fTail(scatter / pooled, own, pooled_dof) > kChangedMisfit)
      scatter = pooled, dof = pooled_dof;
  }
  const double total = scatter + shared;
  result.sd = std::sqrt(total);
  const double ratio = scatter > 0.0 ? total / scatter : kManyDegrees;  // what is shared counts as known
  result.dof = std::min(kManyDegrees, dof * ratio * ratio);
  return result;
}

Step ComplianceSeries::stepBetween(int joint, std::size_t segment, const std::vector<std::size_t>& first_days) const {
  Step step;
  step.joint = joint;
  step.begin = first_days[segment], step.first = first_days[segment + 1];
  step.end = segment + 2 < first_days.size() ? first_days[segment + 2] : days();
  step.difference = contrast(joint, stepWeights(days(), step.begin, step.first, step.end), first_days);
  step.before = contrast(joint, meanWeights(days(), step.begin, step.first), first_days);
  step.p_value = pOfNothing(step.difference);
  return step;
}

/// The steps of one joint (ComplianceSeries). Sums over days are kept so that a pair of dates costs the same however
/// many days and postures there are.
class StepSearch {
 public:
  StepSearch(const ComplianceSeries& series, int joint) : series_(series), joint_(joint), days_(series.days()) {
    const auto n = static_cast<Eigen::Index>(days_);
    compliance_ = shared_ = squares_ = Eigen::VectorXd::Zero(n + 1);
    products_ = Eigen::MatrixXd::Zero(n + 1, n + 1);
    std::vector<double> mean(series.place_count_, 0.0), own(series.place_count_);
    const auto influence = [&](std::size_t t, std::size_t p) { return series.springs(t).influences[p][joint]; };
    // The mean of all days cancels in all that is pooled, and would cost digits.
    for (std::size_t t = 0; series.same_postures_ && t < days_; ++t) {
      for (std::size_t p = 0; p < series.places_[t].size(); ++p)
        mean[series.places_[t][p]] += influence(t, p) / static_cast<double>(days_);
    }
    for (std::size_t t = 0; t < days_; ++t) {
      const auto i = static_cast<Eigen::Index>(t);
      compliance_[i + 1] = compliance_[i] + series.springs(t).compliance[joint];
      shared_[i + 1] = shared_[i] + series.springs(t).shared[joint];
      std::fill(own.begin(), own.end(), 0.0);
      for (std::size_t p = 0; p < series.places_[t].size(); ++p)
        own[series.places_[t][p]] += influence(t, p) - mean[series.places_[t][p]];
      for (std::size_t u = 0; u <= t; ++u) {
        const auto j = static_cast<Eigen::Index>(u);
        double product = 0.0;
        for (std::size_t p = 0; p < series.places_[u].size(); ++p)
          product += own[series.places_[u][p]] * (influence(u, p) - mean[series.places_[u][p]]);
        products_(i + 1, j + 1) = products_(j + 1, i + 1) = product;
      }
      squares_[i + 1] = squares_[i] + products_(i + 1, i + 1);
    }
    for (Eigen::Index t = 1; t <= n; ++t) products_.row(t) += products_.row(t - 1);
    for (Eigen::Index t = 1; t <= n; ++t) products_.col(t) += products_.col(t - 1);
  }

  double pOfNoStep() const {
    double smallest = 1.0;
    for (const std::size_t count : {1, 2}) {
      if (days_ > count) smallest = std::min(smallest, largestP(likeliest(0, days_, count)));
    }
    return smallest;
  }

  std::vector<Step> steps(double level, double further) {
    find(0, days_, level, further);
    if (found_.size() > found_first_.size()) settle();
    return estimated(found_);
  }

 private:
  struct Found {
    std::size_t first;
    double tried = 1.0, level = 0.0;
  };

  std::vector<std::size_t> firstDays(const std::vector<Found>& found) const {
    std::vector<std::size_t> first_days{0};
    for (const Found& one : found) first_days.push_back(one.first);
    return first_days;
  }

  /// Squares of the influences about their means in [begin, end).
  double within(std::size_t begin, std::size_t end) const {
    const auto b = static_cast<Eigen::Index>(begin), e = static_cast<Eigen::Index>(end);
    return squares_[e] - squares_[b] - product(begin, end, begin, end) / static_cast<double>(end - begin);
  }

  /// Sum over all days t of one segment and u of the other of sum_p g_t,p g_u,p.
  double product(std::size_t begin, std::size_t end, std::size_t other_begin, std::size_t other_end) const {
    const auto b = static_cast<Eigen::Index>(begin), e = static_cast<Eigen::Index>(end);
    const auto ob = static_cast<Eigen::Index>(other_begin), oe = static_cast<Eigen::Index>(other_end);
    return products_(e, oe) - products_(b, oe) - products_(e, ob) + products_(b, ob);
  }

  /// d^T C^-1 d of the differences between the two or three segments between `bounds`; `scatter` is of a day, where
  /// postures are the same.
  double size(const std::vector<std::size_t>& bounds, double scatter) const {
    const std::size_t segments = bounds.size() - 1;
    const bool pooled = series_.same_postures_;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (std::size_t s = 0; s < segments; ++s) {
      const auto i = static_cast<Eigen::Index>(s);
      const auto b = static_cast<Eigen::Index>(bounds[s]), e = static_cast<Eigen::Index>(bounds[s + 1]);
      const auto length = static_cast<double>(e - b);
      mean[i] = (compliance_[e] - compliance_[b]) / length;
      covariance(i, i) = (shared_[e] - shared_[b]) / (length * length) + (pooled ? scatter / length : 0.0);
      for (std::size_t o = 0; !pooled && o < segments; ++o) {
        covariance(i, static_cast<Eigen::Index>(o)) += product(bounds[s], bounds[s + 1], bounds[o], bounds[o + 1]) /
                                                       (length * static_cast<double>(bounds[o + 1] - bounds[o]));
      }
    }
    const auto count = static_cast<Eigen::Index>(segments - 1);
    const Eigen::Matrix<double, 2, 3> differences =
        (Eigen::Matrix<double, 2, 3>() << -1.0, 1.0, 0.0, 0.0, -1.0, 1.0).finished();
    const Eigen::Vector2d d = differences * mean;
    Eigen::Matrix2d c = differences * covariance * differences.transpose();
    if (count == 1) return c(0, 0) > 0.0 ? d[0] * d[0] / c(0, 0) : 0.0;
    const double determinant = c.determinant();
    return c(0, 0) > 0.0 && determinant > 0.0
               ? (c(1, 1) * d[0] * d[0] - 2.0 * c(0, 1) * d[0] * d[1] + c(0, 0) * d[1] * d[1]) / determinant
               : 0.0;
  }

  /// One step or two in a segment of those found. Dates are held against each other by one scatter, that between the
  /// steps that are known: each pair's own would prefer dates at which it is small by chance.
  std::vector<Found> likeliest(std::size_t begin, std::size_t end, std::size_t count) const {
    const std::vector<std::size_t> first_days = firstDays(found_);
    double scatter = 0.0;
    for (std::size_t s = 0; s < first_days.size(); ++s)
      scatter += within(first_days[s], s + 1 < first_days.size() ? first_days[s + 1] : days_);
    scatter /= static_cast<double>(days_ - first_days.size());
    std::vector<Found> best;
    double largest = -1.0;
    for (std::size_t a = begin + 1; a < end; ++a) {
      for (std::size_t b = count == 2 ? a + 1 : end; b < end || (count == 1 && b == end); ++b) {
        std::vector<std::size_t> bounds{begin, a, end};
        if (count == 2) bounds.insert(bounds.begin() + 2, b);
        const double found = size(bounds, scatter);
        if (!(found > largest)) continue;
        largest = found;
        best = {{a, tried(end - begin, count)}};
        if (count == 2) best.push_back({b, tried(end - begin, count)});
      }
    }
    return best;
  }

  std::vector<Found> with(const std::vector<Found>& more) const {
    std::vector<Found> all = found_;
    all.insert(all.end(), more.begin(), more.end());
    std::sort(all.begin(), all.end(), [](const Found& a, const Found& b) { return a.first < b.first; });
    return all;
  }

  std::vector<Step> estimated(const std::vector<Found>& found) const {
    const std::vector<std::size_t> first_days = firstDays(found);
    std::vector<Step> steps;
    for (std::size_t k = 0; k < found.size(); ++k) {
      steps.push_back(series_.stepBetween(joint_, k, first_days));
      steps.back().p_value = std::min(1.0, steps.back().p_value * found[k].tried);
    }
    return steps;
  }

  /// Of those `more`, beside what is found.
  double largestP(const std::vector<Found>& more) const {
    double largest = 0.0;
    for (const Step& step : estimated(with(more))) {
      const bool own = std::any_of(more.begin(), more.end(), [&](const Found& one) { return one.first == step.first; });
      if (own) largest = std::max(largest, step.p_value);
    }
    return largest;
  }

  /// What is beyond chance in a segment of those found: two steps, one, or none.
  std::vector<Found> beyondChance(std::size_t begin, std::size_t end, double level, double further) const {
    if (end < begin + 2) return {};
    std::vector<Found> one = likeliest(begin, end, 1), two;
    for (Found& step : one) step.level = level;
    const bool changed = largestP(one) <= level;
    if (end > begin + 2) two = likeliest(begin, end, 2);
    for (Found& step : two) {
      step.level = level;
      // That there is one is known then: each of the two has to be beyond chance beside the other.
      if (changed) step.tried = tried(end - begin, 1), step.level = further;
    }
    if (!two.empty() && largestP(two) <= two.front().level) return two;
    return changed ? one : std::vector<Found>{};
  }

  void find(std::size_t begin, std::size_t end, double level, double further) {
    const std::vector<Found> more = beyondChance(begin, end, level, further);
    if (more.empty()) return;
    found_ = with(more);
    if (found_first_.empty()) found_first_ = found_;
    std::size_t from = begin;
    for (const Found& one : more) {
      find(from, one.first, further, further);
      from = one.first;
    }
    find(from, end, further, further);
  }

  /// Dates that were found before others were known, once more between their neighbours; and steps that are none any
  /// more beside those.
  void settle() {
    while (!found_.empty()) {
      bool moved = true;
      for (std::size_t pass = 0; moved && pass < days_; ++pass) {
        moved = false;
        for (std::size_t k = 0; k < found_.size(); ++k) {
          const Found own = found_[k];
          const std::size_t begin = k > 0 ? found_[k - 1].first : 0;
          const std::size_t end = k + 1 < found_.size() ? found_[k + 1].first : days_;
          found_.erase(found_.begin() + static_cast<std::ptrdiff_t>(k));
          const std::size_t first = likeliest(begin, end, 1).front().first;
          found_.insert(found_.begin() + static_cast<std::ptrdiff_t>(k), {first, own.tried, own.level});
          moved |= first != own.first;
        }
      }
      const std::vector<Step> steps = estimated(found_);
      std::size_t worst = 0;
      const auto excess = [&](std::size_t k) { return steps[k].p_value / found_[k].level; };
      for (std::size_t k = 1; k < found_.size(); ++k) worst = excess(k) > excess(worst) ? k : worst;
      if (excess(worst) <= 1.0) return;
      found_.erase(found_.begin() + static_cast<std::ptrdiff_t>(worst));
    }
    found_ = found_first_;
  }

  const ComplianceSeries& series_;
  int joint_;
  std::size_t days_;
  Eigen::VectorXd compliance_, shared_, squares_;  ///< of all days before
  Eigen::MatrixXd products_;                       ///< the same of all pairs of days, sum_p g_t,p g_u,p
  std::vector<Found> found_, found_first_;         ///< in order of time
};

double ComplianceSeries::pOfNoStep(int joint) const {
  return has(joint) && days() > 1 ? StepSearch(*this, joint).pOfNoStep() : 1.0;
}

std::vector<Step> ComplianceSeries::steps(int joint, double level, double further) const {
  return has(joint) ? StepSearch(*this, joint).steps(level, further) : std::vector<Step>{};
}

double ComplianceSeries::detectableStep(int joint, std::size_t first, double level) const {
  if (!has(joint) || first == 0 || first >= days()) return kUnknown;
  const comparison::Uncertain step = contrast(joint, stepWeights(days(), 0, first, days()), {0, first});
  if (!(step.sd > 0.0) || !(step.dof > 0.0)) return kUnknown;
  const double nine_in_ten = numerics::normalLimit(2.0 * 0.1);
  const double limit = numerics::studentLimit(level / tried(days(), 1), step.dof) + nine_in_ten;
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
  const Eigen::VectorXd centre = meanWeights(days(), 0, base);
  const comparison::Uncertain mean = contrast(joint, centre, first_days);
  chart.centre = mean.value;
  const bool known = isAboveItsU(mean);
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
    if (known) chart.points.push_back(point);
    // The same against its own segment.
    const auto next = std::upper_bound(first_days.begin(), first_days.end(), t);
    const std::size_t begin = *(next - 1), end = next == first_days.end() ? days() : *next;
    if (end < begin + 2) continue;
    const comparison::Uncertain within = contrast(joint, own - meanWeights(days(), begin, end), first_days);
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
