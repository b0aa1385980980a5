#pragma once

namespace stiffscope::accuracy {

/// Why a verdict of an unloaded day is what it is, and what to measure next; reports/words has the sentences.
enum class RemarkId {
  // why
  left_by_geometry,      ///< rms per coordinate m, of noise alone m
  no_effect_passes,      ///< least size m
  effects_not_asked,     ///< postures, postures that it takes
  geometry_off_nominal,  ///< rms per coordinate m, limit m
  not_explained,         ///< rms per coordinate m beyond noise, limit m
  not_looked_into,       ///< the same, where no effect was asked for
  candidates_only,       ///< ids of effects; share of the gap's squares beyond noise that stays, share that may
  not_in_every_fold,     ///< id of the effect
  less_than_unknown,     ///< id of the effect; its rms per coordinate m, that of what is not explained m
  too_small,             ///< id of the effect; rms per coordinate m, limit m
  nests_show_station,    ///< whether it jumped; largest displacement m
  nests_stand,
  // what an effect would need
  needs_masses,
  // what to measure next
  measure_under_load,     ///< ids: hang weights, the same postures
  measure_nests,          ///< ids: floor nests between postures
  measure_moves,          ///< ids: postures approached from either side, by short and long moves
  measure_repeats,        ///< ids: some postures again and again over the day
  measure_scale_bar,      ///< ids: a known length
  measure_more_postures,  ///< ids: more shapes of the arm
  measure_temperature,    ///< ids: temperatures beside the postures
  measure_enough,         ///< postures that it takes to ask for effects
};

}  // namespace stiffscope::accuracy
