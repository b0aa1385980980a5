#pragma once

namespace stiffscope::accuracy {

/// Why a verdict of an unloaded day is what it is, and what to measure next; reports/words has the sentences.
enum class RemarkId {
  left_by_geometry,      ///< rms per coordinate m, of noise alone m
  no_effect_passes,      ///< least size m
  geometry_off_nominal,  ///< rms m, limit m
  not_explained,         ///< rms per coordinate m, of noise alone m
  held_out_by_effects,   ///< rms m before, after
};

}  // namespace stiffscope::accuracy
