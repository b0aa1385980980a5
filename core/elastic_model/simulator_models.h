#pragma once

#include <string>
#include <vector>

#include "core/elastic_model/elastic_chain.h"

namespace stiffscope::elastic_model {

/// Gain of a drive's position control over the stiffest spring of the chain.
inline constexpr double kDriveGain = 1e3;

/// The chain as a model of MuJoCo (MJCF, its XML reference: body, inertial, joint, site, position): base_link is the
/// world; a drive is a hinge with its limits and a position actuator of the joint's angle, which deflects by a
/// thousandth of what the stiffest spring does; a spring is a hinge or slide with `stiffness`, springref 0. Bodies
/// without a mass have kStandInMass and kStandInInertia. SI and radians; numbers read back as they are. `comments` go
/// to the head of the file, a comment each.
std::string mjcf(const ElasticChain& chain, const std::vector<std::string>& comments);

/// The chain as a world of SDFormat 1.9 with one model, fixed to the world by base_link: a drive is a revolute joint
/// with its limits; a spring is a revolute or prismatic one with spring_stiffness, spring_reference 0. A joint of
/// SDFormat has one axis, so that all springs of a body but the last get links between them; those, and bodies without
/// a mass, have kStandInMass and kStandInInertia and no gravity. Sites are frames. `comments` go to the head of the
/// file.
std::string sdf(const ElasticChain& chain, const std::vector<std::string>& comments);

}  // namespace stiffscope::elastic_model
