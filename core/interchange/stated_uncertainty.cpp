#include "core/interchange/day_files.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "core/io/input_error.h"
#include "core/io/units.h"

namespace stiffscope::interchange {

namespace {

double middleOf(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

std::optional<StatedUncertainty> statedUncertainty(const std::vector<DayFiles::Points>& files,
                                                   const std::optional<campaign::Tracker>& tracker) {
  std::vector<double> sigmas, ratios;
  for (const DayFiles::Points& file : files) {
    for (const PointReading& point : file.content.points) {
      if (!point.sigma) continue;
      sigmas.push_back(point.sigma->norm() / std::sqrt(3.0));
      if (!tracker) continue;
      const double distance = (point.point - tracker->station).norm();
      const double along = tracker->range_fixed + tracker->range_per_m * distance,
                   across = tracker->angle_fixed + tracker->angle_per_m * distance;
      ratios.push_back(point.sigma->norm() / std::sqrt(along * along + 2.0 * across * across));
    }
  }
  if (sigmas.empty()) return std::nullopt;
  StatedUncertainty stated;
  stated.sigma = middleOf(sigmas);
  stated.compared = ratios.size();
  if (!ratios.empty()) stated.over_declared = middleOf(ratios);
  return stated;
}

std::optional<std::string> warningOf(const StatedUncertainty& stated, const std::string& file) {
  if (!stated.over_declared) return std::nullopt;
  const double ratio = *stated.over_declared;
  // As the audit's check of declared noise.
  constexpr double kApart = 2.0;
  if (ratio <= kApart && ratio >= 1.0 / kApart) return std::nullopt;
  return io::inputMessage(
      {file, 0, "tracker"}, "",
      fmt::format("the uncertainties in the files, {:.1f} um (median of {} readings), are {:.2g} times the noise "
                  "declared of the tracker",
                  stated.sigma / io::kMicrometre, stated.compared, ratio));
}

}  // namespace stiffscope::interchange
