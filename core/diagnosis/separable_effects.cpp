#include "core/diagnosis/separable_effects.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace stiffscope {

namespace {

std::string joined(const std::vector<Effect>& effects, const char* between) {
  std::string text;
  for (const Effect effect : effects) text += (text.empty() ? "" : between) + std::string(idOf(effect));
  return text;
}

}  // namespace

void addSeparableEffects(const Diagnosis& diagnosis, AuditReport& report) {
  const auto check = std::find_if(report.checks.begin(), report.checks.end(),
                                  [](const AuditCheck& one) { return one.id == "posture_set"; });
  if (check == report.checks.end() || !diagnosis.usable) return;
  std::array<bool, kEffectCount> apart;
  apart.fill(true);
  std::vector<Effect> untestable;
  for (const NotTestable& one : diagnosis.not_testable) {
    apart[static_cast<std::size_t>(one.effect)] = false;
    untestable.push_back(one.effect);
  }
  for (const auto& group : diagnosis.aliases) {
    for (const Effect effect : group) apart[static_cast<std::size_t>(effect)] = false;
  }
  std::vector<Effect> told;
  for (std::size_t i = 0; i < kEffectCount; ++i) {
    if (apart[i]) told.push_back(static_cast<Effect>(i));
  }
  if (!told.empty()) check->details.push_back("effects that could be told apart: " + joined(told, ", "));
  for (const auto& group : diagnosis.aliases) {
    check->details.push_back("effects that could not always be told apart: " + joined(group, " or "));
  }
  if (!untestable.empty()) {
    check->details.push_back("effects that cannot be tested here (diagnose says what is missing): " +
                             joined(untestable, ", "));
  }
}

}  // namespace stiffscope
