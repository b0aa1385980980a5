#pragma once

#include <string>
#include <vector>

#include "metrology/remark.h"

namespace stiffscope::mistakes {

/// A mistake that would explain what the readings show.
struct Suspected {
  std::string mistake;               ///< its id: noise_declared, joint_sign
  Remark where;                      ///< instrument, file and columns, or element of campaign.xml
  Remark remedy;                     ///< the change that would mend it
  Remark shown;                      ///< the figure by which it shows, as read and with the remedy
  double before = 0.0, after = 0.0;  ///< that figure
};

}  // namespace stiffscope::mistakes
