#pragma once

#include <string>
#include <vector>

#include "core/elastic_model/elastic_chain.h"

namespace stiffscope::elastic_model {

/// The chain as a model of MuJoCo (MJCF, its XML reference: body, inertial, joint, site, equality): base_link is the
/// world; a drive is a hinge with its limits, held at an angle by an equality constraint (polycoef[0], 0 as written); a
/// spring is a hinge or slide with `stiffness`, springref 0. Bodies without a mass have kStandInMass and
/// kStandInInertia. SI and radians; numbers read back as they are. `comments` go to the head of the file, a comment
/// each.
std::string mjcf(const ElasticChain& chain, const std::vector<std::string>& comments);

}  // namespace stiffscope::elastic_model
