#pragma once

#include <string>

#include "core/diagnosis/effect.h"

namespace stiffscope {

/// What an effect is a property of; that decides where its fitted size belongs.
enum class EffectNature {
  machine,      ///< how the machine gives: taken off the readings, and added to every predicted deflection
  load,         ///< where the load acts on the tool: the declared point is corrected, for planned loads too
  measurement,  ///< a fault of the day's measurement: taken off the readings; the machine does not do it
  geometry,     ///< lengths and zeros: every identification has the measured ones already, nothing is added
};

EffectNature natureOf(Effect effect);

/// Whether the effect has a part in what the machine does under a planned load.
bool entersCompensation(Effect effect);

/// What is done with the effect, and why, in words.
std::string useOf(Effect effect);

}  // namespace stiffscope
