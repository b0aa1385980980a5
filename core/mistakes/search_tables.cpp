#include <algorithm>
#include <cmath>

#include "core/mistakes/searched_arm.h"
#include "core/numerics/parallel.h"

namespace stiffscope::mistakes {

namespace {

/// One mistake or two, and the tables they are in.
struct Trial {
  const ArmMistake* mistake = nullptr;
  const ArmMistake* second = nullptr;
  Tables tables, second_tables;
  double rms = 0.0;
  int things() const { return mistake->things + (second != nullptr ? second->things : 0); }
};

bool canBeIn(const SearchedArm& arm, const ArmMistake& mistake, const Tables& tables) {
  return tables.size() == arm.tables.size() ? mistake.of_all_tables || arm.tables.size() == 1 : mistake.of_some_tables;
}

ReadingsOfDay dayOf(const SearchedArm& arm, const Trial& trial) {
  ReadingsOfDay day = arm.with(arm.day, *trial.mistake, trial.tables);
  return trial.second == nullptr ? day : arm.with(day, *trial.second, trial.second_tables);
}

void screen(const SearchedArm& arm, std::vector<Trial>& trials) {
  numerics::onAllCores(trials.size(), [&](std::size_t i) { trials[i].rms = affineMisfit(dayOf(arm, trials[i])); });
}

/// Those whose affine misfit leaves it open that they mend, fitted in full. Of shifted rows the one at the end has no
/// right angles anywhere: they are judged without the worst group, which the affine misfit cannot leave out.
void fitAll(const SearchedArm& arm, std::vector<Trial>& trials) {
  screen(arm, trials);
  const auto shifts = [](const Trial& trial) { return trial.mistake->row != AnglesRow::own; };
  std::erase_if(trials, [&](const Trial& trial) {
    return !shifts(trial) && !arm.mends(trial.rms / 3.0);  // no sag in it: thrice as lax
  });
  numerics::onAllCores(trials.size(), [&](std::size_t i) {
    const NominalFit fit = fitNominal(dayOf(arm, trials[i]));
    trials[i].rms = shifts(trials[i]) ? fit.rmsButForWorst() : fit.rms;
  });
  std::erase_if(trials, [&](const Trial& trial) { return !arm.mends(trial.rms); });
}

void keep(SearchedArm& arm, std::vector<Trial> trials) {
  if (trials.empty()) return;
  double best = INFINITY;
  for (const Trial& trial : trials) best = std::min(best, trial.rms);
  std::erase_if(trials, [&](const Trial& trial) { return trial.rms > kArmAsWell * best; });
  std::stable_sort(trials.begin(), trials.end(), [](const Trial& a, const Trial& b) {
    return std::pair(a.things(), -static_cast<int>(a.tables.size())) <
           std::pair(b.things(), -static_cast<int>(b.tables.size()));
  });
  constexpr std::size_t kMost = 12;
  if (trials.size() > kMost) trials.resize(kMost);
  for (Trial& trial : trials) {
    ArmCure cure;
    cure.things = trial.things();
    cure.rms = trial.rms;
    const auto one = [&](const ArmMistake& mistake, const Tables& tables) {
      return mistake.remedy(tables.size() == arm.tables.size());
    };
    cure.suspected.mistake = trial.mistake->id;
    cure.suspected.where = arm.whereOf(*trial.mistake, trial.tables);
    cure.suspected.remedy = one(*trial.mistake, trial.tables);
    if (trial.second != nullptr) {
      cure.suspected.remedy =
          Remark(RemarkId::both, std::vector<Remark>{cure.suspected.remedy, one(*trial.second, trial.second_tables),
                                                     arm.whereOf(*trial.second, trial.second_tables)});
    }
    cure.day = dayOf(arm, trial);
    arm.add(std::move(cure));
  }
}

}  // namespace

void searchTables(SearchedArm& arm) {
  std::vector<Trial> trials;
  for (const Tables& tables : arm.sets) {
    for (const ArmMistake& mistake : arm.mistakes) {
      if (canBeIn(arm, mistake, tables)) trials.push_back({&mistake, nullptr, tables, {}});
    }
  }
  fitAll(arm, trials);
  keep(arm, std::move(trials));
}

void searchPairs(SearchedArm& arm) {
  // The second is sought about those firsts that come nearest, and in the same tables or in all.
  constexpr std::size_t kFirsts = 12;
  std::vector<Trial> firsts;
  for (const Tables& tables : arm.sets) {
    for (const ArmMistake& mistake : arm.mistakes) {
      if (!canBeIn(arm, mistake, tables) || mistake.things > 2) continue;
      firsts.push_back({&mistake, nullptr, tables, {}});
    }
  }
  screen(arm, firsts);
  std::stable_sort(firsts.begin(), firsts.end(), [](const Trial& a, const Trial& b) { return a.rms < b.rms; });
  if (firsts.size() > kFirsts) firsts.resize(kFirsts);
  std::vector<Trial> trials;
  for (const Trial& first : firsts) {
    for (const Tables& tables : arm.sets) {
      if (tables != first.tables && tables.size() != arm.tables.size()) continue;
      for (const ArmMistake& mistake : arm.mistakes) {
        if (!canBeIn(arm, mistake, tables) || &mistake == first.mistake || mistake.things > 3) continue;
        trials.push_back({first.mistake, &mistake, first.tables, tables});
      }
    }
  }
  fitAll(arm, trials);
  keep(arm, std::move(trials));
}

}  // namespace stiffscope::mistakes
