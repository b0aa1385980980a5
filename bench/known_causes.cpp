// Known causes in real readings: each effect of the vocabulary of days without a load is added to the readings of a
// campaign, and the diagnosis asked what it is. The real background stays, and so do order, times and folds.
//
// known_causes CAMPAIGN [EFFECT...] [--draws N] [--seed S] [--every K] [--folds N] [--fold-size M] [--each]
//
// A cause is as large as makes it move 2 or 5 times what the calibrated geometry leaves (rms of the 3-D position)
// beyond what a rigid calibration takes up. Joint, order, time and direction are drawn, again where an arm would have
// to be softer, longer or looser for that than any that works; where none of 200 will do, that is said. --every K:
// readings of each K-th pair of postures only; the arm's states, and so its moves, are all there. --each: a line a
// draw.
//
// named: the effect is in the verdict. first: before everything that the untouched day's verdict has not. class <= 3:
// named with at most two others. part: the joint, link or reflector too. other: something named that the untouched day
// has not, and which: with how many draws. In brackets what was found and not named.

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <iostream>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "bench/unloaded_causes.h"
#include "core/accuracy/diagnose_accuracy.h"
#include "core/campaign/read_campaign.h"
#include "core/numerics/parallel.h"
#include "core/preparation/prepare.h"

namespace {

using namespace stiffscope;
using calibration::UnloadedEffect;

struct Options {
  std::string campaign;
  std::set<std::string> effects;
  int draws = 4, every = 1;
  std::uint64_t seed = 1;
  bool each = false;
  calibration::CalibrationOptions calibration{.folds = 2, .fold_size = 2};
};

constexpr std::array kTimes{2.0, 5.0};  // what is left by the calibrated geometry
constexpr double kSeenShare = 0.05;     // of what a cause moves: less is a geometry error, whatever its name

Options optionsOf(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto next = [&] { return std::stoi(i + 1 < argc ? argv[++i] : ""); };
    if (word == "--draws") {
      options.draws = next();
    } else if (word == "--seed") {
      options.seed = static_cast<std::uint64_t>(next());
    } else if (word == "--every") {
      options.every = std::max(1, next());
    } else if (word == "--folds") {
      options.calibration.folds = next();
    } else if (word == "--fold-size") {
      options.calibration.fold_size = next();
    } else if (word == "--each") {
      options.each = true;
    } else if (options.campaign.empty()) {
      options.campaign = word;
    } else {
      options.effects.insert(word);
    }
  }
  return options;
}

/// Keeps the readings of one block of folds in `every`, at a place that changes from one to the next, so that every
/// fold and every fold within folds has its share.
void thin(campaign::Campaign& campaign, const Options& options) {
  const int block = options.calibration.folds * options.calibration.fold_size;
  std::erase_if(campaign.loading->rows, [&](const campaign::LoadingReading& reading) {
    const int place = reading.pose / block;
    return place % options.every != (place / options.every) % options.every;
  });
}

using Names = std::set<std::string>;

Names namesIn(const std::vector<accuracy::AccuracyEntry>& verdict) {
  Names names;
  for (const accuracy::AccuracyEntry& entry : verdict) {
    for (const UnloadedEffect effect : entry.effects) names.insert(std::string(idOf(effect)));
    if (entry.effects.empty()) names.insert("unknown");
  }
  return names;
}

bool holds(const std::vector<UnloadedEffect>& effects, UnloadedEffect effect) {
  return std::find(effects.begin(), effects.end(), effect) != effects.end();
}

std::set<std::pair<UnloadedEffect, std::string>> partsIn(const accuracy::AccuracyDiagnosis& diagnosis) {
  std::set<std::pair<UnloadedEffect, std::string>> parts;
  for (const accuracy::AccuracyClass& one : diagnosis.classes) {
    if (!one.in_verdict) continue;
    for (const UnloadedEffect effect : one.effects) parts.insert({effect, one.detail});
    for (const calibration::EffectPart& part : one.parts) parts.insert({part.effect, part.detail});
  }
  return parts;
}

struct Count {
  int draws = 0, named = 0, first = 0, small_class = 0, part = 0, other = 0;
  double raw_mm = 0.0;  ///< mean of what the causes move in all
  std::map<std::string, int> others;
};

