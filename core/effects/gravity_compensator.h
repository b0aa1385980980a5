#pragma once

#include "core/effects/effect_model.h"

namespace stiffscope::effects {

/// A spring on axis 2 that the model does not have: a torque that depends on q_2, as a spring
/// between a point of the column and a point of the arm has it: k (l - l_0) a b sin(phi) / l, smooth in phi =
/// q_2 + phi_0 and written as its Fourier series without the constant (a joint zero), T = sum_n S_n sin n q_2
/// + C_n cos n q_2, n to 4. It turns joint 2 by c_2 T unloaded, and changes its give under load by c_2
/// T'(q_2) c_2 tau_2. S_n, C_n in Nm.
EffectModel gravityCompensator();

}  // namespace stiffscope::effects
