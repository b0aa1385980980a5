#pragma once

#include <vector>

#include "core/campaign/campaign.h"
#include "core/effects/effect_model.h"
#include "core/elastic_model/elastic_chain.h"
#include "core/elastic_model/remarks.h"
#include "core/frames/arm_geometry.h"
#include "core/identification/estimate.h"
#include "metrology/remark.h"

namespace stiffscope::elastic_model {

/// What a chain is made from: one method's geometry and stiffnesses, and the effects beside them.
struct ElasticSource {
  const campaign::Campaign& campaign;
  const frames::LoadingGeometry& geometry;            ///< the method's own, in R0
  const identification::StiffnessEstimate& estimate;  ///< of the joint springs beside the effects
  Eigen::Vector3d tcp_in_flange = Eigen::Vector3d::Zero();
  std::vector<effects::PresentEffect> effects = {};  ///< of the machine, with their sizes
  std::vector<effects::Effect> added = {};           ///< all that were fitted; named where the chain lacks them
  PerBody<Eigen::Matrix3d> inertias = {};  ///< robot::bodyInertias of the campaign's URDF; empty: point masses
};

struct ElasticModel {
  ElasticChain chain;
  std::vector<Remark> remarks;  ///< what the chain lacks, or has instead
};

/// The arm that `compensate` predicts by, as a chain of bodies and linear springs in series.
///  - Joint j: a drive and, on the same axis, a spring of stiffness 1/c_j. Rigid where c_j is not identifiable or not
///    positive.
///  - bearing_tilt: two more springs of 1/s_j about two directions across the axis, through its point. They move with
///    the joint; s is alike in all directions, so that this does not matter.
///  - link_compliance: a beam of length L clamped at one joint's point, loaded at the next one's. The effect's matrix
///    (Euler and Bernoulli), carried from the tip to the middle of the beam, is diagonal: of stiffnesses EI/L about and
///    12 EI/L^3 along the two directions across, GJ/L about the beam. Springs of these stand there, between the link
///    and the next joint's axis.
///  - base_compliance: about x and y and along x, y, z of base_link (of an arm on a rail: effects::footAxes), at its
///    origin.
///  - tool_compliance: about and along the flange's axes, at its origin; what it carries (by the effect's shape the
///    load alone, or all that the last body weighs as well) lies beyond it.
/// Other effects of the machine are no springs in series and are named in the remarks, those of the measurement too.
/// Weights are those of the geometry; where no masses are known there are none. Sites: R0, the flange, tcp, load_point
/// (axes of the load cell), and each reflector whose place is known.
ElasticModel elasticModel(const ElasticSource& source);

}  // namespace stiffscope::elastic_model
