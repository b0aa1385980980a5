#pragma once

#include "core/effects/effect_model.h"

namespace stiffscope::effects {

/// A link bends and twists along its length: a straight beam from one joint origin to the next, clamped at
/// the inner end, loaded at the outer one by F, M (own weight beyond it and load). Euler-Bernoulli, round
/// section: deflection F_t L^3/3EI + M_t x e L^2/2EI, slope e x F_t L^2/2EI + M_t L/EI, twist M_e L/GJ; e
/// along the beam. Parameters of each link: 1/EI and 1/GJ, 1/(N m^2), never negative; at most 1e-4 (a steel
/// tube of 40 mm).
EffectModel linkCompliance();

}  // namespace stiffscope::effects
