#include "core/blind/labels.h"

#include <fmt/format.h>

#include <array>

#include "core/blind/sealed_table.h"

namespace stiffscope::blind {

namespace {

const std::vector<std::string> kLabelColumns{"case",         "kind",       "effects",   "details", "shows",
                                        "sizes",        "deflection", "positions", "shrink",  "shrink_seen",
                                        "noise_factor", "background", "arm",       "loading"};

const char* nameOf(Shows shows) {
  switch (shows) {
    case Shows::deflection:
      return "deflection";
    case Shows::nests:
      return "nests";
    case Shows::positions:
      return "positions";
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
  for (const CaseKind kind : {CaseKind::none, CaseKind::single, CaseKind::pair, CaseKind::outside}) {
    if (row.text("kind") == nameOf(kind)) return kind;
  }
  row.refuse("kind", "none, single, double or outside");
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
              one.loading};
  for (const PlacedEffect& placed : one.effects) {
    label.effects.push_back({placed.effect ? std::string(idOf(*placed.effect)) : placed.detail, placed.detail,
                             nameOf(placed.shows), placed.size(), placed.sizes.deflection,
                             placed.sizes.positions});
  }
  return label;
}

std::string labelsCsv(const std::vector<Label>& labels) {
  std::string csv = fmt::format("{}\n", fmt::join(kLabelColumns, ","));
  for (const Label& one : labels) {
    const auto numbers = [&](double LabelledEffect::*member) {
      return joined(one.effects, [&](const LabelledEffect& e) { return shortNumber(e.*member); });
    };
    csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", one.name, nameOf(one.kind),
                       joined(one.effects, [](const LabelledEffect& e) { return e.id; }),
                       joined(one.effects, [](const LabelledEffect& e) { return e.detail; }),
                       joined(one.effects, [](const LabelledEffect& e) { return e.shows; }),
                       numbers(&LabelledEffect::size), numbers(&LabelledEffect::deflection),
                       numbers(&LabelledEffect::positions), shortNumber(one.shrink),
                       shortNumber(one.shrink_seen), shortNumber(one.noise_factor),
                       shortNumber(one.background), one.arm, one.loading);
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
                row.text("loading")};
    const std::vector<std::string> ids = split(row.text("effects"), '+'),
                                   details = split(row.text("details"), '+'),
                                   shows = split(row.text("shows"), '+');
    const std::vector<double> sizes = row.numbers("sizes"), deflection = row.numbers("deflection"),
                              positions = row.numbers("positions");
    const std::size_t count = ids.size();
    if (shows.size() != count || sizes.size() != count || deflection.size() != count ||
        positions.size() != count) {
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

}  // namespace stiffscope::blind