class Bench {
 public:
  explicit Bench(const Options& options) : options_(options) {
    campaign_ = preparation::leaveRaw(campaign::readCampaign(options.campaign).campaign).campaign;
    thin(campaign_, options);
    untouched_ = accuracy::diagnoseAccuracy(campaign_, options.calibration);
    if (!untouched_.usable) throw std::runtime_error("the untouched day cannot be diagnosed");
    background_ = namesIn(untouched_.verdict);
    day_ = bench::nominalDay(campaign_, untouched_.calibration);
  }

  void run() {
    const calibration::Calibration& calibration = untouched_.calibration;
    const double left = calibration.geometry().fitted.rms;
    fmt::print("{}: {} postures, {} readings; geometry leaves {:.4f} mm, untouched verdict: {}\n", campaign_.name,
               calibration.day.postures.size(), calibration.day.readings(), 1e3 * left, listed(background_));
    const bench::RigidGeometry geometry(day_, readings());
    std::vector<Draw> draws = drawAll(geometry, left);
    numerics::onAllCores(draws.size(), [&](std::size_t i) { judge(draws[i]); });
    print();
  }

 private:
  struct Draw {
    bench::Cause cause;
    double times = 0.0, size = 0.0, raw = 0.0;
  };

  static std::string listed(const Names& names) {
    std::string all;
    for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
    return all.empty() ? "none" : all;
  }

  /// Those that the fullest model keeps.
  std::vector<bench::RigidGeometry::At> readings() const {
    std::vector<bench::RigidGeometry::At> all;
    const calibration::Calibration& calibration = untouched_.calibration;
    const std::vector<double>& weights = calibration.best().fit.weights;
    std::size_t k = 0;
    for (const calibration::Posture& posture : calibration.day.postures) {
      for (const calibration::Reading& reading : posture.readings) {
        if (weights[k++] > 0.0)
          all.push_back(
              {static_cast<std::size_t>(posture.pose), reading.target, day_.base_from_points * reading.point});
      }
    }
    return all;
  }

  std::vector<Draw> drawAll(const bench::RigidGeometry& geometry, double left) {
    std::vector<Draw> draws;
    for (std::size_t e = 0; e < calibration::kUnloadedEffectIds.size(); ++e) {
      const std::string id(calibration::kUnloadedEffectIds[e]);
      if (!options_.effects.empty() && options_.effects.count(id) == 0) continue;
      const auto effect = static_cast<UnloadedEffect>(e);
      for (const double times : kTimes) {
        numerics::RandomStream random(options_.seed, id);
        int got = 0, tries = 0;
        double least = 0.0;
        constexpr int kTries = 200;
        for (; got < options_.draws && tries < kTries; ++tries) {
          const auto cause = bench::drawCause(effect, day_, random);
          if (!cause) break;
          const bench::RigidGeometry::Moves moves = geometry.movesOf(*cause);
          if (!(moves.beyond > kSeenShare * moves.all)) continue;
          const double size = times * left / moves.beyond;
          if (least == 0.0 || size < least) least = size;
          if (size > bench::mostPlausible(effect)) continue;
          draws.push_back({*cause, times, size, size * moves.all});
          ++got;
        }
        if (got > 0) continue;
        if (least > 0.0) {
          fmt::print("{} x {:g}: the least of {} draws has size {:.2g}, above the {:g} that an arm may have\n", id,
                     times, tries, least, bench::mostPlausible(effect));
        } else {
          fmt::print("{}: this day has none, or none beyond the geometry\n", id);
          break;
        }
      }
    }
    return draws;
  }

