#include "core/diagnosis/spike_study.h"

#include <algorithm>
#include <map>
#include <mutex>

#include "core/diagnosis/gap_study.h"
#include "core/numerics/parallel.h"

namespace stiffscope::diagnosis {

namespace {

const VerdictEntry* entryWith(const Verdict& verdict, effects::Effect effect) {
  for (const VerdictEntry& entry : verdict.entries) {
    if (std::find(entry.effects.begin(), entry.effects.end(), effect) != entry.effects.end()) return &entry;
  }
  return nullptr;
}

bool saysUnknown(const Verdict& verdict) {
  return std::any_of(verdict.entries.begin(), verdict.entries.end(),
                     [](const VerdictEntry& entry) { return entry.effects.empty(); });
}

/// What one spiked day is said to have; empty where it could not be diagnosed.
using SpikeAnswer = std::optional<Verdict>;

/// Adds an answer to the counts of its size.
class SpikeScorer {
 public:
  explicit SpikeScorer(const Verdict& baseline) : baseline_(baseline) {}

  void add(const Spike& spike, const SpikeAnswer& answer) {
    if (!answer) return;
    ++counts_.draws;
    if (const VerdictEntry* entry = entryWith(*answer, spike.effect)) {
      ++counts_.named;
      counts_.class_size += static_cast<double>(entry->effects.size());
      const bool parts = std::all_of(spike.parts.begin(), spike.parts.end(), [&](const std::string& part) {
        return entry->detail.find(part) != std::string::npos;
      });
      if (parts) ++counts_.part_named;
    }
    bool other = false;
    for (const VerdictEntry& entry : answer->entries) {
      if (entry.effects.empty() || entryWith(Verdict{{entry}, {}}, spike.effect) != nullptr) continue;
      const bool known = std::any_of(entry.effects.begin(), entry.effects.end(),
                                     [&](effects::Effect effect) { return entryWith(baseline_, effect) != nullptr; });
      if (known) continue;
      other = true;
      ++others_[entry.effects.front()];
    }
    if (other) ++counts_.other_named;
    if (saysUnknown(*answer) && !saysUnknown(baseline_)) ++counts_.unknown;
  }

  SpikeCounts counts(double times, double size) const {
    SpikeCounts counts = counts_;
    counts.times = times;
    counts.size = size;
    if (counts.named > 0) counts.class_size /= counts.named;
    counts.others.assign(others_.begin(), others_.end());
    std::stable_sort(counts.others.begin(), counts.others.end(),
                     [](const auto& a, const auto& b) { return a.second > b.second; });
    return counts;
  }

 private:
  const Verdict& baseline_;
  SpikeCounts counts_;
  std::map<effects::Effect, int> others_;
};

/// One spiked day to be diagnosed.
struct SpikeTask {
  const Spike* spike = nullptr;
  double size = 0.0;
  SpikeAnswer answer;
};

SpikeAnswer verdictOf(const SpikedDay& day, const SpikeTask& task, double chance_limit) {
  DiagnoseOptions options;
  options.resamples = 0;
  options.chance_limit = chance_limit;
  options.verdict_only = true;
  try {
    const Diagnosis diagnosis = diagnose(day.with(*task.spike, task.size), options);
    if (diagnosis.usable) return diagnosis.verdict;
  } catch (const std::exception&) {  // the spiked arm does not stand: no answer
  }
  return std::nullopt;
}

std::vector<effects::Effect> wantedOf(const SpikeOptions& options, bool on_rail) {
  std::vector<effects::Effect> wanted;
  for (std::size_t e = 0; e < effects::kEffectCount; ++e) {
    const auto effect = static_cast<effects::Effect>(e);
    if (!effects::concerns(effect, on_rail)) continue;
    const auto& asked = options.effects;
    if (asked.empty() || std::find(asked.begin(), asked.end(), effect) != asked.end()) wanted.push_back(effect);
  }
  return wanted;
}

SpikedEffect described(effects::Effect effect, const Diagnosis& baseline) {
  SpikedEffect one{
      effect, std::nullopt, Remark(RemarkId::spike_hidden), entryWith(baseline.verdict, effect) != nullptr, {}};
  for (const DetectableSize& size : baseline.detectable) {
    if (size.effect == effect) one.detectable = size.size;
  }
  for (const NotTestable& missing : baseline.not_testable) {
    if (missing.effect != effect) continue;
    one.detectable.reset();
    one.reason = missing.missing;
  }
  return one;
}

/// What a diagnosis looks at of a long day.
campaign::Campaign dayOf(const campaign::Campaign& campaign) {
  return isLong(campaign) ? spreadForDiagnosis(campaign) : campaign;
}

}  // namespace

SpikeStudy spikeStudy(const campaign::Campaign& campaign, const Diagnosis& baseline, const SpikeOptions& options,
                      const std::function<void(std::size_t, std::size_t)>& progress) {
  SpikeStudy study;
  study.seed = options.seed;
  study.draws = options.draws;
  if (!baseline.usable) return study;
  const SpikedDay day(dayOf(campaign));
  if (!day.unusable().empty()) return study;
  const double largest = options.sizes.empty() ? 0.0 : *std::max_element(options.sizes.begin(), options.sizes.end());
  std::vector<std::vector<Spike>> spikes;
  for (const effects::Effect effect : wantedOf(options, campaign.robot.rail.has_value())) {
    study.effects.push_back(described(effect, baseline));
    spikes.emplace_back();
    SpikedEffect& one = study.effects.back();
    for (int draw = 0; one.detectable && draw < options.draws; ++draw) {
      numerics::RandomStream random(options.seed, std::string(effects::idOf(effect)) + " " + std::to_string(draw));
      if (auto spike = day.draw(effect, largest * *one.detectable, random)) spikes.back().push_back(std::move(*spike));
    }
    if (spikes.back().empty()) one.detectable.reset();
    if (one.detectable) one.reason = {};
  }
  std::vector<SpikeTask> tasks;
  for (std::size_t e = 0; e < spikes.size(); ++e) {
    for (const double times : options.sizes) {
      for (const Spike& spike : spikes[e]) {
        const double size = times * *study.effects[e].detectable;
        if (size <= spike.largest) tasks.push_back({&spike, size, std::nullopt});
      }
    }
  }
  std::mutex mutex;
  std::size_t done = 0;
  numerics::onAllCores(tasks.size(), [&](std::size_t i) {
    tasks[i].answer = verdictOf(day, tasks[i], baseline.significance_limit);
    const std::lock_guard lock(mutex);
    ++done;
    if (progress) progress(done, tasks.size());
  });
  auto next = tasks.begin();
  for (std::size_t e = 0; e < spikes.size(); ++e) {
    for (const double times : options.sizes) {
      if (!study.effects[e].detectable) continue;
      const double size = times * *study.effects[e].detectable;
      SpikeScorer scorer(baseline.verdict);
      for (const Spike& spike : spikes[e]) {
        if (size <= spike.largest) scorer.add(spike, (next++)->answer);
      }
      study.effects[e].sizes.push_back(scorer.counts(times, size));
    }
  }
  return study;
}

}  // namespace stiffscope::diagnosis
