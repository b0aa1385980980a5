#include "core/validation/tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <vector>

#include "core/io/csv.h"
#include "core/io/input_error.h"
#include "core/io/numbers.h"

namespace stiffscope::validation {

/// A row of labels.csv or answers.csv, by column name. Throws InputError with file, line, column and value.
class TableRow {
 public:
  TableRow(std::string file, std::size_t line, std::map<std::string, std::string> cells)
      : file_(std::move(file)), line_(line), cells_(std::move(cells)) {}

  const std::string& text(const std::string& column) const { return cells_.at(column); }
  double number(const std::string& column) const;
  std::vector<double> numbers(const std::string& column) const;  ///< joined by '+'; none where empty
  [[noreturn]] void refuse(const std::string& column, const std::string& expected) const;

 private:
  std::string file_;
  std::size_t line_;
  std::map<std::string, std::string> cells_;
};

/// The rows of a table that has exactly these columns.
std::vector<TableRow> readTable(const std::string& file, const std::string& bytes,
                                const std::vector<std::string>& columns);

/// The parts between separators, empty ones kept ("a++b" has three); none of an empty text.
std::vector<std::string> split(const std::string& text, char separator);

namespace {

const std::vector<std::string> kAnswerColumns{"case", "verdict", "details", "classes", "failure"};

template <class Effect>
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
    const io::ParsedNumber number = io::parseNumber(parts[k + 1]);
    if (!number.expectation.empty()) row.refuse("classes", "four numbers after the effects");
    *values[k] = number.value;
  }
  return promise;
}

/// A shrink that was not given is not a number; it covers nothing.
double finite(double value) { return std::isfinite(value) ? value : -999.0; }

template <class Entries, class Classes>
Answer answerWith(const Entries& entries, const Classes& classes) {
  Answer answer;
  for (const auto& entry : entries) answer.entries.push_back({ids(entry.effects), plain(entry.detail)});
  for (const auto& one : classes) {
    answer.promises.push_back({ids(one.effects), finite(one.shrink.value), finite(one.shrink.low),
                               finite(one.shrink.high), finite(one.explained)});
  }
  return answer;
}

}  // namespace

Answer answerOf(const diagnosis::Verdict& verdict, const std::vector<diagnosis::EffectClass>& classes) {
  return answerWith(verdict.entries, classes);
}

Answer answerOf(const accuracy::AccuracyDiagnosis& given) {
  Answer answer = answerWith(given.verdict, given.classes);
  const std::string geometry = "kinematic_error";
  const bool said = std::any_of(answer.entries.begin(), answer.entries.end(), [&](const Answer::Entry& entry) {
    return std::find(entry.effects.begin(), entry.effects.end(), geometry) != entry.effects.end();
  });
  if (given.geometry_off_nominal && !said) answer.entries.push_back({{geometry}, ""});
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
      classes.push_back(fmt::format("{}:{}:{}:{}:{}", fmt::join(promise.effects, "|"), shortNumber(promise.value),
                                    shortNumber(promise.low), shortNumber(promise.high),
                                    shortNumber(promise.explained)));
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
    for (const std::string& one : split(row.text("classes"), ';')) answer.promises.push_back(promiseOf(row, one));
    answers.push_back(std::move(answer));
  }
  return answers;
}

namespace {

const std::vector<std::string> kLabelColumns{
    "case",   "kind",        "effects",      "details",    "shows", "sizes",   "deflection",          "positions",
    "shrink", "shrink_seen", "noise_factor", "background", "arm",   "loading", "stiffness_nm_per_rad"};

const char* nameOf(Shows shows) {
  switch (shows) {
    case Shows::deflection:
      return "deflection";
    case Shows::nests:
      return "nests";
    case Shows::positions:
      return "positions";
    case Shows::geometry:
      return "geometry";
  }
  return "";
}

/// What `part` says of each effect, joined by '+'.
template <class Part>
std::string joined(const std::vector<LabelledEffect>& effects, const Part& part) {
  std::string text;
  for (const LabelledEffect& one : effects) text += (text.empty() ? "" : "+") + part(one);
  return text;
}

CaseKind kindOf(const TableRow& row) {
  for (const CaseKind kind : {CaseKind::none, CaseKind::single, CaseKind::pair, CaseKind::outside, CaseKind::as_is}) {
    if (row.text("kind") == nameOf(kind)) return kind;
  }
  row.refuse("kind", "none, single, double, outside or as_is");
}

}  // namespace

std::string shortNumber(double value) { return fmt::format("{:.6g}", value); }

Label labelOf(const std::string& name, const BlindCase& one) {
  Label label{name,
              one.kind,
              {},
              one.together.shrink,
              one.together.shrink_seen,
              one.spec.tracker.true_noise_factor,
              one.background,
              one.arm,
              one.loading,
              {}};
  for (const simulation::JointStiffness& joint : one.spec.machine.joints) {
    label.stiffness.push_back(joint.torsion.value_or(0.0));
  }
  for (const PlacedEffect& placed : one.effects) {
    label.effects.push_back({placed.effect.empty() ? plain(placed.detail) : placed.effect, plain(placed.detail),
                             nameOf(placed.shows), placed.size(), placed.sizes.deflection, placed.sizes.positions});
  }
  return label;
}

