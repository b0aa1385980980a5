#include "core/interchange/day_description.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "core/robot/kinematics.h"

namespace stiffscope::interchange {

namespace {

/// Largest and smallest figure of each joint in a window of samples that only moves forwards.
class Band {
 public:
  explicit Band(const std::vector<JointSample>& samples)
      : samples_(samples),
        largest_(samples.empty() ? 0 : static_cast<std::size_t>(samples.front().figures.size())),
        smallest_(largest_.size()) {}

  void add(std::size_t sample) {
    for (std::size_t j = 0; j < largest_.size(); ++j) {
      const auto figure = [&](std::size_t s) { return samples_[s].figures[static_cast<Eigen::Index>(j)]; };
      while (!largest_[j].empty() && figure(largest_[j].back()) <= figure(sample)) largest_[j].pop_back();
      while (!smallest_[j].empty() && figure(smallest_[j].back()) >= figure(sample)) smallest_[j].pop_back();
      largest_[j].push_back(sample);
      smallest_[j].push_back(sample);
    }
  }

  void removeBefore(std::size_t sample) {
    for (std::size_t j = 0; j < largest_.size(); ++j) {
      while (!largest_[j].empty() && largest_[j].front() < sample) largest_[j].pop_front();
      while (!smallest_[j].empty() && smallest_[j].front() < sample) smallest_[j].pop_front();
    }
  }

  double width() const {
    double widest = 0.0;
    for (std::size_t j = 0; j < largest_.size(); ++j) {
      if (largest_[j].empty()) continue;
      const auto joint = static_cast<Eigen::Index>(j);
      widest = std::max(widest,
                        samples_[largest_[j].front()].figures[joint] - samples_[smallest_[j].front()].figures[joint]);
    }
    return widest;
  }