  void judge(const Draw& draw) {
    const accuracy::AccuracyDiagnosis found =
        accuracy::diagnoseAccuracy(bench::withCause(campaign_, day_, draw.cause, draw.size), options_.calibration);
    const UnloadedEffect effect = draw.cause.effect;
    const std::string id(idOf(effect));
    const auto at = std::find_if(found.verdict.begin(), found.verdict.end(),
                                 [&](const accuracy::AccuracyEntry& entry) { return holds(entry.effects, effect); });
    const bool named = at != found.verdict.end();
    // What stands before it in the untouched day's verdict too is the background.
    const bool first = named && std::all_of(found.verdict.begin(), at, [&](const accuracy::AccuracyEntry& entry) {
                         return !entry.effects.empty() && background_.count(std::string(idOf(entry.effects.front())));
                       });
    // Of a cause without a part the name alone says that it was seen, where the untouched day has it not.
    const auto parts = partsIn(found), parts_before = partsIn(untouched_);
    const std::pair own{effect, draw.cause.detail};
    const bool part =
        own.second.empty() ? background_.count(id) == 0 : parts.count(own) > 0 && parts_before.count(own) == 0;
    Names others = namesIn(found.verdict);
    if (named) {
      for (const UnloadedEffect same : at->effects) others.erase(std::string(idOf(same)));
    }
    std::erase_if(others, [&](const std::string& name) { return name == id || background_.count(name) > 0; });

    const std::lock_guard<std::mutex> lock(mutex_);
    Count& count = counts_[{static_cast<std::size_t>(effect), draw.times}];
    ++count.draws;
    count.named += named, count.first += first;
    count.small_class += named && at->effects.size() <= 3;
    count.part += named && part;
    count.other += !others.empty();
    count.raw_mm += 1e3 * draw.raw;
    for (const std::string& other : others) ++count.others[other];
    if (options_.each) {
      fmt::print("  {} {} {} x {:g}: size {:.3g}, moves {:.3f} mm in all; verdict:", id, draw.cause.detail,
                 draw.cause.drawn, draw.times, draw.size, 1e3 * draw.raw);
      for (const accuracy::AccuracyEntry& entry : found.verdict) {
        fmt::print(" [");
        for (const UnloadedEffect one : entry.effects) fmt::print("{} ", idOf(one));
        fmt::print("{}]", entry.effects.empty() ? "unknown" : entry.detail);
      }
      for (const accuracy::AccuracyClass& one : found.classes) {
        if (!one.in_verdict)
          fmt::print(" ({} {}, {:.0f} um, not named)", idOf(one.effects.front()), one.detail, 1e6 * one.size);
      }
      fmt::print("\n");
      std::fflush(stdout);
    }
  }

  void print() const {
    fmt::print("{:<20}{:>6}{:>7}{:>7}{:>7}{:>11}{:>6}{:>7}{:>13}  {}\n", "effect", "times", "draws", "named", "first",
               "class <= 3", "part", "other", "moves, mm", "others named");
    Count sum;
    for (const auto& [key, count] : counts_) {
      const std::string id(calibration::kUnloadedEffectIds[key.first]);
      std::string others;
      for (const auto& [name, times] : count.others) others += fmt::format("{} {} ", name, times);
      fmt::print("{:<20}{:>6g}{:>7}{:>7}{:>7}{:>11}{:>6}{:>7}{:>13.3f}  {}\n",
                 id + (background_.count(id) > 0 ? " *" : ""), key.second, count.draws, count.named, count.first,
                 count.small_class, count.part, count.other, count.raw_mm / count.draws, others);
      sum.draws += count.draws, sum.named += count.named, sum.first += count.first;
      sum.small_class += count.small_class, sum.part += count.part, sum.other += count.other;
    }
    fmt::print("{:<26}{:>7}{:>7}{:>7}{:>11}{:>6}{:>7}\n", "all", sum.draws, sum.named, sum.first, sum.small_class,
               sum.part, sum.other);
    fmt::print("* in the untouched day's verdict already: only `part` says that the added one was seen\n");
  }

  const Options& options_;
  campaign::Campaign campaign_;
  accuracy::AccuracyDiagnosis untouched_;
  Names background_;
  bench::NominalDay day_;
  std::mutex mutex_;
  std::map<std::pair<std::size_t, double>, Count> counts_;
};

}  // namespace

int main(int argc, char** argv) {
  try {
    const Options options = optionsOf(argc, argv);
    if (options.campaign.empty()) {
      std::cerr << "known_causes CAMPAIGN [EFFECT...] [--draws N] [--seed S] [--every K] [--folds N] [--fold-size M] "
                   "[--each]\n";
      return 2;
    }
    Bench(options).run();
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
