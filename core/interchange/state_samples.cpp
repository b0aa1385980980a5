#include "core/interchange/state_samples.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/io/input_error.h"

namespace stiffscope::interchange {

std::string shownKey(const StateKey& key) {
  const auto& [axis, pose, step] = key;
  std::string text = axis < 0 ? "" : fmt::format("axis {}, ", axis + 1);
  text += "pose " + pose;
  return step == 0 ? text : text + fmt::format(", step {}", step);
}

bool isTimed(const RobotLog& log) {
  return std::all_of(log.samples.begin(), log.samples.end(),
                     [](const JointSample& sample) { return sample.time_s.has_value(); });
}

void setSamples(JoinedState& state, const RobotLog& log, std::size_t first, std::size_t last) {
  state.first = first;
  state.last = last;
  state.figures = meanFigures(log.samples, first, last);
}

bool takesWrench(const JoinTask& task) {
  // A table has a wrench in every row or in none.
  return task.role == Role::loading && task.day.loads.empty() && !task.log.samples.empty() &&
         task.log.samples.front().wrench.allFinite();
}

namespace {

/// Standard deviation of one sample by how far neighbours are apart, which a change of load now and then leaves alone.
double scatterOf(const std::vector<JointSample>& samples, Eigen::Index component) {
  constexpr double kSigmaPerMad = 1.4826;
  std::vector<double> apart;
  apart.reserve(samples.size());
  for (std::size_t i = 1; i < samples.size(); ++i)
    apart.push_back(std::abs(samples[i].wrench[component] - samples[i - 1].wrench[component]));
  if (apart.empty()) return 0.0;
  const auto middle = apart.begin() + static_cast<std::ptrdiff_t>(apart.size() / 2);
  std::nth_element(apart.begin(), middle, apart.end());
  return kSigmaPerMad * *middle / std::sqrt(2.0);
}

}  // namespace

WrenchSteadiness::WrenchSteadiness(const JoinTask& task) : log_(task.log) {
  // What is less than a return to zero is no load, and less than a newton moves no arm by more than some micrometres.
  constexpr double kScatters = 6.0, kLeast = 1.0;
  const campaign::LoadCell cell = task.day.xml.campaign.load_cell.value_or(campaign::LoadCell{});
  double force = 0.0, moment = 0.0;
  for (const JointSample& sample : log_.samples) {
    force = std::max(force, sample.wrench.head<3>().norm());
    moment = std::max(moment, sample.wrench.tail<3>().norm());
  }
  for (Eigen::Index k = 0; k < allowed_.size(); ++k) {
    // A slow cell's digits repeat from sample to sample and hide its scatter; what is declared of it does not.
    const double scatter = std::max(scatterOf(log_.samples, k), k < 3 ? cell.force_sigma : cell.moment_sigma);
    allowed_[k] = std::max({kScatters * scatter, campaign::kReturnShare * (k < 3 ? force : moment), kLeast});
  }
}

std::optional<WrenchChange> WrenchSteadiness::changeIn(std::size_t first, std::size_t last) const {
  constexpr std::size_t kParts = 10;
  const std::size_t count = last - first + 1, edge = std::max<std::size_t>(1, count / kParts);
  const auto wrench = [&](std::size_t i) -> const Vector6d& { return log_.samples[first + i].wrench; };
  Vector6d after = Vector6d::Zero(), before = Vector6d::Zero();
  for (std::size_t i = 0; i < count; ++i) after += wrench(i);
  std::optional<WrenchChange> change;
  double largest = 1.0;
  for (std::size_t i = 1; i + edge <= count; ++i) {
    before += wrench(i - 1);
    after -= wrench(i - 1);
    if (i < edge) continue;
    const Vector6d left = before / static_cast<double>(i), right = after / static_cast<double>(count - i);
    Eigen::Index component = 0;
    const double excess = (right - left).cwiseAbs().cwiseQuotient(allowed_).maxCoeff(&component);
    if (excess <= largest) continue;
    largest = excess;
    change = WrenchChange{first + i, component, left[component], right[component]};
  }
  return change;
}

void requireSteadyWrench(const JoinTask& task, const WrenchSteadiness& steadiness, const JoinedState& state,
                         const std::string& hint) {
  const auto change = steadiness.changeIn(state.first, state.last);
  if (!change) return;
  constexpr std::array<const char*, 6> kNames{"fx", "fy", "fz", "mx", "my", "mz"};
  const char* const unit = change->component < 3 ? "N" : "Nm";
  const std::vector<JointSample>& samples = task.log.samples;
  throw io::InputError(
      {task.file, samples[change->sample].line, kNames[static_cast<std::size_t>(change->component)]},
      fmt::format("{:.1f} {}", change->after, unit),
      fmt::format("expected one wrench in lines {} to {}, {}; before this line the mean is {:.1f} {}, from it on as "
                  "shown: {}",
                  samples[state.first].line, samples[state.last].line, shownKey({state.axis, state.pose, state.step}),
                  change->before, unit, hint));
}

namespace {

/// Of each joint over the samples that have it; where all are equal, that value to the last digit.
JointVector meanOfGiven(const std::vector<JointVector>& angles, std::size_t first, std::size_t last) {
  JointVector mean;
  if (angles.empty()) return mean;
  mean = JointVector::Constant(angles[first].size(), campaign::kNotGiven);
  for (Eigen::Index j = 0; j < mean.size(); ++j) {
    double start = 0.0, sum = 0.0;
    std::size_t given = 0;
    for (std::size_t i = first; i <= last; ++i) {
      const double angle = angles[i][j];
      if (std::isnan(angle)) continue;
      if (given++ == 0) start = angle;
      sum += angle - start;
    }
    if (given > 0) mean[j] = start + sum / static_cast<double>(given);
  }
  return mean;
}

/// Of the samples that have one; where all are equal, that value to the last digit.
double meanTemperature(const std::vector<JointSample>& samples, std::size_t first, std::size_t last) {
  double start = campaign::kNotGiven, sum = 0.0;
  std::size_t given = 0;
  for (std::size_t i = first; i <= last; ++i) {
    const double temperature = samples[i].temperature_c;
    if (std::isnan(temperature)) continue;
    if (given++ == 0) start = temperature;
    sum += temperature - start;
  }
  return given == 0 ? start : start + sum / static_cast<double>(given);
}

}  // namespace

StateMeans meansOf(const RobotLog& log, std::size_t first, std::size_t last) {
  const std::vector<JointSample>& samples = log.samples;
  const double count = static_cast<double>(last - first + 1);
  // By the differences from the first: where all are equal the mean is that value to the last digit.
  Vector6d wrench = Vector6d::Zero();
  for (std::size_t i = first; i <= last; ++i) wrench += samples[i].wrench - samples[first].wrench;
  return {samples[first].wrench + wrench / count, meanTemperature(samples, first, last),
          meanToolPose(samples, first, last), meanOfGiven(log.motor_side, first, last),
          meanOfGiven(log.commanded, first, last)};
}

std::optional<std::string> leaveWrenchesOut(campaign::Campaign& campaign, std::size_t without, const std::string& day) {
  if (without == 0 || !campaign.states) return std::nullopt;
  std::vector<campaign::State>& rows = campaign.states->rows;
  for (campaign::State& row : rows) row.wrench_in_cell.setConstant(campaign::kNotGiven);
  if (without < rows.size())
    return io::inputMessage(
        {day, 0, "log"}, "",
        fmt::format("wrenches are not taken: {} of {} states have none, and a table has them in all "
                    "rows or in none",
                    without, rows.size()));
  const bool loaded = std::any_of(rows.begin(), rows.end(), [](const campaign::State& row) { return row.step != 0; });
  if (!loaded) return std::nullopt;
  return io::inputMessage(
      {day, 0, "loads"}, "",
      "the load steps have no wrench: neither a file of loads nor the log gives one, and without it "
      "no stiffness can be identified");
}

std::optional<std::string> warningOfUntaken(const RobotLog& log, const std::string& file, bool gives_states,
                                            bool loads_elsewhere) {
  std::vector<std::string> untaken;
  if (!gives_states && !log.motor_side.empty()) untaken.emplace_back("the angles of the motors' side (m1_deg, ...)");
  if (!gives_states && !log.commanded.empty()) untaken.emplace_back("the commanded angles (c1_deg, ...)");
  if (gives_states && loads_elsewhere && log.samples.front().wrench.allFinite())
    untaken.emplace_back("the wrench: that of the file of loads is");
  if (untaken.empty()) return std::nullopt;
  return io::inputMessage({file, 0, "columns"}, "", fmt::format("not taken: {}", fmt::join(untaken, ", ")));
}

}  // namespace stiffscope::interchange