std::string labelsCsv(const std::vector<Label>& labels) {
  std::string csv = fmt::format("{}\n", fmt::join(kLabelColumns, ","));
  for (const Label& one : labels) {
    const auto numbers = [&](double LabelledEffect::*member) {
      return joined(one.effects, [&](const LabelledEffect& e) { return shortNumber(e.*member); });
    };
    std::vector<std::string> stiffness;
    for (const double value : one.stiffness) stiffness.push_back(fmt::format("{:.1f}", value));  // no exponent's '+'
    csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", one.name, nameOf(one.kind),
                       joined(one.effects, [](const LabelledEffect& e) { return e.id; }),
                       joined(one.effects, [](const LabelledEffect& e) { return e.detail; }),
                       joined(one.effects, [](const LabelledEffect& e) { return e.shows; }),
                       numbers(&LabelledEffect::size), numbers(&LabelledEffect::deflection),
                       numbers(&LabelledEffect::positions), shortNumber(one.shrink), shortNumber(one.shrink_seen),
                       shortNumber(one.noise_factor), shortNumber(one.background), one.arm, one.loading,
                       fmt::join(stiffness, "+"));
  }
  return csv;
}

std::vector<Label> readLabels(const std::string& file, const std::string& bytes) {
  std::vector<Label> labels;
  for (const TableRow& row : readTable(file, bytes, kLabelColumns)) {
    Label label{row.text("case"),
                kindOf(row),
                {},
                row.number("shrink"),
                row.number("shrink_seen"),
                row.number("noise_factor"),
                row.number("background"),
                row.text("arm"),
                row.text("loading"),
                {}};
    const std::vector<double> stiffness = row.numbers("stiffness_nm_per_rad");
    if (stiffness.size() < kFewestJoints || stiffness.size() > kMostJoints) {
      row.refuse("stiffness_nm_per_rad", fmt::format("{} to {} numbers joined by '+'", kFewestJoints, kMostJoints));
    }
    label.stiffness.assign(stiffness.begin(), stiffness.end());
    const std::vector<std::string> ids = split(row.text("effects"), '+'), details = split(row.text("details"), '+'),
                                   shows = split(row.text("shows"), '+');
    const std::vector<double> sizes = row.numbers("sizes"), deflection = row.numbers("deflection"),
                              positions = row.numbers("positions");
    const std::size_t count = ids.size();
    if (shows.size() != count || sizes.size() != count || deflection.size() != count || positions.size() != count) {
      row.refuse("effects", "as many effects as sizes");
    }
    for (std::size_t e = 0; e < count; ++e) {
      label.effects.push_back(
          {ids[e], e < details.size() ? details[e] : "", shows[e], sizes[e], deflection[e], positions[e]});
    }
    labels.push_back(label);
  }
  return labels;
}

void TableRow::refuse(const std::string& column, const std::string& expected) const {
  throw io::InputError({file_, line_, column}, cells_.at(column), "expected " + expected);
}

double TableRow::number(const std::string& column) const {
  const io::ParsedNumber parsed = io::parseNumber(text(column));
  if (!parsed.expectation.empty()) throw io::InputError({file_, line_, column}, text(column), parsed.expectation);
  return parsed.value;
}

std::vector<double> TableRow::numbers(const std::string& column) const {
  std::vector<double> values;
  for (const std::string& part : split(text(column), '+')) {
    const io::ParsedNumber parsed = io::parseNumber(part);
    if (!parsed.expectation.empty()) throw io::InputError({file_, line_, column}, part, parsed.expectation);
    values.push_back(parsed.value);
  }
  return values;
}

std::vector<TableRow> readTable(const std::string& file, const std::string& bytes,
                                const std::vector<std::string>& columns) {
  io::CsvLines lines(file, bytes);
  std::vector<std::string_view> cells;
  std::vector<TableRow> rows;
  bool header = true;
  while (lines.next(cells)) {
    const bool expected =
        cells.size() == columns.size() && (!header || std::equal(cells.begin(), cells.end(), columns.begin()));
    if (!expected) {
      throw io::InputError(
          {file, lines.line(), ""}, fmt::format("{}", fmt::join(cells, ",")),
          fmt::format("expected {}{}", header ? "the header " : "a cell for each of ", fmt::join(columns, ",")));
    }
    std::map<std::string, std::string> named;
    for (std::size_t c = 0; c < columns.size(); ++c) named[columns[c]] = std::string(cells[c]);
    if (!header) rows.emplace_back(file, lines.line(), std::move(named));
    header = false;
  }
  return rows;
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  if (text.empty()) return parts;
  std::size_t from = 0;
  for (std::size_t at = text.find(separator); at != std::string::npos; at = text.find(separator, from)) {
    parts.push_back(text.substr(from, at - from));
    from = at + 1;
  }
  parts.push_back(text.substr(from));
  return parts;
}

}  // namespace stiffscope::validation
