#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/diagnosis/gap_study.h"
#include "core/extended_model/effect_offsets.h"
#include "core/extended_model/fitted_effects.h"
#include "core/extended_model/seen_combinations.h"
#include "core/identification/identification.h"

namespace stiffscope::extended_model {

/// Where a part of a joint's uncertainty comes from.
enum class BudgetSource {
  scatter,         ///< between postures: noise, and what the model does not explain
  frames,          ///< the measured axes
  wrist,           ///< radii about the wrist centre
  geometry,        ///< calibrated on unloaded positions
  effect,          ///< an effect: of its fitted size where it is in the model, of all that could hide where it is not
  correlation,     ///< what the effects' parts have in common: they are known less well one by one than together
  load_cell_gain,  ///< as declared
  masses,          ///< the URDF's, as declared
  tracker_scale,   ///< as declared
  standing_load,   ///< joints go on deflecting while a load stays on (course_of_day.h)
  over_day,        ///< compliances grow or shrink over the day
  apparent,        ///< between this model and joint springs alone, where no model explains the gap
};

/// One line of the budget of all six joints (GUM, annex H).
struct BudgetLine {
  BudgetSource source = BudgetSource::scatter;
  std::optional<effects::Effect> effect;
  bool in_model = false;                 ///< of an effect: fitted, not only possible
  bool declared = false;                 ///< of an effect: its size is known beforehand from what is declared
  Vector6d variance = Vector6d::Zero();  ///< of c, rad^2/(Nm)^2; negative where a correlation takes away
  Vector6d dof = Vector6d::Zero();       ///< degrees of freedom; 0: known exactly, or from all draws together
};

/// What the day declares with a standard uncertainty, and what one of these does; and what its course shows.
struct Declared {
  double gain_sd = 0.0;        ///< of the load cell's scale, a share
  double cell_angle_sd = 0.0;  ///< of its axes about each of these, rad: of load_cell_misalignment beforehand
  double cell_point_sd = 0.0;  ///< of its point along each axis, m: of load_point_error beforehand

  struct Column {
    BudgetSource source = BudgetSource::masses;
    std::array<Vector6d, 3> compliance;  ///< by Method: change by one standard uncertainty, rad/Nm
  };
  std::vector<Column> columns;
};

/// What else may be true of the machine, a draw each column: all that intervals and predictions are made of.
struct HiddenDraws {
  EffectColumns columns;                ///< the effects' parameters in the study's equations
  std::vector<effects::Effect> effect;  ///< of each of them
  std::vector<HiddenParameter> named;   ///< the same with its name and fitted size
  std::vector<bool> declared;           ///< whether its size is known beforehand
  Eigen::MatrixXd off;                  ///< theta - theta_fit

  /// Errors of one method's compliances.
  struct OfMethod {
    std::vector<Eigen::Index> possible;                   ///< draws in which no stiffness is negative
    Eigen::Matrix<double, 6, Eigen::Dynamic> compliance;  ///< c of these draws less the estimate's, rad/Nm
    Matrix6d others = Matrix6d::Zero();  ///< covariance of c by what is no effect, for normal numbers of its coverage
  };
  std::array<OfMethod, 3> methods;  ///< by Method; without draws where that is not available
};

/// How far the data let anything besides the fitted model move the stiffnesses.
struct HiddenEffects {
  double lack_of_fit = 0.0;  ///< chi2 per equation of the loading that joint springs alone leave
  double left_over = 0.0;    ///< that of the model
  /// Share of the gap beyond noise that the model leaves, and whether that is too much to call the model an
  /// explanation: then the intervals hold what joint springs alone say, too.
  double unexplained_share = 0.0;
  bool unexplained = false;
  std::array<std::vector<BudgetLine>, 3> budget;  ///< by Method; empty where that is not available
  /// By Method: what is seen of joints that the data does not tell from an effect; none where no model explains the
  /// gap.
  std::array<std::vector<SeenCombination>, 3> combinations;
  HiddenDraws draws;
  double gain_sd = 0.0;  ///< of the load cell's scale, as declared
};

/// Puts into the estimates of `with` the intervals that hold what could still hide.
///
/// With theta the parameters of all effects that the campaign can show, a method's compliances are to first order c
/// = c_fit - H (theta - theta_fit): H through the method's own equations (method_equations.h), theta_fit what `with`
/// was corrected for, theta from its posterior on the study's equations (effect_posterior.h). Draws with a negative
/// stiffness are left out, and where c_fit itself has one the medians of the rest stand for it. With the scatter
/// between postures, what frames and calibration share, and what is declared (Declared) they give each interval by its
/// quantiles; it is widened to hold c_fit. Where angles or point of the load cell are declared with an uncertainty,
/// that is what is known beforehand of the effect that they are.
///
/// Where the model explains too little, half of the draws are those of `without`, joint springs alone: neither is
/// right.
///
/// The frames of `with` get what the same draws do to them.
///
/// `seen`: cases and equations from which H is taken, of postures that the study has; `with` itself where it has all.
/// `seen_campaign`: what `seen` was identified from.
HiddenEffects weighHiddenEffects(const diagnosis::GapStudy& study, const EffectFit& fitted,
                                 const campaign::Campaign& seen_campaign, const identification::Identification& seen,
                                 const identification::Identification& without, const Declared& declared,
                                 identification::Identification& with);

}  // namespace stiffscope::extended_model
