#pragma once

#include "metrology/circle_fit.h"
#include "metrology/local_points.h"

namespace stiffscope {

/// fitCircle's plane-first strategy: NIST's strategy 1.
FittedCircle fitPlaneFirst(const LocalPoints& local);

}  // namespace stiffscope
