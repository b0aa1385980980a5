#include "reports/words/effect_words.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/numerics/distributions.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

/// The words of one effect.
struct Words {
  effects::Effect effect;
  const char* meaning = nullptr;  ///< what the machine then does
  const char* remedy = nullptr;   ///< what a laboratory can do about it
  const char* use = nullptr;      ///< what `--with` does with it
};

constexpr const char* kIntoTheModel =
    "compensate with the stiffnesses identified with it in the model; without it they absorb part of it";
constexpr const char* kOfMachine = "the machine does it: taken off the readings and added to predicted deflections";
constexpr const char* kOfWrenches =
    "a fault of the measured wrenches: these are corrected; a planned load is taken as it is stated";

/// In the order of Effect.
constexpr std::array kWords{
    Words{effects::Effect::link_compliance, "a link bends and twists along its length", kIntoTheModel, kOfMachine},
    Words{effects::Effect::bearing_tilt, "a joint also gives about the two directions across its axis", kIntoTheModel,
          kOfMachine},
    Words{effects::Effect::base_compliance, "pedestal or floor gives",
          "check the anchors, with one reflector on the pedestal and one on the floor beside it under load",
          kOfMachine},
    Words{effects::Effect::rail_bending, "the rail gives more at some positions of the carriage than at others",
          "put shims or supports under the rail where it gives most, and compensate with the effect in the model",
          kOfMachine},
    Words{effects::Effect::joint_coupling, "torque at one joint turns another",
          "ask the maker how the named joints are coupled, and keep it in the model", kOfMachine},
    Words{effects::Effect::joint_hardening, "stiffness changes with torque",
          "identify at the loads of the process: one stiffness does not hold for all", kOfMachine},
    Words{effects::Effect::backlash, "motion is lost as a joint's torque passes zero",
          "keep the torque on one side of zero where it matters, and have the gear looked at", kOfMachine},
    Words{effects::Effect::hysteresis, "friction makes the way back differ from the way out",
          "load in the sense of the process, and have gear and brake looked at where it is large",
          "the machine does it: taken off the readings and added to predicted deflections, for a load that "
          "is put on once, from none"},
    Words{effects::Effect::gravity_compensator, "a spring on axis 2 has a torque that depends on the posture",
          "have the compensator's spring stated or set, and keep it in the model", kOfMachine},
    Words{effects::Effect::load_point_error, "the load acts elsewhere on the tool than declared",
          "measure where the load attaches, correct `xyz_mm` of `load_cell`, and identify again",
          "the load acts elsewhere than declared: the point is corrected, for planned loads too"},
    Words{effects::Effect::load_cell_misalignment, "the load cell is turned against its declared axes",
          "check how the cell is mounted, correct `rpy_deg` or `axes` of `load_cell`, and identify again", kOfWrenches},
    Words{effects::Effect::load_cell_bias, "a constant force is added to the loaded readings, or missing from them",
          "tare the cell with nothing hanging, account for all that hangs below it, and measure again", kOfWrenches},
    Words{effects::Effect::frame_error, "the tracker, or the robot, moved between the sweeps and the loading",
          "repeat the sweeps, or read three or more floor nests with every set of readings",
          "a fault of the measurement: the loading's readings are brought back into the sweeps' frame; no "
          "part of a deflection"},
    Words{effects::Effect::kinematic_error, "lengths or joint zeros differ from the nominal geometry",
          "calibrate the geometry before absolute positions are trusted; displacements hardly feel it",
          "every identification has the geometry of the sweeps or calibrates it: nothing is added"},
    Words{effects::Effect::tracker_drift, "readings wander with time",
          "let the tracker warm up, and read the floor nests more often",
          "a fault of the measurement: taken off the readings; no part of a deflection"},
    Words{effects::Effect::target_motion, "one reflector moves in its nest under load",
          "seat that reflector anew or leave it out, and measure again",
          "a fault of the measurement: taken off that reflector's readings; the flange does not do it"},
    Words{effects::Effect::tool_compliance, "the plate between flange and reflectors gives",
          "stiffen the plate or put the reflectors on the flange itself",
          "the machine does it: taken off the readings and added to predicted deflections, of the tool "
          "beyond the plate"},
};

consteval bool hasAllWords() {
  if (kWords.size() != effects::kEffectCount) return false;
  for (std::size_t i = 0; i < kWords.size(); ++i) {
    const Words& own = kWords[i];
    if (own.effect != static_cast<effects::Effect>(i) || !own.meaning || !own.remedy || !own.use) return false;
  }
  return true;
}
static_assert(hasAllWords(), "every effect needs a line of words, in the order of the table in core/effects/effect.h");

const Words& wordsOf(effects::Effect effect) { return kWords[static_cast<std::size_t>(effect)]; }

}  // namespace

std::string notHeldOutWords() {
  return "Fewer than four postures: none was held out, and what the effects take off other postures is not known.";
}

std::string effectName(effects::Effect effect) { return nameOfId(effects::idOf(effect)); }

std::string effectNames(const std::vector<effects::Effect>& effects, const char* between) {
  return namesJoined(effects, between);
}

std::string effectMeaning(effects::Effect effect) { return wordsOf(effect).meaning; }

std::string effectRemedy(effects::Effect effect) { return wordsOf(effect).remedy; }

std::string effectUse(effects::Effect effect) { return wordsOf(effect).use; }

std::string deviateWords(double deviate) {
  if (std::abs(deviate) < numerics::kLargestDeviate) return fmt::format("{:.1f}", unsignedZero(deviate, 1));
  return fmt::format("{} {:.1f}", deviate > 0.0 ? ">" : "<", std::copysign(numerics::kLargestDeviate, deviate));
}

std::string overlapWords(const diagnosis::WhereTable& table) {
  if (!table.overlaps) return {};
  return fmt::format(
      "Angles of several joints can explain the same: it is shared out among them. Together they explain {:.0f} % of "
      "the gap's squares.",
      100.0 * table.explained);
}

std::string namedWords(const diagnosis::Verdict& verdict) { return namedOf(verdict.entries); }

std::string presentWords(const diagnosis::Verdict& verdict) { return presentOf(verdict.entries); }

std::string reasonWords(const diagnosis::Verdict& verdict) {
  return fmt::format("{}", fmt::join(words(verdict.reasons), " "));
}

}  // namespace stiffscope::reports
