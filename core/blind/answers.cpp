#include "core/blind/answers.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/blind/labels.h"
#include "core/blind/sealed_table.h"
#include "core/input/numbers.h"

namespace stiffscope::blind {

namespace {

const std::vector<std::string> kAnswerColumns{"case", "verdict", "details", "classes", "failure"};

std::vector<std::string> ids(const std::vector<Effect>& effects) {
  std::vector<std::string> names;
  for (const Effect effect : effects) names.emplace_back(idOf(effect));
  return names;
}

/// Text that cannot be taken for a separator.
std::string plain(std::string text) {
  for (char& c : text) {
    const bool special = std::string_view(",+|;:\"\n\r").find(c) != std::string_view::npos;
    if (special) c = ' ';
  }
  return text;
}

Answer::Promise promiseOf(const TableRow& row, const std::string& text) {
  const std::vector<std::string> parts = split(text, ':');
  Answer::Promise promise;
  std::array<double*, 4> values{&promise.value, &promise.low, &promise.high, &promise.explained};
  if (parts.size() != 5) row.refuse("classes", "effects and four numbers, joined by ':'");
  promise.effects = split(parts[0], '|');
  for (std::size_t k = 0; k < 4; ++k) {
    const ParsedNumber number = parseNumber(parts[k + 1]);
    if (!number.expectation.empty()) row.refuse("classes", "four numbers after the effects");
    *values[k] = number.value;
  }
  return promise;
}

/// A shrink that was not given is not a number; it covers nothing.
double finite(double value) { return std::isfinite(value) ? value : -999.0; }

}  // namespace

Answer answerOf(const std::string& name, const DiagnosisAnswer& given) {
  Answer answer;
  answer.name = name;
  for (const VerdictEntry& entry : given.verdict.entries) {
    answer.entries.push_back({ids(entry.effects), plain(entry.detail)});
  }
  for (const EffectClass& one : given.classes) {
    answer.promises.push_back({ids(one.effects), finite(one.shrink.value), finite(one.shrink.low),
                               finite(one.shrink.high), finite(one.explained)});
  }
  return answer;
}

std::string answersCsv(const std::vector<Answer>& answers) {
  std::string csv = fmt::format("{}\n", fmt::join(kAnswerColumns, ","));
  for (const Answer& one : answers) {
    std::vector<std::string> entries, details, classes;
    for (const Answer::Entry& entry : one.entries) {
      entries.push_back(entry.effects.empty() ? "unknown" : fmt::format("{}", fmt::join(entry.effects, "|")));
      details.push_back(entry.detail);
    }
    if (entries.empty()) entries.push_back("none");
    for (const Answer::Promise& promise : one.promises) {
      classes.push_back(fmt::format("{}:{}:{}:{}:{}", fmt::join(promise.effects, "|"),
                                    shortNumber(promise.value), shortNumber(promise.low),
                                    shortNumber(promise.high), shortNumber(promise.explained)));
    }
    csv += fmt::format("{},{},{},{},{}\n", one.name,
                       one.failure.empty() ? fmt::format("{}", fmt::join(entries, "+")) : "failed",
                       fmt::join(details, "+"), fmt::join(classes, ";"), plain(one.failure));
  }
  return csv;
}

std::vector<Answer> readAnswers(const std::string& file, const std::string& bytes) {
  std::vector<Answer> answers;
  for (const TableRow& row : readTable(file, bytes, kAnswerColumns)) {
    Answer answer;
    answer.name = row.text("case");
    answer.failure = row.text("failure");
    const std::string& verdict = row.text("verdict");
    const std::vector<std::string> details = split(row.text("details"), '+');
    if (verdict != "none" && verdict != "failed") {
      for (const std::string& entry : split(verdict, '+')) {
        const std::size_t at = answer.entries.size();
        answer.entries.push_back({entry == "unknown" ? std::vector<std::string>{} : split(entry, '|'),
                                  at < details.size() ? details[at] : ""});
      }
    }
    for (const std::string& one : split(row.text("classes"), ';'))
      answer.promises.push_back(promiseOf(row, one));
    answers.push_back(std::move(answer));
  }
  return answers;
}

}  // namespace stiffscope::blind
