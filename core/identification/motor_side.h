#pragma once

#include "core/campaign/campaign.h"

namespace stiffscope::identification {

/// A campaign whose reported angles of joints with a held motor are referred to the motor's side, all others as they
/// are.
///
/// Methods and diagnosis take the reported angle for the one from which a joint gives by its whole compliance, under
/// its own weight too. Where the motor is held but the angle is read beyond the gear, gear and weight have already
/// turned it. For each joint whose motor is seen to be held (transmission.h) states get q = m + the encoders' zero,
/// with what was read in State::link_side, and the sweeps q less the gear's wind-up by the own weight, c_g T_w(q). The
/// gear is the one that nominal geometry gives, to some thousandths of the wind-up. The encoders' zero holds the mean
/// wind-up where masses are not known; the sag is not corrected for then anyway.
campaign::Campaign referredToMotors(campaign::Campaign campaign);

}  // namespace stiffscope::identification
