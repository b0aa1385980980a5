#include "core/validation/score.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

namespace stiffscope::validation {

namespace {

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

const Answer::Entry* entryWith(const Answer& answer, const std::string& effect) {
  for (const Answer::Entry& entry : answer.entries) {
    if (has(entry.effects, effect)) return &entry;
  }
  return nullptr;
}

bool saysUnknown(const Answer& answer) {
  return std::any_of(answer.entries.begin(), answer.entries.end(),
                     [](const Answer::Entry& entry) { return entry.effects.empty(); });
}

/// Whether one of the true effects is a member of the entry.
bool namesTrue(const Label& label, const Answer::Entry& entry) {
  return std::any_of(label.effects.begin(), label.effects.end(),
                     [&](const LabelledEffect& e) { return has(entry.effects, e.id); });
}

/// Whether the entry is of what the mechanism of a true effect brings along.
bool namesBrought(const Vocabulary& vocabulary, const Label& label, const Answer::Entry& entry) {
  return std::any_of(label.effects.begin(), label.effects.end(), [&](const LabelledEffect& e) {
    const auto along = vocabulary.brings.find(e.id);
    return along != vocabulary.brings.end() &&
           std::any_of(along->second.begin(), along->second.end(),
                       [&](const std::string& id) { return has(entry.effects, id); });
  });
}

/// The answer without the entries that are of what a true effect brings along, where they name no true one themselves.
Answer withoutBrought(const Vocabulary& vocabulary, const Label& label, Answer answer) {
  std::erase_if(answer.entries, [&](const Answer::Entry& entry) {
    return !namesTrue(label, entry) && namesBrought(vocabulary, label, entry);
  });
  return answer;
}

/// Whether the entry names effects none of which is there.
bool namesWrong(const Label& label, const Answer::Entry& entry) {
  return !entry.effects.empty() && !namesTrue(label, entry);
}

bool namesWrong(const Label& label, const Answer& answer) {
  return std::any_of(answer.entries.begin(), answer.entries.end(),
                     [&](const Answer::Entry& entry) { return namesWrong(label, entry); });
}

/// The true effect's own column where it was found, else the first thing that was said.
std::string columnOf(const Label& label, const Answer& answer) {
  if (!answer.failure.empty()) return "failed";
  if (answer.entries.empty()) return "none";
  if (answer.entries.size() > 1) return "several";
  const Answer::Entry& only = answer.entries.front();
  if (only.effects.empty()) return "unknown";
  if (label.kind == CaseKind::single && has(only.effects, label.effects.front().id)) return label.effects.front().id;
  return only.effects.front();
}

ScoredCase scoreCase(const Label& label, const Answer& given, const Vocabulary& vocabulary) {
  const Answer answer = withoutBrought(vocabulary, label, given);
  ScoredCase one{label, given, false, false, false, 0, columnOf(label, answer), {}};
  if (!answer.failure.empty()) return one;
  switch (label.kind) {
    case CaseKind::none:
      one.found = answer.entries.empty();
      break;
    case CaseKind::outside:
      one.found = saysUnknown(answer) && !namesWrong(label, answer);
      break;
    case CaseKind::single:
    case CaseKind::pair:
      one.found = std::all_of(label.effects.begin(), label.effects.end(),
                              [&](const LabelledEffect& e) { return entryWith(answer, e.id) != nullptr; });
      break;
    case CaseKind::as_is:
      one.found = std::any_of(label.effects.begin(), label.effects.end(),
                              [&](const LabelledEffect& e) { return entryWith(answer, e.id) != nullptr; });
      one.right = one.found && !namesWrong(label, answer);
      return one;
  }
  const std::size_t expected = label.kind == CaseKind::none   ? 0
                               : label.kind == CaseKind::pair ? label.effects.size()
                                                              : 1;
  // Two true effects may stand in one class that cannot tell them apart: the other entry is then of neither.
  const bool unknown = saysUnknown(answer) && label.kind != CaseKind::outside;
  one.right = one.found && answer.entries.size() <= expected && !unknown && !namesWrong(label, answer);
  if (one.found && !label.effects.empty() && label.kind != CaseKind::outside) {
    one.class_size = static_cast<int>(entryWith(answer, label.effects.front().id)->effects.size());
  }
  constexpr std::size_t kMostInClass = 3;
  if (!label.effects.empty() && !answer.entries.empty()) {
    const auto& said = answer.entries.front().effects;
    one.first = said.size() <= kMostInClass && has(said, label.effects.front().id);
  }
  return one;
}

using Choose = std::function<bool(const ScoredCase&)>;

numerics::Rate rateOf(const std::vector<ScoredCase>& cases, const Choose& counts, const Choose& hits) {
  int trials = 0, good = 0;
  for (const ScoredCase& one : cases) {
    if (!counts(one)) continue;
    ++trials;
    if (hits(one)) ++good;
  }
  return numerics::binomialRate(good, trials);
}

bool right(const ScoredCase& one) { return one.right; }
double sizeOf(const ScoredCase& one) { return one.label.effects.empty() ? 0.0 : one.label.effects.front().size; }

Choose kind(CaseKind wanted, double least = 0.0) {
  return [=](const ScoredCase& one) { return one.label.kind == wanted && sizeOf(one) >= least; };
}

bool noiseDeclaredRight(const ScoredCase& one) { return one.label.noise_factor == 1.0; }

/// The joint, pair or reflector, named as it is.
bool namesDetail(const ScoredCase& one) {
  const LabelledEffect& truth = one.label.effects.front();
  const Answer::Entry* entry = entryWith(one.answer, truth.id);
  return entry != nullptr && entry->detail.find(truth.detail) != std::string::npos;
}

/// Of all effects that machines as they are have in this size or more, or of those with this id.
numerics::Rate effectsNamed(const std::vector<ScoredCase>& cases, double least, const std::string& id = {}) {
  int trials = 0, named = 0;
  for (const ScoredCase& one : cases) {
    if (one.label.kind != CaseKind::as_is) continue;
    for (const LabelledEffect& effect : one.label.effects) {
      if (effect.size < least || (!id.empty() && effect.id != id)) continue;
      ++trials;
      if (entryWith(one.answer, effect.id) != nullptr) ++named;
    }
  }
  return numerics::binomialRate(named, trials);
}

std::vector<NamedRate> allRates(const std::vector<ScoredCase>& cases, const Vocabulary& vocabulary) {
  const auto clean = [](bool declared_right) {
    return Choose([=](const ScoredCase& one) {
      return one.label.kind == CaseKind::none && noiseDeclaredRight(one) == declared_right;
    });
  };
  const Choose alarm = [](const ScoredCase& one) { return !one.answer.entries.empty(); };
  const Choose says_unknown = [](const ScoredCase& one) { return saysUnknown(one.answer); };
  const Choose wrong_name = [](const ScoredCase& one) { return namesWrong(one.label, one.answer); };
  const Choose unknown_beside = [](const ScoredCase& one) {
    return saysUnknown(one.answer) && namesWrong(one.label, one.answer);
  };
  const Choose none = [](const ScoredCase& one) { return one.answer.entries.empty(); };
  const Choose found = [](const ScoredCase& one) { return one.found; };
  const Choose one_found = [](const ScoredCase& one) {
    return std::any_of(one.label.effects.begin(), one.label.effects.end(),
                       [&](const LabelledEffect& e) { return entryWith(one.answer, e.id) != nullptr; });
  };
  const Choose named = [&](const ScoredCase& one) {
    return one.label.kind == CaseKind::single && one.right && has(vocabulary.placed, one.label.effects.front().id);
  };
  const Choose first = [](const ScoredCase& one) { return one.first; };
  const Choose apart = [](const ScoredCase& one) {
    return one.label.kind == CaseKind::outside && one.distance.value_or(0.0) >= kApart;
  };
  const Choose everything = [](const ScoredCase&) { return true; };
  const Choose failed = [](const ScoredCase& one) { return !one.answer.failure.empty(); };
  return {
      {"singles", Remark(RemarkId::singles_right), rateOf(cases, kind(CaseKind::single), right)},
      {"singles_first_from_2", Remark(RemarkId::singles_from_2_first),
       rateOf(cases, kind(CaseKind::single, 2.0), first)},
      {"singles_first_from_5", Remark(RemarkId::singles_from_5_first),
       rateOf(cases, kind(CaseKind::single, 5.0), first)},
      {"singles_from_2", Remark(RemarkId::singles_from_2_alone), rateOf(cases, kind(CaseKind::single, 2.0), right)},
      {"singles_from_5", Remark(RemarkId::singles_from_5_alone), rateOf(cases, kind(CaseKind::single, 5.0), right)},
      {"singles_found_from_2", Remark(RemarkId::singles_from_2_found),
       rateOf(cases, kind(CaseKind::single, 2.0), found)},
      {"false_alarms", Remark(RemarkId::clean_alarmed), rateOf(cases, kind(CaseKind::none), alarm)},
      {"false_alarms_noise_right", Remark(RemarkId::clean_alarmed_noise_right), rateOf(cases, clean(true), alarm)},
      {"false_alarms_noise_wrong", Remark(RemarkId::clean_alarmed_noise_wrong), rateOf(cases, clean(false), alarm)},
      {"unknown", Remark(RemarkId::outside_unknown), rateOf(cases, kind(CaseKind::outside), found)},
      {"unknown_from_2", Remark(RemarkId::outside_from_2_unknown), rateOf(cases, kind(CaseKind::outside, 2.0), found)},
      {"unknown_apart", Remark(RemarkId::outside_apart_unknown), rateOf(cases, apart, found)},
      {"outside_none_from_2", Remark(RemarkId::outside_from_2_none), rateOf(cases, kind(CaseKind::outside, 2.0), none)},
      {"outside_wrong_name", Remark(RemarkId::outside_wrongly_named),
       rateOf(cases, kind(CaseKind::outside), wrong_name)},
      {"outside_unknown_beside", Remark(RemarkId::outside_unknown_beside_a_name),
       rateOf(cases, kind(CaseKind::outside), unknown_beside)},
      {"doubles", Remark(RemarkId::doubles_right), rateOf(cases, kind(CaseKind::pair), right)},
      {"doubles_both_found", Remark(RemarkId::doubles_found), rateOf(cases, kind(CaseKind::pair), found)},
      {"doubles_one_found", Remark(RemarkId::doubles_one_found), rateOf(cases, kind(CaseKind::pair), one_found)},
      {"as_is", Remark(RemarkId::as_is_right), rateOf(cases, kind(CaseKind::as_is), right)},
      {"as_is_wrong_name", Remark(RemarkId::as_is_wrongly_named), rateOf(cases, kind(CaseKind::as_is), wrong_name)},
      {"as_is_unknown", Remark(RemarkId::as_is_unknown), rateOf(cases, kind(CaseKind::as_is), says_unknown)},
      {"as_is_none", Remark(RemarkId::as_is_none), rateOf(cases, kind(CaseKind::as_is), none)},
      {"as_is_effects", Remark(RemarkId::as_is_effects_found), effectsNamed(cases, 0.0)},
      {"as_is_effects_from_2", Remark(RemarkId::as_is_effects_from_2_found), effectsNamed(cases, 2.0)},
      {"detail", Remark(RemarkId::details_right), rateOf(cases, named, namesDetail)},
      {"failed", Remark(RemarkId::cases_failed), rateOf(cases, everything, failed)}};
}

EffectScore effectScore(const std::vector<ScoredCase>& cases, const std::string& id, CaseKind wanted) {
  const auto of = [&](double least) {
    return Choose([=](const ScoredCase& one) {
      return one.label.kind == wanted && one.label.effects.front().id == id && sizeOf(one) >= least;
    });
  };
  EffectScore effect{id, rateOf(cases, of(0.0), right), rateOf(cases, of(2.0), right), rateOf(cases, of(5.0), right), 0,
                     0.0};
  int found = 0;
  for (const ScoredCase& one : cases) {
    if (!of(0.0)(one)) continue;
    effect.answered_none += one.answer.failure.empty() && one.answer.entries.empty() ? 1 : 0;
    found += one.class_size > 0 ? 1 : 0;
    effect.mean_class_size += one.class_size;
  }
  if (found > 0) effect.mean_class_size /= found;
  return effect;
}

/// How often each effect of a machine as it is was named, and in a class of how many.
std::vector<EffectScore> asIsScores(const std::vector<ScoredCase>& cases, const Vocabulary& vocabulary) {
  std::vector<EffectScore> scores;
  for (const std::string& id : vocabulary.effects) {
    EffectScore effect{id, effectsNamed(cases, 0.0, id), effectsNamed(cases, 2.0, id), effectsNamed(cases, 5.0, id), 0,
                       0.0};
    if (effect.all.trials == 0) continue;
    for (const ScoredCase& one : cases) {
      const auto& there = one.label.effects;
      if (one.label.kind != CaseKind::as_is ||
          std::none_of(there.begin(), there.end(), [&](const LabelledEffect& e) { return e.id == id; }))
        continue;
      effect.answered_none += one.answer.failure.empty() && one.answer.entries.empty() ? 1 : 0;
      if (const Answer::Entry* entry = entryWith(one.answer, id))
        effect.mean_class_size += static_cast<double>(entry->effects.size());
    }
    if (effect.all.hits > 0) effect.mean_class_size /= effect.all.hits;
    scores.push_back(effect);
  }
  return scores;
}

Confusion confusionOf(const std::vector<ScoredCase>& cases, const Vocabulary& vocabulary) {
  Confusion table;
  table.truths.emplace_back("none");
  table.truths.insert(table.truths.end(), vocabulary.effects.begin(), vocabulary.effects.end());
  table.answers = table.truths;
  table.truths.emplace_back("outside");
  for (const char* other : {"unknown", "several", "failed"}) table.answers.emplace_back(other);
  table.counts.assign(table.truths.size(), std::vector<int>(table.answers.size(), 0));
  for (const ScoredCase& one : cases) {
    if (one.label.kind == CaseKind::pair || one.label.kind == CaseKind::as_is) continue;
    const std::string truth = one.label.kind == CaseKind::none      ? "none"
                              : one.label.kind == CaseKind::outside ? "outside"
                                                                    : one.label.effects.front().id;
    const auto row = std::find(table.truths.begin(), table.truths.end(), truth) - table.truths.begin();
    const auto column = std::find(table.answers.begin(), table.answers.end(), one.column) - table.answers.begin();
    ++table.counts.at(static_cast<std::size_t>(row)).at(static_cast<std::size_t>(column));
  }
  return table;
}

std::vector<ShrinkPair> shrinksOf(const std::vector<ScoredCase>& cases, const Vocabulary& vocabulary) {
  std::vector<ShrinkPair> pairs;
  for (const ScoredCase& one : cases) {
    if (one.label.kind != CaseKind::single || !one.right) continue;
    const LabelledEffect& truth = one.label.effects.front();
    if (truth.shows != vocabulary.shrinks) continue;
    for (const Answer::Promise& promise : one.answer.promises) {
      if (!has(promise.effects, truth.id)) continue;
      pairs.push_back({one.label.name, truth.id, promise.value, promise.low, promise.high, one.label.shrink,
                       one.label.shrink_seen});
      break;
    }
  }
  return pairs;
}

/// Of positions without noise nothing is left beside the right effect: only the shrink that can be seen is held against
/// what was promised.
NamedRate shrinkCoverage(const std::vector<ShrinkPair>& pairs) {
  int covered = 0;
  for (const ShrinkPair& one : pairs) covered += one.low <= one.truth_seen && one.truth_seen <= one.high ? 1 : 0;
  return {"shrink_covered", Remark(RemarkId::shrinks_seen_covered),
          numerics::binomialRate(covered, static_cast<int>(pairs.size()))};
}

}  // namespace

const numerics::Rate& Score::rate(const std::string& id) const {
  for (const NamedRate& one : rates) {
    if (one.id == id) return one.rate;
  }
  throw std::out_of_range("no rate is called '" + id + "'");
}

Score score(const std::vector<Label>& labels, const std::vector<Answer>& answers,
            const std::map<std::string, double>& distances, const Vocabulary& vocabulary) {
  std::map<std::string, const Answer*> given;
  for (const Answer& answer : answers) given[answer.name] = &answer;
  Score result;
  for (const Label& label : labels) {
    const auto answer = given.find(label.name);
    if (answer == given.end()) throw std::invalid_argument("case " + label.name + " has no answer");
    result.cases.push_back(scoreCase(label, *answer->second, vocabulary));
    const auto distance = distances.find(label.name);
    if (distance != distances.end()) result.cases.back().distance = distance->second;
  }
  result.rates = allRates(result.cases, vocabulary);
  for (const std::string& id : vocabulary.effects) {
    result.effects.push_back(effectScore(result.cases, id, CaseKind::single));
  }
  for (const std::string& id : vocabulary.outside) {
    result.outside.push_back(effectScore(result.cases, id, CaseKind::outside));
  }
  result.as_is = asIsScores(result.cases, vocabulary);
  result.by_size = {{0.0, 1.0}, {1.0, 2.0}, {2.0, 5.0}, {5.0}};
  for (SizeClass& sizes : result.by_size) {
    const Choose in = [&sizes](const ScoredCase& one) {
      return one.label.kind == CaseKind::single && sizeOf(one) >= sizes.least && sizeOf(one) < sizes.below;
    };
    sizes.rate = rateOf(result.cases, in, right);
  }
  result.shrinks = shrinksOf(result.cases, vocabulary);
  result.rates.push_back(shrinkCoverage(result.shrinks));
  result.confusion = confusionOf(result.cases, vocabulary);
  return result;
}

}  // namespace stiffscope::validation
