#pragma once

#include <array>
#include <memory>
#include <optional>

#include "core/diagnosis/gap_study.h"
#include "core/extended_model/effect_fit.h"
#include "core/extended_model/hidden_effects.h"
#include "core/identification/identification.h"

namespace stiffscope::extended_model {

/// How an effect's uncertainty reaches a method's compliances. With Sigma = S S^T the covariance of the effects' free
/// parameters, one column each: S itself, and the change of the compliances when the parameters move by that column,
/// to first order through the method's equations.
struct EffectSpread {
  Eigen::MatrixXd parameters;                ///< S; rows as EffectFit::free
  std::array<JointsByColumn, 3> compliance;  ///< by Method; rad/Nm
};

/// Joint springs with further effects.
///
/// The effects come from one joint fit (effect_fit.h). The readings are corrected for them once (extend_model.h),
/// and the three methods run on the rest as on any campaign. All that asks for other sizes of the effects goes through
/// the methods' equations A c + E theta = b (method_equations.h). What then stands in `with`:
///  - uncertainty: the scatter between postures that is left, what frames and calibration share, and, as a part of its
///    own, sum_k d_k d_k^T over the columns of EffectSpread. In least squares the two add exactly, because the springs'
///    estimate at given effects is uncorrelated with the effects' own; that the effects are weighted otherwise than the
///    methods leaves a little. Degrees of freedom that the effects' parameters take are counted in sigma and scatter;
///  - displacements are the machine's: corrected for faults of the measurement, with what the machine does besides its
///    springs left in. Shares compensated are of these;
///  - subsets: the effects' parameters are fitted anew on each subset's postures, so that held out is held out.
/// Parts that were chosen because they stand out stay chosen in all of this.
struct ExtendedModel {
  EffectFit effects;
  campaign::Campaign campaign;  ///< what `with` was identified from
  identification::Identification without, with;
  EffectSpread spread;
  std::optional<HiddenEffects> hidden;               ///< of the model that the data support: what could still hide
  std::unique_ptr<const diagnosis::GapStudy> study;  ///< the equations that `hidden` was weighed in; null without it

  /// Chi2 per degree of freedom that the model leaves, of `hidden`; and whether chance makes as much and the diagnosis
  /// does not say otherwise.
  double leftOver() const { return effects.added.empty() ? hidden->lack_of_fit : hidden->left_over; }
  bool residualIsNoise() const { return !hidden->unexplained && leftOver() <= hidden->left_limit; }
};

}  // namespace stiffscope::extended_model
