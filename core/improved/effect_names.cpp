#include "core/improved/effect_names.h"

#include <fmt/format.h>

#include <array>

namespace stiffscope {

namespace {

constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};
constexpr std::array<const char*, 6> kMotion{"turn about x", "turn about y", "turn about z",
                                             "shift along x", "shift along y", "shift along z"};
constexpr std::array<const char*, 6> kSymmetric{"xx", "yy", "zz", "xy", "xz", "yz"};

std::string entryName(const EffectModel& model, std::size_t count, std::size_t k) {
  switch (model.effect) {
    case Effect::link_compliance:
      return k == 0 ? "1/EI" : "1/GJ";
    case Effect::gravity_compensator:
      return fmt::format("{} {} q2", k % 2 == 0 ? "sin" : "cos", k / 2 + 1);
    case Effect::frame_error:
    case Effect::tracker_drift:
      return kMotion[k];
    case Effect::load_cell_misalignment:
      return fmt::format("turn about {}", kAxes[k]);
    default:
      break;
  }
  if (count == 6) return kSymmetric[k];
  return count == 3 ? kAxes[k] : "";
}

}  // namespace

std::string parameterName(const EffectModel& model, const EffectPart& part, std::size_t k) {
  const std::string entry = part.most.size() > 1 ? entryName(model, part.most.size(), k) : "";
  if (part.detail.empty()) return entry;
  if (entry.empty()) return part.detail;
  return model.effect == Effect::link_compliance ? entry + " of " + part.detail : part.detail + " " + entry;
}

std::string parameterUnit(const EffectPart& part, std::size_t k) {
  if (part.unit == "rad, m") return k < 3 ? "rad" : "m";
  return part.unit;
}

}  // namespace stiffscope
