#pragma once

#include <string>

#include "metrology/remark.h"

namespace stiffscope::audit {

/// A mistake that would explain what the checks found.
struct Suspected {
  std::string mistake;  ///< its id: noise_declared
  Remark where;
  Remark remedy;
  double before = 0.0;  ///< what the mistake shows in, a ratio that is one without it: as read
  double after = 0.0;   ///< the same with the remedy
};

}  // namespace stiffscope::audit
