#pragma once

#include <string>
#include <vector>

#include "core/audit/prepare.h"
#include "core/improved/improved_model.h"

namespace CLI {
class App;
}

namespace stiffscope {

/// Adds --with EFFECT to a command: may come again, or take several names with commas between them.
void addWithOption(CLI::App& command, std::vector<std::string>& words);

/// The effects that `words` ask for, fitted to the campaign as it is used; `auto`: what `diagnose` finds in it.
/// Throws InputError for names that are unknown or do not go together, and for effects that the campaign cannot show.
EffectFit effectsAsked(const PreparedCampaign& prepared, const std::vector<std::string>& words);

}  // namespace stiffscope
