#pragma once

#include <array>
#include <span>

#include "core/identification/identification.h"

namespace stiffscope::identification {

/// The method shown first of one campaign, or of several that are compared: of the `usable` ones (by Method) the one
/// that compensates the largest share of the deflection at the reflectors on postures held out, mean over the subsets,
/// and over the campaigns. Where a usable method was not judged there, at P_wrist; where not there either, the first in
/// the order of equals.
///
/// A method is as good as the best where the mean of their paired difference over the subsets is no larger than its
/// standard deviation; of several campaigns the deviations are independent. Of those that are as good, the first in the
/// order of equals (DPP, PP, CP) is shown. Empty where none is usable.
std::optional<ShownFirst> methodShownFirst(std::span<const Identification* const> campaigns,
                                           const std::array<bool, 3>& usable);

/// Of one campaign, among its available methods; `papers_choice`: see IdentifyOptions.
std::optional<ShownFirst> methodShownFirst(const Identification& result, bool papers_choice = false);

}  // namespace stiffscope::identification
