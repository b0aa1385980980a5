#include "core/extended_model/requested_effects.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <set>

#include "core/effects/all.h"
#include "core/io/input_error.h"

namespace stiffscope::extended_model {

namespace {

effects::Effect effectNamed(const std::string& id, const std::string& word) {
  if (const auto effect = effects::effectOf(id)) return *effect;
  std::vector<std::string> known{"auto"};
  for (const auto one : effects::kEffectIds) known.emplace_back(one);
  throw io::InputError(kWithOption, word,
                       fmt::format("expected auto or effects of: {}{}", fmt::join(effects::kEffectIds, ", "),
                                   io::nearestNameHint(id, known)));
}

std::vector<std::string> partsOf(effects::Effect effect, const campaign::Campaign& campaign) {
  std::vector<std::string> names;
  for (const effects::EffectModel& model : effects::effectModelsOf(campaign)) {
    if (model.effect != effect) continue;
    for (const effects::EffectPart& part : model.parts) {
      if (!part.detail.empty() && std::find(names.begin(), names.end(), part.detail) == names.end())
        names.push_back(part.detail);
    }
  }
  return names;
}

/// "3" is joint 3 or link 3, "2-3" the pair.
std::string partNamed(effects::Effect effect, const std::string& detail, const std::string& word,
                      const campaign::Campaign& campaign) {
  const std::vector<std::string> names = partsOf(effect, campaign);
  std::vector<std::string> meant{detail, "joint " + detail, "link " + detail};
  if (const std::size_t dash = detail.find('-'); dash != std::string::npos) {
    const std::string a = detail.substr(0, dash), b = detail.substr(dash + 1);
    meant.push_back(fmt::format("joints {} and {}", a, b));
    meant.push_back(fmt::format("joints {} and {}", b, a));
  }
  for (const std::string& one : meant) {
    if (std::find(names.begin(), names.end(), one) != names.end()) return one;
  }
  throw io::InputError(kWithOption, word,
                       names.empty() ? fmt::format("{} has no parts to name", effects::idOf(effect))
                                     : fmt::format("expected one of its parts: {}", fmt::join(names, ", ")));
}

RequestedEffect& entryOf(std::vector<RequestedEffect>& wanted, effects::Effect effect) {
  const auto found =
      std::find_if(wanted.begin(), wanted.end(), [&](const RequestedEffect& one) { return one.effect == effect; });
  return found != wanted.end() ? *found : wanted.emplace_back(RequestedEffect{effect, {}});
}

/// "joint 2, joint 3 or joint 4": the parts chosen, without those that would have done as well.
std::vector<std::string> partsIn(const std::string& detail) {
  std::vector<std::string> parts;
  const std::string chosen = detail.substr(0, detail.find(" or "));
  for (std::size_t from = 0; from < chosen.size();) {
    const std::size_t to = std::min(chosen.find(", ", from), chosen.size());
    parts.push_back(chosen.substr(from, to - from));
    from = to + 2;
  }
  return parts;
}

}  // namespace

RequestedEffects requestedEffects(const std::vector<std::string>& words, const campaign::Campaign& campaign) {
  RequestedEffects wanted;
  for (const std::string& word : words) {
    const std::size_t colon = word.find(':');
    const effects::Effect effect = effectNamed(word.substr(0, colon), word);
    RequestedEffect& entry = entryOf(wanted.effects, effect);
    if (colon != std::string::npos) entry.parts.push_back(partNamed(effect, word.substr(colon + 1), word, campaign));
  }
  return wanted;
}

RequestedEffects namedBy(const diagnosis::Diagnosis& diagnosis) {
  RequestedEffects wanted;
  if (!diagnosis.usable) {
    wanted.notes.emplace_back(RemarkId::diagnosis_has_no_gap, diagnosis.unusable_reason);
    return wanted;
  }
  if (diagnosis.verdict.entries.empty()) wanted.notes.emplace_back(RemarkId::diagnosis_names_none);
  for (const diagnosis::VerdictEntry& entry : diagnosis.verdict.entries) {
    if (entry.effects.empty()) {
      wanted.notes.emplace_back(RemarkId::diagnosis_finds_unknown);
      continue;
    }
    const effects::Effect effect = entry.effects.front();
    RequestedEffect& one = entryOf(wanted.effects, effect);
    const std::vector<std::string> parts = partsIn(entry.detail);
    one.parts.insert(one.parts.end(), parts.begin(), parts.end());
    std::vector<std::string> others;
    for (const effects::Effect other : entry.effects) {
      if (other != effect) others.emplace_back(effects::idOf(other));
    }
    if (!others.empty())
      wanted.notes.emplace_back(RemarkId::taken_of_a_class, std::string(effects::idOf(effect)), others);
  }
  if (wanted.effects.empty() && !diagnosis.verdict.entries.empty()) {
    wanted.notes = {Remark(RemarkId::diagnosis_finds_only_unknown)};
  }
  return wanted;
}

RequestedEffects chosenBy(const diagnosis::GapStudy& study) {
  RequestedEffects wanted;
  for (const diagnosis::ChosenModel& one : study.fit.set.models) {
    if (std::find(study.given.begin(), study.given.end(), one.model) != study.given.end()) continue;
    const effects::EffectModel& model = study.input->models[one.model];
    RequestedEffect effect{model.effect, {}, model.shape};
    for (const std::size_t part : one.parts) {
      if (!model.parts[part].detail.empty()) effect.parts.push_back(model.parts[part].detail);
    }
    wanted.effects.push_back(std::move(effect));
  }
  return wanted;
}

}  // namespace stiffscope::extended_model
