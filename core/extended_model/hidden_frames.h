#pragma once

#include "core/diagnosis/gap_study.h"
#include "core/extended_model/effect_offsets.h"
#include "core/identification/identification.h"

namespace stiffscope::extended_model {

/// How draws of effects' parameters move what the sweeps give: FramesCovariance's numbers, a draw each column. The
/// sweeps are read unloaded, so that effects act through the own weight: parameter k off by t_k leaves -X_k t_k in
/// readings that were corrected for its fitted size, X_k the effect's column there, and the compliances by which the
/// sag is taken off follow it by `compliance_off`. To first order, by one difference of the whole measurement for each
/// parameter.
///
/// `off`: theta - theta_fit, rows as `columns.parameters`; `compliance_off`: of the method by which the sag was taken
/// off, at `compliance`. `campaign`: the corrected day that `frames` was measured from. No columns where no sag was
/// taken off.
Eigen::MatrixXd framesByEffects(const diagnosis::GapStudy& study, const EffectColumns& columns,
                                const Eigen::MatrixXd& off, const Eigen::MatrixXd& compliance_off,
                                const campaign::Campaign& campaign, const frames::Frames& frames,
                                const Vector6d& compliance);

}  // namespace stiffscope::extended_model
