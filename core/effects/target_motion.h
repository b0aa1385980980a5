#pragma once

#include "core/effects/effect_model.h"

namespace stiffscope::effects {

/// One reflector moves in its nest under load. Shapes of its shift u, R the flange's axes, f the force on the
/// tool in them, F the campaign's largest force (N), u in m, parameters at most 5 mm each way:
///  - in proportion to the load: u = R a |f|/F, three parameters a reflector;
///  - by a step as soon as it is loaded: u = R a, gone without load;
///  - by a slip that stays: u = R a from the first load on, through the return to zero; or only once the
///    force has passed half, or four fifths, of F;
///  - by a spring of the nest: u = R A f/F, A symmetric (xx, yy, zz, xy, xz, yz), six a reflector;
///  - by a slip along the pull that stays: u = a R p/F, p the largest f so far, one a reflector.
EffectModel targetMotion(const std::vector<std::string>& targets);
EffectModel targetSlip(const std::vector<std::string>& targets);
EffectModel targetLastingSlip(const std::vector<std::string>& targets);
EffectModel targetSlipFromHalf(const std::vector<std::string>& targets);
EffectModel targetSlipAtFull(const std::vector<std::string>& targets);
EffectModel targetNestSpring(const std::vector<std::string>& targets);
EffectModel targetPulledAlong(const std::vector<std::string>& targets);

}  // namespace stiffscope::effects
