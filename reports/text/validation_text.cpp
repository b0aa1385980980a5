#include "core/validation/run_blind.h"
#include "reports/text/text.h"

#include <fmt/format.h>

#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

std::string counted(const numerics::Rate& rate) {
  if (rate.trials == 0) return "-";
  return fmt::format("{}/{}", rate.hits, rate.trials);
}

std::string effectLines(const std::vector<validation::EffectScore>& effects) {
  std::string text;
  for (const validation::EffectScore& one : effects) {
    text += fmt::format("  {:<24}{:>8}{:>10}{:>10}{:>10}{:>9}\n", one.id, counted(one.all), counted(one.from_2),
                        counted(one.from_5), one.answered_none,
                        one.mean_class_size > 0.0 ? fmt::format("{:.1f}", one.mean_class_size) : "-");
  }
  return text;
}

}  // namespace

std::string blindText(const validation::BlindResult& result) {
  std::string text = fmt::format("Blind test, {} machines\nlabels sealed   {}\nanswers frozen  {}\n\n",
                                 result.score.cases.size(), result.seal, result.answers_hash);
  for (const validation::NamedRate& one : result.score.rates) {
    if (one.rate.trials == 0) {
      text += fmt::format("  {:<66}   no case\n", words(one.meaning));
    } else {
      text += fmt::format("  {:<66}{:>8}  {:3.0f} % ({:.0f}-{:.0f})\n", words(one.meaning), counted(one.rate),
                          100 * one.rate.value(), 100 * one.rate.low, 100 * one.rate.high);
    }
  }
  text += fmt::format("\n  {:<24}{:>8}{:>10}{:>10}{:>10}{:>9}\n", "singles answered right", "all", "size >= 2",
                      "size >= 5", "said none", "class of");
  text += effectLines(result.score.effects);
  text += "\n  outside the vocabulary, unknown said alone\n" + effectLines(result.score.outside);
  if (!result.score.as_is.empty())
    text += "\n  machines as they are, the effect named\n" + effectLines(result.score.as_is);
  return text;
}

}  // namespace stiffscope::reports
