#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/interchange/joint_log.h"

namespace stiffscope::interchange {

/// A stretch of a log in which the joints stand still: every joint stays within a band, for a time.
struct Standstill {
  std::size_t first = 0, last = 0;  ///< samples
  double from_s = 0.0, to_s = 0.0;  ///< by the robot's clock
};

struct StandstillOptions {
  double band =
      0.0;  ///< rad, of each joint; encoders' noise is below it, and the share of a motion that counts as still
  double shortest_s = 1.0;  ///< what is shorter is a pause of a motion
};

/// Standstills of a log whose samples have times, in their order.
std::vector<Standstill> standstillsOf(const std::vector<JointSample>& samples, const StandstillOptions& options);

/// Mean of the figures of samples first..last; where all are equal, that value to the last digit.
Vector6d meanFigures(const std::vector<JointSample>& samples, std::size_t first, std::size_t last);

/// Mean of the poses that the controller states in samples first..last, turns as rotations; where all are equal, that
/// pose to the last digit. Without what one of them lacks.
campaign::StatedPose meanToolPose(const std::vector<JointSample>& samples, std::size_t first, std::size_t last);

/// A reading's time by the tracker's clock.
struct ReadingTime {
  double seconds = 0.0, resolution = 0.0;
};

/// Where the robot's clock stands beside the tracker's: t_robot = t_tracker + offset.
struct ClockOffset {
  double offset_s = 0.0;
  double uncertainty_s = 0.0;  ///< the offset lies within it: half of the offsets that serve equally
  std::size_t inside = 0;      ///< readings that fall into standstills by it
};

/// Offsets by which readings fall into standstills, the one of the most readings first. A reading may be off by the
/// last digit of its time, to either side. Starts and ends of motion bound each: an offset is the middle of those that
/// put the same readings (but 0.5 %) into standstills. Others follow as far as they put at least `share` of the most
/// into standstills, and do not touch a better one. Empty without readings or standstills.
std::vector<ClockOffset> possibleOffsets(const std::vector<ReadingTime>& readings,
                                         const std::vector<Standstill>& standstills, double share);

}  // namespace stiffscope::interchange
