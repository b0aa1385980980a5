#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>
#include "core/campaign/row_names.h"
#include "core/comparison/compare.h"
#include "core/extended_model/extend_model.h"
#include "core/preparation/prepare.h"
#include "core/simulation/measure.h"
#include "reports/words/remark_words.h"
#include "tests/core/comparison/simulated_pairs.h"

// Coverage and power of the difference of compliances over simulated pairs. STIFFSCOPE_COMPARE_PAIRS=100 in the
// environment simulates as many pairs of each kind instead of the few here, prints the tables and asks for 93 to 98 %.
// STIFFSCOPE_COMPARE_FIRST names the machines.

namespace stiffscope {
namespace comparison_coverage_test {

using simulated_pairs::Hidden;
using ByJoint = std::array<std::array<std::vector<double>, 6>, 3>;

int numberFrom(const char* variable, int otherwise) {
  const char* asked = std::getenv(variable);
  return asked != nullptr ? std::atoi(asked) : otherwise;
}

constexpr int kFewPairs = 6, kManyPairs = 60;
int pairsAsked() { return numberFrom("STIFFSCOPE_COMPARE_PAIRS", kFewPairs); }
std::uint64_t firstSeed() { return static_cast<std::uint64_t>(numberFrom("STIFFSCOPE_COMPARE_FIRST", 1)); }

struct Day {
  campaign::Campaign campaign;
  identification::Identification identification;
};

/// As `compare` sees a day, but for the subsets, which it does not use.
Day measured(const simulation::SimulationSpec& spec) {
  identification::IdentifyOptions options;
  options.subsets.most_all = 1;
  options.subsets.sample = 1;
  Day day;
  day.campaign = preparation::prepareCampaign(simulation::simulate(spec)).campaign;
  day.identification = identification::identify(day.campaign, options);
  return day;
}

comparison::Comparison compared(const Day& before, const Day& after) {
  comparison::BootstrapOptions bootstrap;
  bootstrap.samples = 1;
  return comparison::compareCampaigns(before.campaign, before.identification, after.campaign, after.identification, {},
                                      bootstrap);
}

double median(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? std::nan("") : sum / static_cast<double>(values.size());
}

void printTable(const std::string& title, const ByJoint& values, double times, const auto& summary) {
  fmt::print("{}\n", title);
  for (std::size_t m = 0; m < 3; ++m) {
    fmt::print("  {:<4}", std::array{"cp", "pp", "dpp"}[m]);
    std::vector<double> all;
    for (std::size_t j = 0; j < 6; ++j) {
      const std::vector<double>& own = values[m][j];
      all.insert(all.end(), own.begin(), own.end());
      fmt::print("{:>9.2f} ({:>3})", times * summary(own), own.size());
    }
    fmt::print("   all{:>9.2f}\n", times * summary(all));
  }
}

struct Coverage {
  ByJoint held, width, error;      // of the difference; U and the error as shares of the true compliance before
  ByJoint taken_held, ratio_held;  // of the share taken; of the ratio where it is stated
  std::vector<double> ratio_stated, above_noise;
  int refused = 0;
};

/// Which postures the two days measure.
enum class Postures { same, three_in_four, others };

void choosePostures(Postures which, simulation::SimulationSpec& before, simulation::SimulationSpec& after) {
  if (which == Postures::same) return;
  std::vector<simulation::ListedPosture> first, second;
  for (std::size_t p = 0; p < before.postures.size(); ++p) {
    // A posture keeps its id only if no other one before it is left out: those left out of one day alone are last.
    const bool in_first = which == Postures::three_in_four || p % 2 == 0;
    const bool in_second = which == Postures::three_in_four ? p < 18 : p % 2 == 1;
    if (in_first) first.push_back(before.postures[p]);
    if (in_second) second.push_back(after.postures[p]);
  }
  before.postures = first, after.postures = second;
}

void judge(const simulation::SimulationSpec& first, const simulation::SimulationSpec& second, Hidden hidden,
           const comparison::Comparison& comparison, Coverage& found) {
  const bool stated = comparison.residual.isNoise();
  found.ratio_stated.push_back(stated);
  found.above_noise.push_back(comparison.residual.differenceAboveNoise());
  for (std::size_t m = 0; m < 3; ++m) {
    for (std::size_t j = 0; j < 6; ++j) {
      const comparison::JointChange& joint = comparison.methods[m].joints[j];
      if (!joint.comparable) continue;
      const double k_before = *first.machine.joints[j].torsion, k_after = *second.machine.joints[j].torsion;
      const double error = joint.difference.value - (1.0 / k_after - 1.0 / k_before);
      found.held[m][j].push_back(std::abs(error) <= joint.difference.expanded());
      found.width[m][j].push_back(joint.difference.expanded() * k_before);
      found.error[m][j].push_back(error / joint.difference.sd);
      if (hidden == Hidden::nothing) {
        found.taken_held[m][j].push_back(std::abs(joint.taken.value - (1.0 - k_before / k_after)) <=
                                         joint.taken.expanded());
      }
      if (stated) {
        found.ratio_held[m][j].push_back(std::abs(joint.ratio.value - k_after / k_before) <= joint.ratio.expanded());
      }
    }
  }
}

Coverage coverageOf(Hidden hidden, Postures postures, int pairs) {
  Coverage found;
  for (int pair = 0; pair < pairs; ++pair) {
    simulation::SimulationSpec first = simulated_pairs::firstDay(firstSeed(), pair, hidden);
    simulation::SimulationSpec second =
        simulated_pairs::anotherDay(first, simulated_pairs::drawnChange(firstSeed(), pair));
    choosePostures(postures, first, second);
    try {
      const comparison::Comparison comparison = compared(measured(first), measured(second));
      for (const comparison::StiffnessChange& change : comparison.methods) {
        EXPECT_TRUE(change.available) << reports::words(change.reason);
        EXPECT_EQ(change.same_postures, postures != Postures::others);
      }
      judge(first, second, hidden, comparison, found);
    } catch (const std::runtime_error& refused) {
      // A day that cannot be prepared or identified has no comparison: counted, and its machine named.
      fmt::print("pair {} of {} refused: {}\n", pair, firstSeed(), refused.what());
      ++found.refused;
    }
  }
  return found;
}

void printAll(const std::string& name, int pairs, const Coverage& found) {
  fmt::print("\n{}: {} pairs, first {}, {} refused\n", name, pairs, firstSeed(), found.refused);
  printTable("difference within U, %", found.held, 100.0, mean);
  printTable("median U, % of the compliance before", found.width, 100.0, median);
  printTable("mean error, standard uncertainties", found.error, 1.0, mean);
  printTable("share taken within U, %", found.taken_held, 100.0, mean);
  printTable("ratio within U where stated, %", found.ratio_held, 100.0, mean);
  fmt::print("ratio stated in {:.0f} % of pairs, difference above noise in {:.0f} %\n",
             100.0 * mean(found.ratio_stated), 100.0 * mean(found.above_noise));
}

/// `least`, `most`: of the coverage of all joints and methods together.
void expectCoverage(const std::string& name, Hidden hidden, Postures postures, double least = 0.93,
                    double most = 0.98) {
  const int pairs = pairsAsked();
  const Coverage found = coverageOf(hidden, postures, pairs);
  const bool full = pairs >= kManyPairs;
  EXPECT_LE(found.refused, 1 + pairs / 50) << name;
  std::vector<double> all;
  for (std::size_t m = 0; m < 3; ++m) {
    for (std::size_t j = 0; j < 6; ++j) {
      const std::vector<double>& own = found.held[m][j];
      all.insert(all.end(), own.begin(), own.end());
      // Four standard deviations of a binomial: of a hundred pairs with 95 % coverage 86.
      if (full && !own.empty()) {
        EXPECT_GE(mean(own), least + 0.02 - 4.0 * std::sqrt(0.95 * 0.05 / static_cast<double>(own.size())))
            << name << ' ' << m << ' ' << j;
      }
    }
  }
  // Errors of the methods and joints of a pair are correlated: as many independent ones as three a pair.
  const double reach = full ? 0.0 : 4.0 * std::sqrt(0.95 * 0.05 / (3.0 * pairs));
  EXPECT_GE(mean(all), least - reach) << name;
  EXPECT_LE(mean(all), full ? most : 1.0) << name;
  if (full) printAll(name, pairs, found);
}

TEST(ComparisonCoverage, NothingHidden) { expectCoverage("nothing hidden", Hidden::nothing, Postures::same); }
TEST(ComparisonCoverage, BearingsAndLinks) {
  expectCoverage("bearings and links", Hidden::bearings_and_links, Postures::same);
}
TEST(ComparisonCoverage, BearingsLinksAndBase) {
  expectCoverage("bearings, links and base", Hidden::bearings_links_and_base, Postures::same);
}
TEST(ComparisonCoverage, ThreePosturesInFourOfBoth) {
  expectCoverage("bearings and links, three postures in four of both", Hidden::bearings_and_links,
                 Postures::three_in_four);
}
TEST(ComparisonCoverage, OtherPosturesNothingHidden) {
  expectCoverage("nothing hidden, other postures", Hidden::nothing, Postures::others);
}
// What is hidden does not cancel: the uncertainty holds it only as far as it scatters.
TEST(ComparisonCoverage, OtherPosturesBearingsAndLinks) {
  expectCoverage("bearings and links, other postures", Hidden::bearings_and_links, Postures::others, 0.6, 1.0);
}

/// The model that a day's data support, as `compare` takes it.
extended_model::ExtendedModel supported(const simulation::SimulationSpec& spec) {
  identification::IdentifyOptions options;
  options.subsets.size = std::numeric_limits<int>::max();
  const preparation::PreparedCampaign prepared = preparation::prepareCampaign(simulation::simulate(spec));
  return extended_model::supportedModel(prepared, prepared.campaign, options);
}

// Where no posture is in both nothing cancels. The two days' models give a difference that is nearer to the truth than
// by springs alone, whose misfit is in it; U, of the intervals of both, is not wider, and holds it.
TEST(ComparisonCoverage, OtherPosturesByTheDaysModels) {
  // Four pairs are too few: a few of the drawn models decide, and rounding decides those.
  const int pairs = std::max(12, pairsAsked() / 3);
  Coverage by_models, by_springs;
  for (int pair = 0; pair < pairs; ++pair) {
    simulation::SimulationSpec first = simulated_pairs::firstDay(firstSeed(), pair, Hidden::bearings_and_links);
    simulation::SimulationSpec second =
        simulated_pairs::anotherDay(first, simulated_pairs::drawnChange(firstSeed(), pair));
    choosePostures(Postures::others, first, second);
    const extended_model::ExtendedModel before = supported(first), after = supported(second);
    comparison::BootstrapOptions bootstrap;
    bootstrap.samples = 1;
    const comparison::SupportedModels models{&before.with, &after.with, true, true};
    const auto compare = [&](const comparison::SupportedModels& by) {
      return comparison::compareCampaigns(before.campaign, before.without, after.campaign, after.without, by,
                                          bootstrap);
    };
    const comparison::Comparison modelled = compare(models);
    for (const comparison::StiffnessChange& change : modelled.methods) EXPECT_TRUE(change.by_models);
    judge(first, second, Hidden::bearings_and_links, modelled, by_models);
    judge(first, second, Hidden::bearings_and_links, compare({}), by_springs);
  }
  std::vector<double> held, width, model_errors, spring_errors;
  for (std::size_t m = 0; m < 3; ++m) {
    for (std::size_t j = 0; j < 6; ++j) {
      held.insert(held.end(), by_models.held[m][j].begin(), by_models.held[m][j].end());
      for (std::size_t i = 0; i < by_models.width[m][j].size(); ++i) {
        width.push_back(by_models.width[m][j][i] / by_springs.width[m][j][i]);
        // In standard uncertainties, which are U over about 2 in both.
        model_errors.push_back(std::abs(by_models.error[m][j][i]) * by_models.width[m][j][i]);
        spring_errors.push_back(std::abs(by_springs.error[m][j][i]) * by_springs.width[m][j][i]);
      }
    }
  }
  fmt::print("by models: {:.0f} % held, U {:.2f} of that by springs, errors {:.2f}\n", 100.0 * mean(held),
             median(width), median(model_errors) / median(spring_errors));
  // As above: three independent ones a pair.
  EXPECT_GE(mean(held), 0.93 - 4.0 * std::sqrt(0.95 * 0.05 / (3.0 * pairs)));
  EXPECT_LE(median(width), 1.05);
  EXPECT_LT(median(model_errors), 0.7 * median(spring_errors));
  if (pairsAsked() < kManyPairs) return;
  printAll("bearings and links, other postures, by the days' models", pairs, by_models);
}

struct Alarms {
  ByJoint seen, false_joint, false_plain;
  std::array<std::vector<double>, 3> false_day;  // any joint
};

void judgeAlarms(int pair, Alarms& found) {
  const simulation::SimulationSpec first = simulated_pairs::firstDay(firstSeed(), pair, Hidden::bearings_and_links);
  const Day before = measured(first);
  const auto softened = static_cast<std::size_t>(pair % 6);
  std::array<double, 6> factors{1, 1, 1, 1, 1, 1};
  const comparison::Comparison same = compared(before, measured(simulated_pairs::anotherDay(first, factors, 3)));
  factors[softened] = 1.05;
  const comparison::Comparison soft = compared(before, measured(simulated_pairs::anotherDay(first, factors, 4)));
  for (std::size_t m = 0; m < 3; ++m) {
    bool any = false;
    for (std::size_t j = 0; j < 6; ++j) {
      const comparison::JointChange &none = same.methods[m].joints[j], &one = soft.methods[m].joints[j];
      if (!none.comparable || !one.comparable) continue;
      found.false_plain[m][j].push_back(none.p_value < 0.05);
      any = any || none.p_holm < 0.05;
      (j == softened ? found.seen : found.false_joint)[m][j].push_back(one.p_holm < 0.05);
    }
    found.false_day[m].push_back(any);
  }
}

// One joint, another one in every pair, softened by 5 % under bearings and links that nobody modelled, and one day more
// on which nothing changed.
TEST(ComparisonCoverage, PowerAndFalseAlarms) {
  const int pairs = pairsAsked();
  Alarms found;
  for (int pair = 0; pair < pairs; ++pair) {
    try {
      judgeAlarms(pair, found);
    } catch (const std::runtime_error& refused) {
      fmt::print("pair {} of {} refused: {}\n", pair, firstSeed(), refused.what());
    }
  }
  for (std::size_t m = 0; m < 3; ++m) {
    // Family-wise 5 %, a binomial: four standard deviations.
    EXPECT_LE(mean(found.false_day[m]), 0.05 + 4.0 * std::sqrt(0.05 * 0.95 / pairs)) << m;
    // 5 % are two to four of the uncertainties U: the measured power is 90 %, and half of six is four deviations off.
    std::vector<double> all;
    for (const std::vector<double>& own : found.seen[m]) all.insert(all.end(), own.begin(), own.end());
    EXPECT_GE(mean(all), pairs < kManyPairs ? 0.5 : 0.8) << m;
  }
  if (pairs < kManyPairs) return;
  fmt::print("\n5 % softer under bearings and links: {} pairs, first {}\n", pairs, firstSeed());
  printTable("the softened joint found (Holm 5 %), %", found.seen, 100.0, mean);
  printTable("another joint called changed (Holm 5 %), %", found.false_joint, 100.0, mean);
  printTable("nothing changed, p < 5 % (plain), %", found.false_plain, 100.0, mean);
  for (std::size_t m = 0; m < 3; ++m) {
    fmt::print("nothing changed, any joint called changed (Holm 5 %), {}: {:.1f} %\n", std::array{"cp", "pp", "dpp"}[m],
               100.0 * mean(found.false_day[m]));
  }
}

}  // namespace comparison_coverage_test
}  // namespace stiffscope
