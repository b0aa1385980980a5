#pragma once

namespace stiffscope::extended_model {

enum class RemarkId {
  // How the model came to its effects.
  diagnosis_has_no_gap,  ///< why
  diagnosis_names_none,
  diagnosis_finds_unknown,  ///< besides what it names
  diagnosis_finds_only_unknown,
  effects_do_not_help,        ///< what was chosen leaves more than springs alone on postures held out
  effects_make_negative,      ///< with what was chosen a stiffness is negative, and hardly any size of it leaves none
  sizes_leave_none_negative,  ///< not where the fit is best
  springs_contradicted,       ///< every stiffness is negative: wrench and readings contradict each other
  taken_of_a_class,           ///< id of the effect, ids of those that cannot be told from it
  // Why an effect cannot be fitted.
  no_gap_to_fit,        ///< why
  lacks_what_shows_it,  ///< what is missing
  not_told_from_stiffnesses,
  reflector_takes_no_part,  ///< its name; how many reflectors take part
  // Why a posture is left out.
  not_read_in_all_steps,
  // What to beware of.
  moves_while_load_stands,  ///< growth between first and last repeat, a share of the displacement
  changes_over_the_day,     ///< of all compliances from the first posture to the last, a share; its t
  /// Chi2 per equation of the model, of springs alone, whether no effect explains it; what these have in their noise,
  /// once
  /// a posture at the largest load, m.
  residual_beyond_noise,
};

}  // namespace stiffscope::extended_model