 private:
  const std::vector<JointSample>& samples_;
  PerJoint<std::deque<std::size_t>> largest_, smallest_;
};

/// Cuts off what the band lets in of the motions before and behind: samples at the ends that are farther from the
/// median than three times the scatter, which is none where the log repeats its digits.
void trimMotion(const std::vector<JointSample>& samples, std::size_t& first, std::size_t& last) {
  constexpr double kScatters = 3.0, kSigmaPerMad = 1.4826;
  const std::size_t count = last - first + 1;
  JointVector median(samples[first].figures.size()), allowed(median.size());
  std::vector<double> values(count);
  const auto medianOf = [&values] {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  };
  for (Eigen::Index j = 0; j < median.size(); ++j) {
    for (std::size_t i = 0; i < count; ++i) values[i] = samples[first + i].figures[j];
    median[j] = medianOf();
    for (std::size_t i = 0; i < count; ++i) values[i] = std::abs(samples[first + i].figures[j] - median[j]);
    allowed[j] = kScatters * kSigmaPerMad * medianOf();
  }
  const auto still = [&](std::size_t i) {
    return ((samples[i].figures - median).cwiseAbs().array() <= allowed.array()).all();
  };
  std::size_t from = first, to = last;
  while (from < to && !still(from)) ++from;
  while (to > from && !still(to)) --to;
  if (to == from) return;  // it never stood: the band says all there is to say
  first = from;
  last = to;
}

/// Readings of one time, and how many.
struct TimeGroup {
  double seconds = 0.0;
  std::size_t count = 0;
};

std::vector<TimeGroup> groupsOf(const std::vector<ReadingTime>& readings) {
  std::vector<double> times;
  for (const ReadingTime& reading : readings) times.push_back(reading.seconds);
  std::sort(times.begin(), times.end());
  std::vector<TimeGroup> groups;
  for (const double time : times) {
    if (!groups.empty() && time == groups.back().seconds) {
      ++groups.back().count;
    } else {
      groups.push_back({time, 1});
    }
  }
  return groups;
}

/// Of very many groups some, evenly: enough to see which offsets there are.
std::vector<TimeGroup> someOf(const std::vector<TimeGroup>& groups, std::size_t standstills) {
  constexpr std::size_t kMostPairs = 2'000'000, kFewest = 200;
  const std::size_t most = std::max(kFewest, kMostPairs / standstills);
  if (groups.size() <= most) return groups;
  std::vector<TimeGroup> some;
  for (std::size_t i = 0; i < most; ++i) some.push_back(groups[i * groups.size() / most]);
  return some;
}

/// Where the number of readings in standstills changes, as the offset grows.
struct CountChange {
  double offset = 0.0;
  std::ptrdiff_t by = 0;
};

struct OffsetRange {
  double from = 0.0, to = 0.0;
  std::size_t inside = 0;
};

/// Standstills wider by the last digit of the readings' times at both ends, but never into each other: a reading is in
/// one of them.
std::vector<Standstill> widened(std::vector<Standstill> standstills, double resolution) {
  const std::vector<Standstill> own = standstills;
  for (std::size_t i = 0; i < own.size(); ++i) {
    standstills[i].from_s -= resolution;
    standstills[i].to_s += resolution;
    if (i > 0) standstills[i].from_s = std::max(standstills[i].from_s, 0.5 * (own[i - 1].to_s + own[i].from_s));
    if (i + 1 < own.size())
      standstills[i].to_s = std::min(standstills[i].to_s, 0.5 * (own[i].to_s + own[i + 1].from_s));
  }
  return standstills;
}

/// Ranges of offsets within `window` with one count of readings each, in ascending order. Standstills are widened.
std::vector<OffsetRange> countedOffsets(const std::vector<TimeGroup>& groups,
                                        const std::vector<Standstill>& standstills, const OffsetRange& window) {
  std::vector<CountChange> changes;
  for (const TimeGroup& group : groups) {
    auto still = std::lower_bound(standstills.begin(), standstills.end(), group.seconds + window.from,
                                  [](const Standstill& one, double time) { return one.to_s < time; });
    for (; still != standstills.end() && still->from_s <= group.seconds + window.to; ++still) {
      const auto count = static_cast<std::ptrdiff_t>(group.count);
      changes.push_back({std::max(still->from_s - group.seconds, window.from), count});
      changes.push_back({std::min(still->to_s - group.seconds, window.to), -count});
    }
  }
  std::sort(changes.begin(), changes.end(), [](const CountChange& a, const CountChange& b) {
    return a.offset != b.offset ? a.offset < b.offset : a.by > b.by;
  });
  std::vector<OffsetRange> ranges;
  std::ptrdiff_t inside = 0;
  for (std::size_t i = 0; i + 1 < changes.size(); ++i) {
    inside += changes[i].by;
    if (changes[i].offset == changes[i + 1].offset) continue;
    if (inside > 0) ranges.push_back({changes[i].offset, changes[i + 1].offset, static_cast<std::size_t>(inside)});
  }
  return ranges;
}

/// The place of the range with the most readings, of several the widest; ranges.size() where all are taken.
std::size_t bestRange(const std::vector<OffsetRange>& ranges, const std::vector<bool>& taken) {
  std::size_t best = ranges.size();
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const bool better = best == ranges.size() || ranges[i].inside > ranges[best].inside ||
                        (ranges[i].inside == ranges[best].inside &&
                         ranges[i].to - ranges[i].from > ranges[best].to - ranges[best].from);
    if (!taken[i] && better) best = i;
  }
  return best;
}

/// Around the range with the most readings, all that lose next to none of them.
OffsetRange plateauAt(const std::vector<OffsetRange>& ranges, std::size_t best, std::size_t& first, std::size_t& last) {
  constexpr double kServesEqually = 0.995;
  const auto equal = [&](std::size_t i) {
    return static_cast<double>(ranges[i].inside) >= kServesEqually * static_cast<double>(ranges[best].inside);
  };
  first = last = best;
  while (first > 0 && ranges[first - 1].to == ranges[first].from && equal(first - 1)) --first;
  while (last + 1 < ranges.size() && ranges[last].to == ranges[last + 1].from && equal(last + 1)) ++last;
  return {ranges[first].from, ranges[last].to, ranges[best].inside};
}

/// All readings bound an offset that some of them showed.
OffsetRange boundedByAll(const OffsetRange& shown, const std::vector<TimeGroup>& groups,
                         const std::vector<Standstill>& standstills) {
  const std::vector<OffsetRange> ranges = countedOffsets(groups, standstills, shown);
  std::size_t first = bestRange(ranges, std::vector<bool>(ranges.size())), last = first;
  return plateauAt(ranges, first, first, last);
}

}  // namespace

