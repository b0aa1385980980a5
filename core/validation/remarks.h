#pragma once

namespace stiffscope::validation {

/// What a rate of the blind test counts. None carries a value.
enum class RemarkId {
  singles_right,
  singles_from_2_first,
  singles_from_5_first,
  singles_from_2_alone,
  singles_from_5_alone,
  singles_from_2_found,
  clean_alarmed,
  clean_alarmed_noise_right,
  clean_alarmed_noise_wrong,
  outside_unknown,
  outside_from_2_unknown,
  outside_apart_unknown,
  outside_from_2_none,
  outside_wrongly_named,
  outside_unknown_beside_a_name,
  as_is_right,
  as_is_wrongly_named,
  as_is_unknown,
  as_is_none,
  as_is_effects_found,
  as_is_effects_from_2_found,
  doubles_right,
  doubles_found,
  doubles_one_found,
  details_right,
  cases_failed,
  shrinks_seen_covered,
};

}  // namespace stiffscope::validation
