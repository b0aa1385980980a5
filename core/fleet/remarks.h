#pragma once

namespace stiffscope::fleet {

enum class RemarkId {
  // Why a machine needs something.
  no_result,           ///< date, what the program said
  several_machines,    ///< how many under one name, folders of two that are not of one, the difference
  audit_failed,        ///< date, ids of the checks
  audit_not_testable,  ///< date
  effect_appeared,     ///< effects that may be it, date of the first day with it
  effect_gone,         ///< effects, date of the first day without it
  effect_once,         ///< effects, date: on the last day alone
  /// Joint, change over before (infinite, of its sign, where that is not known), U of it, date, p after Holm, dates
  /// from then on to the next change.
  compliance_changed,
  geometry_changed,  ///< date, rms at the reflectors m, p after Holm
  unknown_gap,       ///< date
  joint_imprecise,   ///< joints whose interval is open or wider than their stiffness, date
  dates_scatter,     ///< joint, scatter of the dates over what is stated
  audit_warned,      ///< date, ids of the checks
  // What to do next.
  mend_campaign,
  tell_machines_apart,
  measure_again,   ///< after what failed
  inspect_joint,   ///< joint
  inspect_effect,  ///< effects
  confirm_change,
  follow_next_measurement,
  repeat_same_postures,
  calibrate_again,
  nothing_to_do,
};

}  // namespace stiffscope::fleet
