#pragma once

#include <optional>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/mistakes/suspected.h"

namespace stiffscope::mistakes {

/// What the day says of the model as a whole, whatever is identified from it.
struct ModelAgreement {
  std::optional<double> arm_miss;     ///< median over postures and sweeps, m: readings against the URDF's arm
  bool arm_contradicted = false;      ///< no machine is that far off its drawing, or a mistake is found
  std::optional<double> loads_left;   ///< share of the displacements that springs that give way do not explain
  bool loads_contradicted = false;    ///< no machine is like that, or a mistake is found
  std::vector<Suspected> arm, loads;  ///< what would mend either; of several each mends as well as the others

  bool contradicted() const { return arm_contradicted || loads_contradicted; }
};

/// Physics that is wrong and parses: signs, orders, units, frames, rows and names. Where unloaded readings and the
/// URDF's arm, or loads and joint springs, contradict each other by far more than machines do, each of the usual
/// mistakes is taken back in memory in turn; those that bring them together are named (arm_search.h, load_search.h).
/// Cures of the arm that also leave the loads in agreement go before those that do not.
ModelAgreement findMistakes(const campaign::Campaign& campaign);

}  // namespace stiffscope::mistakes
