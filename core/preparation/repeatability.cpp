#include "core/preparation/repeatability.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>

#include "core/campaign/row_names.h"
#include "core/frames/joint_axes.h"
#include "core/numerics/distributions.h"
#include "core/numerics/parallel.h"
#include "core/preparation/finding.h"
#include "core/preparation/remarks.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::preparation {

namespace {

/// Readings of one reflector in one state.
using StateRepeats = std::span<const campaign::LoadingReading* const>;

/// Readings that were repeated, state by state.
struct RepeatedStates {
  std::vector<const campaign::LoadingReading*> rows;
  std::vector<StateRepeats> states;  ///< of `rows`
};

RepeatedStates statesWithRepeats(const campaign::Loading& loading) {
  const auto state = [](const campaign::LoadingReading* row) { return std::tuple(row->pose, row->step, row->target); };
  const auto before = [&](const auto* a, const auto* b) { return state(a) < state(b); };
  RepeatedStates repeated;
  auto& rows = repeated.rows;
  rows.reserve(loading.rows.size());
  for (const campaign::LoadingReading& row : loading.rows) rows.push_back(&row);
  // Most tables have the repeats of a posture one after the other: then its rows alone are out of order.
  for (auto first = rows.begin(); first != rows.end();) {
    const auto end = std::find_if(first, rows.end(), [&](const auto* row) { return row->pose != (*first)->pose; });
    std::stable_sort(first, end, before);
    first = end;
  }
  if (!std::is_sorted(rows.begin(), rows.end(), before)) std::stable_sort(rows.begin(), rows.end(), before);
  for (auto first = rows.begin(); first != rows.end();) {
    const auto end = std::find_if(first, rows.end(), [&](const auto* row) { return state(row) != state(*first); });
    if (end - first >= 2) repeated.states.emplace_back(first, end);
    first = end;
  }
  return repeated;
}

Eigen::Vector3d sumOf(const StateRepeats& repeats) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const campaign::LoadingReading* row : repeats) sum += row->point;
  return sum;
}

void addScatter(const metrology::TrackerNoise& noise, const StateRepeats& repeats, RepeatScatter& scatter) {
  const double n = static_cast<double>(repeats.size());
  const Eigen::Vector3d mean = sumOf(repeats) / n;
  const Eigen::Vector3d sight = mean - noise.seenFrom(repeats.front()->from).station;
  const double distance = sight.norm();
  const double along_sd = noise.range_fixed + noise.range_per_m * distance;
  const double across_sd = noise.angle_fixed + noise.angle_per_m * distance;
  for (const campaign::LoadingReading* row : repeats) {
    const Eigen::Vector3d off = row->point - mean;
    const double along = off.dot(sight) / distance;
    const double across_square = off.squaredNorm() - along * along;
    scatter.along_rms += along * along;
    scatter.across_rms += across_square;
    scatter.along_chi2 += along * along / (along_sd * along_sd);
    scatter.across_chi2 += across_square / (across_sd * across_sd);
  }
  scatter.along_dof += static_cast<int>(repeats.size()) - 1;
  scatter.across_dof += 2 * (static_cast<int>(repeats.size()) - 1);
}

/// Squared distance of a repeat from the mean of the others, whose `sum` its own is in, by the declared noise.
double distanceFromOthers(const metrology::TrackerNoise& noise, const StateRepeats& repeats, const Eigen::Vector3d& sum,
                          const campaign::LoadingReading& row) {
  const double others = static_cast<double>(repeats.size()) - 1.0;
  const Eigen::Vector3d off = row.point - (sum - row.point) / others;
  return mahalanobisSquared(off, (1.0 + 1.0 / others) * noise.covarianceAt(row.point, row.from));
}

/// A repeat and its distance.
struct FarRepeat {
  const campaign::LoadingReading* row = nullptr;
  double square = 0.0;
};

FarRepeat farthest(const metrology::TrackerNoise& noise, const StateRepeats& repeats) {
  const Eigen::Vector3d sum = sumOf(repeats);
  FarRepeat worst;
  for (const campaign::LoadingReading* row : repeats) {
    const double square = distanceFromOthers(noise, repeats, sum, *row);
    if (worst.row == nullptr || square > worst.square) worst = {row, square};
  }
  return worst;
}

/// Of all repeats, those of a state one after the other.
std::vector<double> distances(const metrology::TrackerNoise& noise, const std::vector<StateRepeats>& states) {
  std::vector<std::size_t> first;
  std::size_t count = 0;
  for (const StateRepeats& repeats : states) {
    first.push_back(count);
    count += repeats.size();
  }
  std::vector<double> squares(count);
  numerics::smallWorkOnAllCores(states.size(), [&](std::size_t i) {
    const Eigen::Vector3d sum = sumOf(states[i]);
    for (std::size_t k = 0; k < states[i].size(); ++k)
      squares[first[i] + k] = distanceFromOthers(noise, states[i], sum, *states[i][k]);
  });
  return squares;
}

