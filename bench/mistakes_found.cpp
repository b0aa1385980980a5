// How many of the usual mistakes the audit finds and names, and how many days without one it accuses.
//
// mistakes_found forms [--only WORDS] DAY...: every spoilt form of each day (tests/fixtures/spoilt_forms.h), or those
// whose name has these words, a line each, and the sums. DAY: a campaign's folder, or FAMILY:INDEX:SEED of the
// simulated machines of interval_coverage. mistakes_found days FAMILY COUNT SEED: so many days of a family, none of
// them spoilt: those with a finding.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "bench/machine_families.h"
#include "core/audit/audit.h"
#include "core/campaign/read_campaign.h"
#include "core/identification/identify.h"
#include "core/numerics/parallel.h"
#include "reports/words/remark_words.h"
#include "tests/fixtures/spoilt_forms.h"

namespace {

using namespace stiffscope;

campaign::Campaign dayNamed(const std::string& name) {
  const std::size_t first = name.find(':'), second = name.rfind(':');
  if (first == std::string::npos) return campaign::readCampaign(name).campaign;
  const std::string family = name.substr(0, first);
  const int index = std::stoi(name.substr(first + 1, second - first - 1));
  const std::uint64_t seed = std::stoull(name.substr(second + 1));
  const std::filesystem::path urdf =
      std::filesystem::temp_directory_path() / fmt::format("mistakes_found_{}.urdf", seed);
  const validation::BlindCase one = bench::drawMachine(family, index, seed, urdf);
  fmt::print("# {}: {}, {}\n", name, one.arm, one.loading);
  return bench::dayOf(family, one, seed);
}

/// All that the audit says of mistakes, for the words of a cure.
std::string saidOf(const audit::AuditReport& report) {
  std::string said;
  for (const mistakes::Suspected& one : report.suspected)
    said += fmt::format("{}: {}: {}\n", one.mistake.name(), reports::words(one.where), reports::words(one.remedy));
  for (const preparation::AuditCheck& check : report.checks) {
    if (check.verdict == preparation::AuditVerdict::fail)
      said += fmt::format("{}: {}: {}\n", check.id, reports::words(check.where), reports::words(check.message));
  }
  return said;
}

/// Whether a method's number is off by more than its standard uncertainty on the good day, or is gone.
bool changes(const identification::Identification& good, const identification::Identification& spoilt) {
  for (const identification::Method method : identification::kMethods) {
    const identification::MethodResult &was = good.of(method), &is = spoilt.of(method);
    if (!was.available) continue;
    if (!is.available) return true;
    for (int j = 0; j < was.estimate.joints(); ++j) {
      const auto joint = static_cast<std::size_t>(j);
      if (!was.estimate.identifiable[joint]) continue;
      if (!is.estimate.identifiable[joint]) return true;
      const double sd = std::sqrt(was.estimate.covariance(j, j));
      if (!(std::abs(is.estimate.compliance[j] - was.estimate.compliance[j]) <= sd)) return true;
    }
  }
  return false;
}

/// What the audit finds fault with: ids of checks that fail, and of suspected mistakes.
std::set<std::string> faultsOf(const audit::AuditReport& report) {
  std::set<std::string> faults;
  for (const preparation::AuditCheck& check : report.checks) {
    if (check.verdict == preparation::AuditVerdict::fail) faults.insert(check.id);
  }
  for (const mistakes::Suspected& one : report.suspected)
    faults.insert(fmt::format("suspected {}", one.mistake.name()));
  return faults;
}

struct GoodDay {
  campaign::Campaign campaign;
  identification::Identification result;
  std::set<std::string> faults;
};

struct FormResult {
  bool possible = false, changed = false, found = false, named = false;
  bool stopped = false;  ///< identify ends with 1
  std::string said;
};

FormResult judge(const SpoiltForm& form, const GoodDay& good) {
  FormResult found;
  campaign::Campaign day = good.campaign;
  if (!form.spoil(day)) return found;
  found.possible = true;
  try {
    const audit::AuditReport report = audit::audit(day);
    found.said = saidOf(report);
    const std::set<std::string> faults = faultsOf(report);
    found.found = std::any_of(faults.begin(), faults.end(),
                              [&](const std::string& fault) { return !good.faults.contains(fault); });
    found.stopped = faults.contains("arm_model") || faults.contains("load_model");
    for (const std::string& cure : form.cures) found.named |= found.said.find(cure) != std::string::npos;
    found.changed = changes(good.result, identification::identify(day, identification::valuesOnly()));
  } catch (const std::exception& error) {
    found.changed = found.found = found.stopped = true;
    found.said = fmt::format("refused: {}\n", error.what());
  }
  return found;
}

struct Count {
  int forms = 0, changed = 0, found = 0, named = 0, stopped = 0;
};

/// `only`: of forms whose name has it.
void printForms(const std::vector<std::string>& days, const std::string& only) {
  std::map<std::string, Count> by_family;
  Count all;
  for (const std::string& name : days) {
    GoodDay good{dayNamed(name), {}, {}};
    good.result = identification::identify(good.campaign, identification::valuesOnly());
    good.faults = faultsOf(audit::audit(good.campaign));
    fmt::print("{}: on the good day: {}\n", name,
               good.faults.empty() ? "nothing" : fmt::format("{}", fmt::join(good.faults, ", ")));
    std::vector<SpoiltForm> forms = spoiltForms();
    const std::vector<SpoiltForm> further = furtherSpoiltForms();
    forms.insert(forms.end(), further.begin(), further.end());
    std::erase_if(forms, [&](const SpoiltForm& form) { return form.name.find(only) == std::string::npos; });
    std::vector<FormResult> results(forms.size());
    numerics::onAllCores(forms.size(), [&](std::size_t i) { results[i] = judge(forms[i], good); });
    for (std::size_t i = 0; i < forms.size(); ++i) {
      const FormResult& one = results[i];
      if (!one.possible) continue;
      fmt::print("{:<11}{:<52}{:<9}{:<7}{}\n", forms[i].family, forms[i].name, one.changed ? "changes" : "-",
                 one.found ? "found" : "MISSED", one.named ? "named" : "-");
      if (!one.named) fmt::print("{}", one.said.substr(0, 1500));
      for (Count* count : {&by_family[forms[i].family], &all}) {
        ++count->forms;
        count->changed += one.changed;
        count->found += one.changed && one.found;
        count->named += one.changed && one.named;
        count->stopped += one.changed && one.stopped;
      }
    }
  }
  by_family["together"] = all;
  fmt::print("\n{:<12}{:>6}{:>9}{:>7}{:>7}{:>9}\n", "family", "forms", "changing", "found", "named", "stopped");
  for (const auto& [family, count] : by_family)
    fmt::print("{:<12}{:>6}{:>9}{:>7}{:>7}{:>9}\n", family, count.forms, count.changed, count.found, count.named,
               count.stopped);
}

void printDays(const std::string& family, int count, std::uint64_t seed) {
  std::mutex printing;
  int accused = 0;
  numerics::onAllCores(static_cast<std::size_t>(count), [&](std::size_t i) {
    const std::uint64_t own = seed + i;
    const std::filesystem::path urdf =
        std::filesystem::temp_directory_path() / fmt::format("mistakes_found_{}_{}.urdf", seed, i);
    const validation::BlindCase one = bench::drawMachine(family, static_cast<int>(i), own, urdf);
    const audit::AuditReport report = audit::audit(bench::dayOf(family, one, own));
    std::filesystem::remove(urdf);
    const std::lock_guard lock(printing);
    std::string effects;
    for (const validation::PlacedEffect& effect : one.effects)
      effects += fmt::format(" {} ({}, size {:.1f})", effect.effect, effect.detail, effect.size());
    bool found = false;
    for (const mistakes::Suspected& suspected : report.suspected) {
      if (suspected.mistake == "noise_declared") continue;
      found = true;
      fmt::print("{} {} {}{}: {}: {}: {}\n", own, one.arm, one.loading, effects, suspected.mistake.name(),
                 reports::words(suspected.where), reports::words(suspected.remedy));
    }
    accused += found;
  });
  fmt::print("{}: {} of {} days accused\n", family, accused, count);
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  try {
    if (arguments.size() >= 2 && arguments[0] == "forms") {
      const bool some = arguments.size() >= 4 && arguments[1] == "--only";
      printForms({arguments.begin() + (some ? 3 : 1), arguments.end()}, some ? arguments[2] : std::string());
    } else if (arguments.size() == 4 && arguments[0] == "days") {
      printDays(arguments[1], std::stoi(arguments[2]), std::stoull(arguments[3]));
    } else {
      fmt::print(stderr, "mistakes_found forms [--only WORDS] DAY... | days FAMILY COUNT SEED; FAMILY one of {}\n",
                 bench::kFamilies);
      return 2;
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
