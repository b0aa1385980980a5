#include "app/with_option.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "core/diagnosis/diagnose.h"
#include "core/input/input_error.h"

namespace stiffscope {

void addWithOption(CLI::App& command, std::vector<std::string>& words) {
  command
      .add_option("--with", words,
                  "effects that the model has besides joint springs, by their names in diagnose, with a part where that is "
                  "to be chosen (bearing_tilt:3, joint_coupling:2-3, target_motion:P12); auto: what diagnose finds")
      ->type_name("EFFECT")
      ->delimiter(',')
      ->allow_extra_args(false);
}

EffectFit effectsAsked(const PreparedCampaign& prepared, const std::vector<std::string>& words) {
  Campaign campaign = prepared.campaign;
  // Nests whose motion has been taken off the readings have said what they know.
  if (prepared.preparation.drift.taken_off) campaign.nests.reset();
  if (std::find(words.begin(), words.end(), "auto") == words.end())
    return fitEffects(campaign, wantedEffects(words, campaign));
  if (words.size() > 1) throw InputError({"--with"}, "auto", "expected auto alone, or effects without it");
  return fitEffects(campaign, namedBy(diagnose(campaign)));
}

}  // namespace stiffscope
