#pragma once

namespace stiffscope::diagnosis {

enum class RemarkId {
  // Why there is no gap to look at, and why the geometry is not tested.
  readings_not_in_robot_frame,  ///< why
  no_usable_posture,
  noise_not_known,  ///< what the noise was found from
  geometry_needs_positions,
  // What an effect was fitted to.
  fitted_parts,      ///< a fitted_part each
  fitted_part,       ///< its name (empty: none), unit, its parameters in that unit
  axes_off_nominal,  ///< largest shift m, largest tilt rad
  // Why the verdict is what it is: full sentences.
  left_by_stiffnesses,       ///< rms m, of noise alone m, chi2 per equation, with positions, motion only there off
  no_effect_passes,          ///< least fall of BIC, least rms m
  geometry_off_nominal,      ///< rms m, tolerance m
  follows_from_geometry,     ///< id of the effect, its parameters
  deflection_not_explained,  ///< rms m
  positions_not_explained,   ///< rms m, limit m
  candidates_only,           ///< ids of effects; share of the gap's squares beyond noise that stays, share that may
  nests_speak_against_drift,
  moves_while_load_stands,  ///< id of the effect; rms m, t
  chi_square_significant,   ///< chi2 per equation that is left, its limit
  positions_scatter,        ///< variance over the noise's, its limit
  floor_nests,              ///< what they say
  positions_take_part,      ///< whether the sweeps do, too
  sweeps_thinned,           ///< readings of a sweep that took part at most
  postures_thinned,         ///< postures, those that took part
  reflectors_thinned,       ///< reflectors, those that took part
  // Why an effect is not added to a day.
  spike_hidden,
  // What to measure next.
  posture_that_separates,  ///< joint angles rad, force N, axis of R0 (0 to 2); chi2: what tells apart, before, after
};

}  // namespace stiffscope::diagnosis
