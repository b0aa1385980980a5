#include "core/identification/shown_first.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/identification/remarks.h"

namespace stiffscope::identification {

namespace {

using Judged = ShownFirst::Judged;

const std::vector<double>& heldOutAt(const MethodResult& method, Judged at) {
  return at == Judged::at_wrist ? method.subsets.at_wrist.held_out : method.subsets.at_targets.held_out;
}

/// What `first` compensates more than `second`, subset by subset where both were judged on the same ones.
MeanOverSubsets difference(const MethodResult& first, const MethodResult& second, Judged at) {
  const std::vector<double>&one = heldOutAt(first, at), &other = heldOutAt(second, at);
  const bool paired =
      one.size() == other.size() && first.subsets.size == second.subsets.size && first.subsets.of == second.subsets.of;
  if (!paired) {
    const MeanOverSubsets a = meanOverSubsets(one), b = meanOverSubsets(other);
    return {a.mean - b.mean, std::hypot(a.sd, b.sd)};
  }
  std::vector<double> differences(one.size());
  std::transform(one.begin(), one.end(), other.begin(), differences.begin(), std::minus<>());
  return meanOverSubsets(differences);
}

/// Methods judged by the campaigns together.
class Judgement {
 public:
  Judgement(std::span<const Identification* const> campaigns, Judged at) : campaigns_(campaigns), at_(at) {}

  /// Mean held-out share; NaN where a campaign has none.
  double share(Method method) const {
    double sum = 0.0;
    for (const Identification* one : campaigns_) sum += meanOverSubsets(heldOutAt(one->of(method), at_)).mean;
    return sum / static_cast<double>(campaigns_.size());
  }

  MeanOverSubsets more(Method method, Method than) const {
    double sum = 0.0, square = 0.0;
    for (const Identification* one : campaigns_) {
      const MeanOverSubsets own = difference(one->of(method), one->of(than), at_);
      sum += own.mean;
      square += own.sd * own.sd;
    }
    const auto n = static_cast<double>(campaigns_.size());
    return {sum / n, std::sqrt(square) / n};
  }

 private:
  std::span<const Identification* const> campaigns_;
  Judged at_;
};

/// `candidates` in the order of equals; empty where one of them was not judged.
std::optional<ShownFirst> chosenBy(const Judgement& judgement, Judged at, const std::vector<Method>& candidates) {
  std::vector<double> shares;
  for (const Method method : candidates) shares.push_back(judgement.share(method));
  if (!std::all_of(shares.begin(), shares.end(), [](double share) { return std::isfinite(share); }))
    return std::nullopt;
  const auto most =
      candidates[static_cast<std::size_t>(std::max_element(shares.begin(), shares.end()) - shares.begin())];
  std::vector<std::size_t> names;
  for (const Method method : candidates) names.push_back(static_cast<std::size_t>(method));
  for (const Method method : candidates) {
    if (method == most) break;
    const MeanOverSubsets behind = judgement.more(most, method);
    // Where the subsets tell little, a large difference is still more than none.
    constexpr double kAlike = 0.1;
    if (!(behind.mean <= std::min(behind.sd, kAlike))) continue;
    return ShownFirst{method, at,
                      Remark(RemarkId::shown_as_good_as_most, at, method, most, behind.mean, behind.sd, names, shares)};
  }
  return ShownFirst{most, at, Remark(RemarkId::shown_compensates_most, at, most, names, shares)};
}

}  // namespace

std::optional<ShownFirst> methodShownFirst(std::span<const Identification* const> campaigns,
                                           const std::array<bool, 3>& usable) {
  std::vector<Method> candidates;
  for (const Method method : kMethodsOfEquals) {
    if (usable[static_cast<std::size_t>(method)]) candidates.push_back(method);
  }
  if (candidates.empty()) return std::nullopt;
  if (candidates.size() == 1)
    return ShownFirst{candidates.front(), Judged::not_at_all, Remark(RemarkId::shown_alone, candidates.front())};
  for (const Judged at : {Judged::at_reflectors, Judged::at_wrist}) {
    if (const auto chosen = chosenBy(Judgement(campaigns, at), at, candidates)) return chosen;
  }
  return ShownFirst{candidates.front(), Judged::not_at_all, Remark(RemarkId::shown_unjudged, candidates.front())};
}

std::optional<ShownFirst> methodShownFirst(const Identification& result, bool papers_choice) {
  std::array<bool, 3> usable{};
  for (const Method method : kMethods) usable[static_cast<std::size_t>(method)] = result.of(method).available;
  if (papers_choice && result.of(Method::decoupled_partial_pose).available) {
    return ShownFirst{Method::decoupled_partial_pose, Judged::not_at_all,
                      Remark(RemarkId::shown_as_in_the_paper, Method::decoupled_partial_pose)};
  }
  const Identification* const one = &result;
  return methodShownFirst({&one, 1}, usable);
}

std::optional<Method> bestMethodOf(const Identification& result, std::span<const Method> methods) {
  const auto among = [&](Method method) {
    return result.of(method).available && std::find(methods.begin(), methods.end(), method) != methods.end();
  };
  if (result.shown_first && among(result.shown_first->method)) return result.shown_first->method;
  for (const Method method : kMethodsOfEquals) {
    if (among(method)) return method;
  }
  return std::nullopt;
}

std::optional<ShownFirst> shownFirstOf(const Identification& result, std::span<const Method> methods) {
  const std::optional<Method> best = bestMethodOf(result, methods);
  if (!best) return std::nullopt;
  if (methods.size() < kMethods.size())
    return ShownFirst{*best, Judged::not_at_all, Remark(RemarkId::shown_as_asked, *best)};
  return result.shown_first;
}

Method bestMethod(const Identification& result) {
  return bestMethodOf(result, kMethods).value_or(Method::complete_pose);
}

}  // namespace stiffscope::identification
