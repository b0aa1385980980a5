#pragma once

#include <string>
#include <vector>

#include "core/elastic_model/elastic_chain.h"

namespace stiffscope::elastic_model {

/// The chain as a world of SDFormat 1.9 with one model, fixed to the world by base_link: a drive is a revolute joint
/// with its limits; a spring is a revolute or prismatic one with spring_stiffness, spring_reference 0. A joint of
/// SDFormat has one axis, so that all springs of a body but the last get links between them; those, and bodies without
/// a mass, have kStandInMass and kStandInInertia and no gravity. Sites are frames. `comments` go to the head of the
/// file.
std::string sdf(const ElasticChain& chain, const std::vector<std::string>& comments);

}  // namespace stiffscope::elastic_model
