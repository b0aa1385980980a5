#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <iterator>

#include "core/identification/held_out_loads.h"
#include "reports/text/text.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"

namespace stiffscope::reports {

namespace {

using identification::HeldOutLoad;
using identification::Method;

std::string nameOf(const HeldOutLoad& one) {
  return one.step ? fmt::format("step {}", *one.step) : std::string(nameOfDirection(*one.direction));
}

/// "99.4 (99.1)": at the reflectors, and at P_wrist where that is measured.
std::string shareCell(const HeldOutLoad& one) {
  const auto cell = [](const std::optional<double>& share) {
    return share ? fmt::format("{:.2f}", 100.0 * *share) : "-";
  };
  return one.at_wrist ? fmt::format("{} ({})", cell(one.at_targets), cell(one.at_wrist)) : cell(one.at_targets);
}

std::string jointsNotSeen(const HeldOutLoad& one) {
  std::vector<int> joints;
  for (std::size_t j = 0; j < one.not_by_the_others.size(); ++j)
    if (one.not_by_the_others[j]) joints.push_back(static_cast<int>(j) + 1);
  if (joints.empty()) return {};
  return fmt::format("  the other loads do not turn joint {}, here taken as stiff", fmt::join(joints, ", "));
}

/// The same loads of each method, a line each.
void writeRows(const std::array<std::vector<HeldOutLoad>, 3>& by_method, const std::vector<Method>& methods,
               std::string& text) {
  const auto out = std::back_inserter(text);
  const auto of = [&](Method method) -> const std::vector<HeldOutLoad>& {
    return by_method[static_cast<std::size_t>(method)];
  };
  std::vector<const HeldOutLoad*> loads;
  for (const Method method : methods) {
    for (const HeldOutLoad& one : of(method)) {
      const auto same = [&](const HeldOutLoad* other) { return nameOf(*other) == nameOf(one); };
      if (std::none_of(loads.begin(), loads.end(), same)) loads.push_back(&one);
    }
  }
  for (const HeldOutLoad* load : loads) {
    fmt::format_to(out, "  {:<12}{:>8}{:>8.0f}", nameOf(*load), load->states, load->mean_force);
    for (const Method method : methods) {
      const auto& own = of(method);
      const auto found =
          std::find_if(own.begin(), own.end(), [&](const HeldOutLoad& one) { return nameOf(one) == nameOf(*load); });
      if (!own.empty()) fmt::format_to(out, "{:>18}", found == own.end() ? "-" : shareCell(*found));
    }
    fmt::format_to(out, "{}\n", jointsNotSeen(*load));
  }
}

}  // namespace

std::string heldOutLoadsText(const identification::HeldOutLoads& loads, const identification::Identification& result,
                             const std::vector<Method>& methods, bool effects) {
  const auto any = [&](const auto& by_method) {
    return std::any_of(methods.begin(), methods.end(),
                       [&](Method method) { return !by_method[static_cast<std::size_t>(method)].empty(); });
  };
  const bool levels = any(loads.levels), directions = any(loads.directions);
  std::string text;
  const auto out = std::back_inserter(text);
  if (levels || directions) {
    fmt::format_to(out, "\nShare compensated under loads that took no part, at the reflectors (at P_wrist), %\n");
    fmt::format_to(out, "  {:<12}{:>8}{:>8}", "", "states", "N");
    for (const Method method : methods) {
      const auto at = static_cast<std::size_t>(method);
      if (!loads.levels[at].empty() || !loads.directions[at].empty())
        fmt::format_to(out, "{:>18}", namesOf(method).brief);
    }
    fmt::format_to(out, "\n");
    writeRows(loads.levels, methods, text);
    writeRows(loads.directions, methods, text);
    std::string note =
        levels ? fmt::format("Load steps by the stiffnesses of step {}", fmt::join(result.steps, ", ")) : std::string();
    if (directions) note += std::string(levels ? "; directions" : "Directions") + " by those of the other directions";
    if (effects) note += "; effects are fitted to all loads";
    fmt::format_to(out, "  {}\n", wrapped(note + ".", 2));
  }
  const auto pulled = std::count_if(loads.states.begin(), loads.states.end(), [](int states) { return states > 0; });
  if (pulled == 1) {
    const auto only = std::find_if(loads.states.begin(), loads.states.end(), [](int states) { return states > 0; });
    fmt::format_to(
        out, "  {}\n",
        wrapped(fmt::format("All loads pull {}: how far these stiffnesses hold under others is not seen here.",
                            nameOfDirection(static_cast<identification::LoadDirection>(only - loads.states.begin()))),
                2));
  }
  return text;
}

}  // namespace stiffscope::reports
