#pragma once

namespace stiffscope::calibration {

/// Why there is no calibration, and what to know of one; reports/words has the sentences.
enum class RemarkId {
  // why there is none
  no_unloaded_readings,
  too_few_readings,  ///< readings, parameters
  not_placed,
  not_settling,
  // readings
  off_the_model,  ///< m, from where the fullest model has it
  // axis parameters that are not determined: axis number, which (0, 1 place along u, v; 2, 3 direction along u, v)
  choice_of_frame,
  not_seen,
  hardly_seen,  ///< and its standard uncertainty, m or rad
  // own weight
  no_masses,
  negative_compliance,  ///< what it is called
  // effects
  no_effect_predicts,
  too_few_for_effects,  ///< postures, postures needed
};

}  // namespace stiffscope::calibration
