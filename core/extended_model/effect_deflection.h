#pragma once

#include <vector>

#include "core/effects/elastic_arm.h"
#include "core/extended_model/extended_model.h"

namespace stiffscope::extended_model {

/// Whether an effect of the machine was added.
bool deflectsByEffects(const EffectFit& effects);

/// What compensation needs of the extended model by one method: the flange at rest on joint springs and with the
/// effects of the machine (ElasticArm; hysteresis: the load put on once, from none; a plate: the flange as the tool
/// beyond it carries it), in the method's geometry. Load-point errors are in the campaign's load cell
/// (ExtendedModel::campaign), which the wrench is to be taken from. Uncertainty: springs at given effects, and each
/// column of the effects' spread with what it does to the springs. `model` must outlive the result.
effects::EffectDeflection effectDeflection(const ExtendedModel& model, identification::Method method);

/// Displacement of points of the flange body by the load with a unit of each parameter of HiddenDraws::columns, to
/// first order: three rows a point, m per unit; `points` stand unloaded in the method's R0, m. Parameters of effects
/// that are faults of the measurement move nothing: the machine does not do it. Needs `model.hidden`.
Eigen::MatrixXd displacementByHidden(const ExtendedModel& model, identification::Method method,
                                     const JointVector& commands, const effects::FlangeLoad& load,
                                     const std::vector<Eigen::Vector3d>& points);

}  // namespace stiffscope::extended_model
