#pragma once

#include "core/audit/station_motion.h"

namespace stiffscope {

/// What the floor nests say of the tracker: it stood, it jumped once, or it wandered.
enum class StationCourse { not_tested, still, jumped, drifted };

struct Station {
  StationCourse course = StationCourse::not_tested;
  StationMotion motion;      ///< its epochs smoothed: one jump, or a steady drift, where either fits them
  double moved_by = 0.0;     ///< largest displacement where the arm was read, m
  std::string in_words;
};

/// Holds one jump (6 parameters and when) and a steady drift (6) against the rounds of the nests, by weighted least squares;
/// the better one is taken where it fits within its noise, else the rounds stay as they are and the course is a drift.
Station stationCourse(const Campaign& campaign, const std::optional<TrackerNoise>& noise);

}  // namespace stiffscope
