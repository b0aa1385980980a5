#include "reports/words/unloaded_effect_words.h"

#include <algorithm>
#include <array>

#include "reports/words/entry_words.h"

namespace stiffscope::reports {

using calibration::UnloadedEffect;

namespace {

struct UnloadedWords {
  UnloadedEffect effect;
  const char* meaning = nullptr;
  const char* remedy = nullptr;
};

constexpr const char* kByOwnWeight =
    "keep it in the model that corrects the program's postures, and state what the flange carries: it changes with "
    "that";

/// In the order of UnloadedEffect.
constexpr std::array kUnloadedWords{
    UnloadedWords{UnloadedEffect::kinematic_error, "lengths, directions or joint zeros differ from the URDF",
                  "use the calibrated geometry instead of the URDF's: fitted with the other effects where these "
                  "are corrected for, too, else the geometry alone"},
    UnloadedWords{UnloadedEffect::joint_compliance, "joints twist under the weight of arm and tool", kByOwnWeight},
    UnloadedWords{UnloadedEffect::link_compliance, "a link bends and twists under its own weight", kByOwnWeight},
    UnloadedWords{UnloadedEffect::bearing_tilt, "a joint also gives about the two directions across its axis",
                  kByOwnWeight},
    UnloadedWords{UnloadedEffect::base_compliance, "pedestal or floor gives under the arm's weight",
                  "check the anchors, with one reflector on the pedestal and one on the floor beside it"},
    UnloadedWords{UnloadedEffect::gravity_compensator, "a spring on axis 2 carries a share that depends on the posture",
                  "have the compensator's spring stated or set, and keep it in the model"},
    UnloadedWords{
        UnloadedEffect::transmission_error,
        "a joint's angle is off by something periodic in that angle, as an eccentric gear or encoder ring or "
        "the teeth of a gear make it",
        "correct each named joint's commanded angle by its waves in @{What the geometry misses}, or have its gear and "
        "encoder looked at"},
    UnloadedWords{UnloadedEffect::ratio_error,
                  "a joint turns by a constant share more or less than reported, or by a share of another's motion",
                  "have gear ratio and wrist coupling of the named joints checked in the controller"},
    UnloadedWords{UnloadedEffect::backlash, "the place depends on the side from which a joint came",
                  "approach from one side where it matters, and have the gear looked at"},
    UnloadedWords{UnloadedEffect::read_back_error, "the reported angles are not those of the moment of the reading",
                  "read the angles once the arm stands still, or take the commanded ones"},
    UnloadedWords{UnloadedEffect::tracker_drift, "the tracker's station wanders with time",
                  "let the tracker warm up, and read the floor nests more often"},
    UnloadedWords{UnloadedEffect::frame_error, "tracker or robot stood elsewhere from a time on",
                  "fasten what moved, and read three or more floor nests with every set of postures"},
    UnloadedWords{UnloadedEffect::target_motion, "a reflector sits elsewhere from a time on",
                  "seat that reflector anew, and measure again the postures since then"},
    UnloadedWords{UnloadedEffect::thermal_growth, "lengths of the arm grow over the day",
                  "warm the arm up by the moves of its program before measuring, and log `temperature_c` in `states`"},
    UnloadedWords{UnloadedEffect::scale_error, "the tracker's distances are off by a factor that changes over the day",
                  "check the tracker's weather station, and measure a known length at both ends of the day"},
};

consteval bool hasAllUnloadedWords() {
  if (kUnloadedWords.size() != calibration::kUnloadedEffectIds.size()) return false;
  for (std::size_t i = 0; i < kUnloadedWords.size(); ++i) {
    const UnloadedWords& own = kUnloadedWords[i];
    if (own.effect != static_cast<UnloadedEffect>(i) || !own.meaning || !own.remedy) return false;
  }
  return true;
}
static_assert(hasAllUnloadedWords(), "every effect needs a line of words, in the order of UnloadedEffect");

}  // namespace

std::string effectName(UnloadedEffect effect) { return nameOfId(idOf(effect)); }

std::string effectNames(const std::vector<UnloadedEffect>& effects, const char* between) {
  return namesJoined(effects, between);
}

std::string effectMeaning(UnloadedEffect effect) { return kUnloadedWords[static_cast<std::size_t>(effect)].meaning; }

std::string effectRemedy(UnloadedEffect effect) { return kUnloadedWords[static_cast<std::size_t>(effect)].remedy; }

std::string namedWords(const std::vector<accuracy::AccuracyEntry>& verdict) { return namedOf(verdict); }

std::string presentWords(const std::vector<accuracy::AccuracyEntry>& verdict) { return presentOf(verdict); }

}  // namespace stiffscope::reports