std::vector<RejectedReading> outliers(const std::string& file, const metrology::TrackerNoise& noise,
                                      const std::vector<StateRepeats>& states, double& typical) {
  std::vector<RejectedReading> found;
  const std::vector<double> all = distances(noise, states);
  std::vector<double> sorted = all;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double median = *middle / numerics::chiSquareLimit(0.5, 3.0), scale = std::max(1.0, median);
  typical = std::sqrt(median);
  const double limit = scale * numerics::chiSquareLimit(kLevel / static_cast<double>(all.size()), 3.0);
  // The worst first, and its state judged again without it: one bad repeat pulls the mean of the others.
  auto own = all.begin();
  for (const StateRepeats& state : states) {
    const auto end = own + static_cast<std::ptrdiff_t>(state.size());
    const bool far = std::any_of(own, end, [&](double square) { return !(square <= limit); });
    own = end;
    if (!far) continue;
    std::vector<const campaign::LoadingReading*> repeats(state.begin(), state.end());
    while (repeats.size() >= 2) {
      const FarRepeat worst = farthest(noise, repeats);
      if (worst.square <= limit) break;
      const auto reject = [&](const campaign::LoadingReading* row) {
        const Eigen::Vector3d of_others = (sumOf(repeats) - row->point) / (static_cast<double>(repeats.size()) - 1.0);
        found.push_back({file, row->line, Remark(RemarkId::stands_from_state, (row->point - of_others).norm())});
      };
      if (repeats.size() == 2) {
        for (const campaign::LoadingReading* row : repeats) reject(row);
        break;
      }
      reject(worst.row);
      repeats.erase(std::find(repeats.begin(), repeats.end(), worst.row));
    }
  }
  return found;
}

}  // namespace

RepeatScatter repeatScatter(const campaign::Campaign& campaign, const Rounded& rounded) {
  RepeatScatter scatter;
  scatter.digit = rounded.digit;
  if (!campaign.loading) {
    scatter.reason = Remark(RemarkId::no_loading);
    return scatter;
  }
  if (!declaredNoise(campaign)) {
    scatter.reason = Remark(RemarkId::tracker_noise_not_declared);
    return scatter;
  }
  const metrology::TrackerNoise noise = frames::trackerNoise(asNoisyAs(*campaign.tracker, rounded.factors));
  const RepeatedStates repeated = statesWithRepeats(*campaign.loading);
  const std::vector<StateRepeats>& states = repeated.states;
  if (states.empty()) {
    scatter.reason = Remark(RemarkId::no_repeats);
    return scatter;
  }
  for (const StateRepeats& repeats : states) addScatter(noise, repeats, scatter);
  scatter.along_rms = std::sqrt(scatter.along_rms / scatter.along_dof);
  scatter.across_rms = std::sqrt(scatter.across_rms / scatter.across_dof);
  scatter.outliers = outliers(campaign.loading->file, noise, states, scatter.typical);
  scatter.tested = true;
  return scatter;
}

namespace {

double factorOf(double chi2, int dof) {
  if (dof < 1 || chi2 <= numerics::chiSquareLimit(kLevel, dof)) return 1.0;
  // The upper end of its 95 % interval: another check of as many readings would else find the rest of the
  // scatter that this estimate happens to miss. A standard deviation's own is 1/sqrt(2 dof) of it.
  constexpr double kSigmas = 2.0;
  return std::sqrt(chi2 / dof) * (1.0 + kSigmas / std::sqrt(2.0 * dof));
}

}  // namespace

NoiseFactors noiseFactors(const RepeatScatter& scatter) {
  return {factorOf(scatter.along_chi2, scatter.along_dof), factorOf(scatter.across_chi2, scatter.across_dof)};
}

NoiseModel noiseModel(const campaign::Campaign& campaign, const RepeatScatter& scatter, const Rounded& rounded) {
  NoiseModel model;
  if (!campaign.tracker) {
    model.source = Remark(RemarkId::noise_not_declared);
    return model;
  }
  const campaign::Tracker tracker = asNoisyAs(*campaign.tracker, rounded.factors);
  model.noise = frames::trackerNoise(tracker);
  model.known = model.noise.range_fixed + model.noise.range_per_m > 0.0 &&
                model.noise.angle_fixed + model.noise.angle_per_m > 0.0;
  model.source = Remark(RemarkId::noise_as_declared);
  if (!model.known || !campaign.loading) return model;
  constexpr int kEnough = 30;
  NoiseFactors found;  // beside the rounding
  if (scatter.along_dof >= kEnough) {
    found = {std::sqrt(scatter.along_chi2 / scatter.along_dof), std::sqrt(scatter.across_chi2 / scatter.across_dof)};
    model.degrees = scatter.along_dof + scatter.across_dof;
    const NoiseFactors against_declared = rounded.factors * found;
    model.source = Remark(RemarkId::noise_by_repeats, scatter.along_dof + scatter.across_dof, against_declared.along,
                          against_declared.across);
  } else if (const DistanceScatter distances = distanceScatter(campaign, model.noise); distances.degrees >= kEnough) {
    if (!distances.asDeclared()) found.along = found.across = std::sqrt(distances.ratio);
    model.degrees = distances.degrees;
    model.source = Remark(RemarkId::noise_by_distances, static_cast<int>(distances.degrees), std::sqrt(distances.ratio),
                          distances.asDeclared());
  } else {
    model.source = Remark(RemarkId::noise_as_declared_few_repeats);
  }
  model.noise = frames::trackerNoise(asNoisyAs(tracker, found));
  model.along_factor = rounded.factors.along * found.along;
  model.across_factor = rounded.factors.across * found.across;
  return model;
}

}  // namespace stiffscope::preparation