std::vector<Standstill> standstillsOf(const std::vector<JointSample>& samples, const StandstillOptions& options) {
  std::vector<Standstill> found;
  Band band(samples);
  std::size_t from = 0, end = 0;  // the window is from..end-1
  const auto time = [&](std::size_t i) { return *samples[i].time_s; };
  while (from < samples.size()) {
    end = std::max(end, from);
    while (end < samples.size()) {
      band.add(end);
      if (band.width() > options.band) break;
      ++end;
    }
    const bool long_enough = end > from + 1 && time(end - 1) - time(from) >= options.shortest_s;
    if (long_enough) {
      std::size_t first = from, last = end - 1;
      trimMotion(samples, first, last);
      found.push_back({first, last, time(first), time(last)});
    }
    if (end >= samples.size()) break;
    // Behind a standstill the next one starts anew; else the window loses its first samples until the next fits.
    from = long_enough ? end : from + 1;
    band.removeBefore(from);
    while (from < end && band.width() > options.band) band.removeBefore(++from);
    if (end < samples.size() && from <= end) ++end;
  }
  return found;
}

JointVector meanFigures(const std::vector<JointSample>& samples, std::size_t first, std::size_t last) {
  const JointVector start = samples[first].figures;
  JointVector sum = JointVector::Zero(start.size());
  for (std::size_t i = first; i <= last; ++i) sum += samples[i].figures - start;
  return start + sum / static_cast<double>(last - first + 1);
}

campaign::StatedPose meanToolPose(const std::vector<JointSample>& samples, std::size_t first, std::size_t last) {
  const campaign::StatedPose& start = samples[first].tool_pose;
  campaign::StatedPose mean = start;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d turns = Eigen::Matrix3d::Zero();
  bool turned = false;
  for (std::size_t i = first; i <= last; ++i) {
    const campaign::StatedPose& pose = samples[i].tool_pose;
    sum += pose.position - start.position;
    turned = turned || pose.rpy != start.rpy;
    turns += robot::rotationFromRpy(pose.rpy);
  }
  mean.position = start.position + sum / static_cast<double>(last - first + 1);
  if (!turned || !turns.allFinite()) {
    if (!turns.allFinite()) mean.rpy.setConstant(campaign::kNotGiven);
    return mean;
  }
  // Angles jump from 180 to -180 deg within the last digit; rotations do not. The nearest one to their sum is the mean.
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(turns, Eigen::ComputeFullU | Eigen::ComputeFullV);
  mean.rpy = robot::rpyFromRotation(svd.matrixU() * svd.matrixV().transpose());
  return mean;
}

std::vector<ClockOffset> possibleOffsets(const std::vector<ReadingTime>& readings,
                                         const std::vector<Standstill>& standstills, double share) {
  std::vector<ClockOffset> offsets;
  if (readings.empty() || standstills.empty()) return offsets;
  double resolution = 0.0;
  for (const ReadingTime& reading : readings) resolution = std::max(resolution, reading.resolution);
  const std::vector<Standstill> wide = widened(standstills, resolution);
  const std::vector<TimeGroup> groups = groupsOf(readings), some = someOf(groups, standstills.size());
  constexpr double kEver = std::numeric_limits<double>::infinity();
  const std::vector<OffsetRange> ranges = countedOffsets(some, wide, {-kEver, kEver, 0});
  std::vector<bool> taken(ranges.size());
  constexpr std::size_t kMostOffsets = 20;
  std::size_t most = 0;
  while (offsets.size() < kMostOffsets) {
    const std::size_t best = bestRange(ranges, taken);
    if (best == ranges.size() || static_cast<double>(ranges[best].inside) < share * static_cast<double>(most)) break;
    std::size_t first = best, last = best;
    OffsetRange plateau = plateauAt(ranges, best, first, last);
    most = std::max(most, plateau.inside);
    if (some.size() < groups.size()) plateau = boundedByAll(plateau, groups, wide);
    offsets.push_back({0.5 * (plateau.from + plateau.to), 0.5 * (plateau.to - plateau.from), plateau.inside});
    // Its slopes are no offsets of their own.
    const auto fallsFrom = [&](std::size_t one, std::size_t next) { return ranges[next].inside <= ranges[one].inside; };
    for (std::size_t i = first; i <= last; ++i) taken[i] = true;
    for (std::size_t i = first; i > 0 && ranges[i - 1].to == ranges[i].from && fallsFrom(i, i - 1); --i)
      taken[i - 1] = true;
    for (std::size_t i = last; i + 1 < ranges.size() && ranges[i].to == ranges[i + 1].from && fallsFrom(i, i + 1); ++i)
      taken[i + 1] = true;
  }
  std::stable_sort(offsets.begin(), offsets.end(),
                   [](const ClockOffset& a, const ClockOffset& b) { return a.inside > b.inside; });
  return offsets;
}

}  // namespace stiffscope::interchange
