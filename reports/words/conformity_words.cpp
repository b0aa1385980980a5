#include "reports/words/conformity_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/io/units.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"

namespace stiffscope::reports {

using conformity::Decision;
using conformity::Missing;
using conformity::Quantity;
using conformity::Verdict;

const char* nameOf(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "pass";
    case Verdict::fail:
      return "fail";
    case Verdict::not_evaluated:
      break;
  }
  return "not evaluated";
}

const char* nameOf(Missing missing) {
  switch (missing) {
    case Missing::not_of_such_a_day:
      return "not_of_such_a_day";
    case Missing::no_such_joint:
      return "no_such_joint";
    case Missing::not_identified:
      return "not_identified";
    case Missing::sag_left_in:
      return "sag_left_in";
    case Missing::no_uncertainty:
      return "no_uncertainty";
    case Missing::nothing:
      break;
  }
  return "";
}

namespace {

/// The unit that people read, and how much of SI it is.
struct ReadUnit {
  const char* name;
  double unit;
};

ReadUnit unitOf(Quantity quantity) {
  const std::string_view name = conformity::nameOf(quantity).name;
  if (name.ends_with("_percent")) return {"%", 0.01};
  if (name.ends_with("_n_per_um")) return {"N/µm", 1.0 / io::kMicrometre};
  if (name.ends_with("_mm")) return {"mm", io::kMillimetre};
  return {"10⁶\u00a0Nm/rad", kMega};
}

}  // namespace

std::string limitName(Quantity quantity) {
  switch (quantity) {
    case Quantity::compensated_at_reflectors:
      return "Compensated at the reflectors, held out";
    case Quantity::compensated_at_wrist:
      return "Compensated at P_{wrist}, held out";
    case Quantity::softest:
      return "Softest direction at P_{TCP} in these postures";
    case Quantity::avoided:
      return "Deflection avoided by active double encoders";
    case Quantity::nominal_rms:
      return "Position error of the URDF's arm, rms";
    case Quantity::nominal_largest:
      return "Position error of the URDF's arm, largest";
    case Quantity::calibrated_rms:
      return "Position error when calibrated, rms";
    case Quantity::calibrated_largest:
      return "Position error when calibrated, largest";
    case Quantity::link_difference:
      return "Distance between axes, largest difference";
    default:
      return jointName(static_cast<int>(quantity));
  }
}

std::string limitAsked(const conformity::Limit& limit) {
  const ReadUnit unit = unitOf(limit.quantity);
  const auto number = [&unit](double value) { return asPrinted(value / unit.unit); };
  if (limit.least && limit.most)
    return fmt::format("{} to {}\u00a0{}", number(*limit.least), number(*limit.most), unit.name);
  if (limit.least) return fmt::format("at least {}\u00a0{}", number(*limit.least), unit.name);
  return fmt::format("at most {}\u00a0{}", number(*limit.most), unit.name);
}

std::string foundWords(const Decision& one) {
  switch (one.missing) {
    case Missing::not_of_such_a_day:
      return "not measured on such a day";
    case Missing::no_such_joint:
      return "the machine has no such joint";
    case Missing::not_identified:
      return "not found on this day";
    case Missing::sag_left_in:
      return "not decided: the arm's own sag is in the readings and not in their uncertainty (the URDF has no masses)";
    case Missing::no_uncertainty:
      return "too little was measured for an uncertainty";
    case Missing::nothing:
      break;
  }
  const ReadUnit unit = unitOf(one.limit.quantity);
  const conformity::Measured& measured = *one.measured;
  const double width = measured.interval.high - measured.interval.low;
  const auto number = [&](double value) { return toPlaceOf(value / unit.unit, width / unit.unit); };
  if (!std::isfinite(width))
    return fmt::format("{} (above {})\u00a0{}", significant(measured.value / unit.unit, 3),
                       significant(measured.interval.low / unit.unit, 3), unit.name);
  return fmt::format("{} ({} to {})\u00a0{}", number(measured.value), number(measured.interval.low),
                     number(measured.interval.high), unit.name);
}

std::string verdictWords(const Decision& one) {
  return one.in_guard_band ? "fail: the value keeps the limit, but not by U" : nameOf(one.verdict);
}

std::string decisionRuleWords() {
  return "Decision rule: guarded acceptance with a guard band of U (JCGM 106:2012, ISO 14253-1). A limit passes where "
         "the whole 95\u00a0% interval of the quantity, value\u00a0−\u00a0U to value\u00a0+\u00a0U, keeps it; so what "
         "lies at its limit passes in 2.5\u00a0% of such measurements at most. Everything else fails.";
}

std::string acceptanceSentence(const std::vector<std::vector<Decision>>& by_day) {
  std::vector<std::string> failed, missing;
  std::size_t limits = 0;
  const auto add = [](std::vector<std::string>& names, const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const std::vector<Decision>& day : by_day) {
    limits = day.size();
    for (const Decision& one : day) {
      if (one.verdict == Verdict::fail) add(failed, limitName(one.limit.quantity));
    }
  }
  for (std::size_t i = 0; i < limits; ++i) {
    std::vector<std::vector<Decision>> alone;
    for (const std::vector<Decision>& day : by_day) alone.push_back({day[i]});
    if (conformity::overall(alone) == Verdict::not_evaluated) add(missing, limitName(by_day.front()[i].limit.quantity));
  }
  std::string text;
  if (!failed.empty())
    text = fmt::format("Acceptance: fail, by {} of {} limits ({}).", failed.size(), limits, fmt::join(failed, "; "));
  else if (missing.empty())
    return fmt::format("Acceptance: pass, by all {} limits.", limits);
  else
    text = "Acceptance: not evaluated.";
  if (!missing.empty()) text += fmt::format(" Not evaluated: {}.", fmt::join(missing, "; "));
  return text;
}

}  // namespace stiffscope::reports
