#include "reports/words/preparation_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/io/units.h"
#include "reports/words/listed.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

std::string driftWords(const preparation::DriftCorrection& drift) {
  if (!drift.taken_off) return fmt::format("no drift of the station taken off: {}", words(drift.reason));
  std::string text =
      fmt::format("the station's motion by the floor nests taken off {} of them: at most {:.3f} mm and {:.0f} urad",
                  drift.readings, drift.displacement / io::kMillimetre, 1e6 * drift.turn);
  if (drift.jumps_s.empty()) {
    text += fmt::format(", a drift over {:.0f} s", drift.until_s);
  } else {
    std::vector<std::string> jumps;
    for (const double time : drift.jumps_s) jumps.push_back(fmt::format("{:.0f} s", time));
    text += fmt::format(", in a jump at about {}", fmt::join(jumps, ", "));
  }
  if (drift.spread > 0) {
    text += fmt::format("; {} of sweeps state no time and are taken as read evenly before the loading", drift.spread);
  }
  if (drift.without_time > 0) {
    text += fmt::format("; {} state no time and stay as they were read", drift.without_time);
  }
  return text;
}

/// How the stations were joined; empty of a day of one.
std::string stationsWords(const std::optional<preparation::JoinedStations>& stations) {
  if (!stations) return {};
  std::vector<std::string> known;
  for (std::size_t s = 1; s < stations->network.stations.size(); ++s) {
    const preparation::StationPose& pose = stations->network.stations[s];
    const preparation::PoseUncertainty at_arm = preparation::poseUncertainty(pose);
    known.push_back(fmt::format("{} ({} readings) to {} and {:.1f} urad by {} nests", preparation::shownStation(pose),
                                stations->readings[s], lengthWords(at_arm.position, 1), 1e6 * at_arm.turn,
                                pose.common_nests));
  }
  return fmt::format(
      "; {} stations joined, known at the arm in the frame of the first, {} (one sigma, common to the readings of "
      "each): "
      "{}",
      stations->network.stations.size(), preparation::shownStation(stations->network.stations.front()),
      fmt::join(known, ", "));
}

}  // namespace

std::string rejectedWords(const preparation::RejectedReading& reading) {
  return fmt::format("{}:{}: {}", reading.file, reading.line, words(reading.reason));
}

std::string preparationWords(const preparation::Preparation& preparation) {
  const std::string stations = stationsWords(preparation.stations);
  if (preparation.raw) return "raw: nothing left out, no drift taken off" + stations;
  const std::size_t count = preparation.rejected.size();
  return fmt::format("{} left out; {}{}", count == 0 ? "none" : std::to_string(count), driftWords(preparation.drift),
                     stations);
}

std::string preparationText(const preparation::Preparation& preparation) {
  std::string text = wrapped(fmt::format("Readings: {}.", preparationWords(preparation)), 0) + '\n';
  const auto words = [](const preparation::RejectedReading& reading) { return "left out: " + rejectedWords(reading); };
  for (const std::string& entry : listed(preparation.rejected, words, kListedInJson))
    text += fmt::format("  {}\n", wrapped(entry, 4));
  return text;
}

}  // namespace stiffscope::reports
