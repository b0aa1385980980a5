#pragma once

namespace stiffscope::preparation {

/// What there is to say of the readings before use; reports/words has the sentences.
enum class RemarkId {
  at_name,    ///< a row (FILE:LINE) or a name of the data
  by_chance,  ///< the statistic whose limit shares the chance of a false finding: a remark

  // What is missing.
  no_point_readings,
  no_loading,
  no_repeats,
  tracker_noise_not_declared,
  no_floor_nests,
  too_few_nests,
  too_few_rounds_to_tell,

  // Readings that should not be used.
  beam_lost,
  same_as_line,       ///< line of the other reading
  stands_from_state,  ///< m, from the mean of its state's other repeats
  one_of_round_wrong,
  stands_from_nest,  ///< m, from where the other nests put it; nest

  // Screening: what was found, and where its limits come from.
  no_such_readings,
  readings_at_zero,     ///< how many
  readings_repeated,    ///< how many
  repeats_stand_apart,  ///< how many
  nests_stand_apart,    ///< how many
  rounds_of_few_nests,  ///< how many rounds of three nests or fewer, of how many
  nothing_inside_station,
  no_chance_of_same_digits,
  chi_square_of_repeat,
  chi_square_of_nest_reading,

  // The station's course by the nests, and why its motion is not taken off.
  station_stood_still,  ///< rounds of the nests
  nests_deform,
  stations_disagree,
  station_jumped,    ///< m, where the arm was read
  station_wandered,  ///< m, where the arm was read
  no_motion_beyond_noise,
  as_measured_asked_for,
  raw_asked_for,

  // Where the noise of a reading comes from.
  noise_not_declared,
  noise_as_declared,
  noise_as_declared_few_repeats,
  noise_by_distances,  ///< degrees of freedom, found against declared, whether that is by chance
  noise_by_repeats,    ///< degrees of freedom, found against declared: along the beam, across it
};

}  // namespace stiffscope::preparation
