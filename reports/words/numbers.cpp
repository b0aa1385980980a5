#include "reports/words/numbers.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <sstream>
#include <string_view>
#include <utility>

#include "core/diagnosis/diagnosis.h"
#include "core/identification/estimate.h"
#include "core/identification/identification.h"
#include "core/identification/transmission.h"
#include "core/numerics/distributions.h"

#include "core/io/units.h"

namespace stiffscope::reports {

StiffnessUnit stiffnessUnit(const std::vector<double>& stiffnesses) {
  double least = std::numeric_limits<double>::infinity();
  for (const double one : stiffnesses) {
    if (std::isfinite(one) && one != 0.0) least = std::min(least, std::abs(one));
  }
  constexpr double kKilo = 1e3, kLeastShown = 0.01;  // of the unit: two digits behind the leading zeros
  if (least >= kLeastShown * kMega) return {};
  if (least >= kLeastShown * kKilo) return {kKilo, "10³\u00a0Nm/rad", "1e3 Nm/rad"};
  return {1.0, "Nm/rad", "Nm/rad"};
}

StiffnessUnit stiffnessUnit(const identification::Identification& result) {
  std::vector<double> stiffnesses;
  for (const identification::MethodResult& method : result.methods) {
    for (int joint = 0; method.available && joint < method.estimate.joints(); ++joint) {
      if (method.estimate.identifiable[static_cast<std::size_t>(joint)])
        stiffnesses.push_back(method.estimate.stiffness(joint));
    }
  }
  return stiffnessUnit(stiffnesses);
}

StiffnessUnit stiffnessUnit(const identification::Transmission& transmission) {
  std::vector<double> gears;
  for (int joint = 0; joint < transmission.estimate.joints(); ++joint) {
    if (transmission.joints[static_cast<std::size_t>(joint)].measured)
      gears.push_back(transmission.estimate.stiffness(joint));
  }
  return stiffnessUnit(gears);
}

StiffnessUnit stiffnessUnit(const diagnosis::Diagnosis& diagnosis) {
  std::vector<double> stiffnesses;
  for (std::size_t j = 0; j < diagnosis.identifiable.size(); ++j) {
    if (diagnosis.identifiable[j]) stiffnesses.push_back(diagnosis.stiffness_after[static_cast<Eigen::Index>(j)]);
  }
  return stiffnessUnit(stiffnesses);
}

LengthUnit lengthUnit(double largest) {
  // Neither 1000 nor 1000.0 µm.
  if (!(std::abs(largest) >= 0.9995 * io::kMillimetre)) return {};
  return {io::kMillimetre, "mm", "mm"};
}

std::string lengthWords(double metres, int decimals) {
  const LengthUnit unit = lengthUnit(metres);
  const double size = std::abs(metres) / io::kMillimetre;
  const int places = unit.size < io::kMillimetre ? decimals : size < 100.0 ? 2 : 1;
  return fmt::format("{:.{}f} {}", metres / unit.size, places, unit.text);
}

std::string shownLength(double metres, int digits) {
  const LengthUnit unit = lengthUnit(metres);
  return fmt::format("{}\u00a0{}", significant(metres / unit.size, digits), unit.name);
}

Coverage coverageOf(const identification::StiffnessEstimate& estimate, int joint) {
  if (!estimate.stated.empty())  // an interval of its own: no Student's t
    return {identification::expandedUncertainty(estimate, joint) / estimate.stiffnessSd(joint), 0.0};
  const double factor = identification::coverageFactor(estimate, joint, identification::kStatedCoverage);
  return {factor, std::isfinite(factor) ? estimate.dof(joint) : 0.0};
}

int placesThatTell(double low, double high) {
  constexpr int kMost = 2;
  int places = 0;
  while (places < kMost && low != high && fixed(low, places) == fixed(high, places)) ++places;
  return places;
}

double expanded(double standard_uncertainty) {
  return numerics::normalLimit(1.0 - identification::kStatedCoverage) * standard_uncertainty;
}

namespace {

constexpr const char* kNoNumber = "–";

std::string withMinus(const std::string& digits) {
  if (digits.empty() || digits.front() != '-') return digits;
  const std::string rest = digits.substr(1);
  // What rounds to zero has no sign.
  return rest.find_first_of("123456789") == std::string::npos ? rest : fmt::format("−{}", rest);
}

int exponentOf(double value) { return value == 0.0 ? 0 : static_cast<int>(std::floor(std::log10(std::abs(value)))); }

/// Decimal places that show `digits` significant digits of a value once it is rounded to them.
int placesFor(double value, int digits) {
  const int places = digits - 1 - exponentOf(value);
  const double unit = std::pow(10.0, -places);
  return digits - 1 - exponentOf(std::round(value / unit) * unit);
}

}  // namespace

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return kNoNumber;
  if (decimals >= 0) return withMinus(fmt::format("{:.{}f}", value, decimals));
  const double unit = std::pow(10.0, -decimals);
  return withMinus(fmt::format("{:.0f}", std::round(value / unit) * unit));
}

std::string significant(double value, int digits) {
  if (!std::isfinite(value)) return kNoNumber;
  if (value == 0.0) return "0";
  if (std::abs(value) < 1e7) return fixed(value, placesFor(value, digits));
  const int exponent = exponentOf(value);
  return withMinus(fmt::format("{:.{}f}e{}", value / std::pow(10.0, exponent), digits - 1, exponent));
}

std::string withUncertainty(double value, double standard_uncertainty) {
  if (!std::isfinite(value)) return kNoNumber;
  if (!std::isfinite(standard_uncertainty) || standard_uncertainty <= 0.0) return significant(value, 4);
  if (std::max(std::abs(value), standard_uncertainty) >= 1e7) {
    return fmt::format("{} ± {}", significant(value, 2), significant(standard_uncertainty, 2));
  }
  const int places = placesFor(standard_uncertainty, 2);
  return fmt::format("{} ± {}", fixed(value, places), fixed(standard_uncertainty, places));
}

bool anyPositiveStiffness(const identification::Identification& result) {
  const auto placed = [](double stiffness) { return std::isfinite(stiffness) && stiffness > 0.0; };
  for (const identification::MethodResult& method : result.methods) {
    const identification::StiffnessEstimate& estimate = method.estimate;
    for (int joint = 0; method.available && joint < estimate.joints(); ++joint) {
      if (!estimate.identifiable[static_cast<std::size_t>(joint)]) continue;
      const identification::CoverageInterval interval = identification::stiffnessInterval(estimate, joint);
      if (placed(estimate.stiffness(joint)) || placed(interval.low) || placed(interval.high)) return true;
    }
  }
  return false;
}

bool farFromSymmetric(const identification::StiffnessEstimate& estimate, int joint) {
  constexpr double kWide = 0.2;
  const identification::CoverageInterval interval = identification::complianceInterval(estimate, joint);
  const double c = estimate.compliance[joint];
  return std::isfinite(interval.low) && std::isfinite(interval.high) &&
         std::max(interval.high - c, c - interval.low) >= kWide * std::abs(c);
}

std::string uncertainStiffness(const identification::StiffnessEstimate& estimate, int joint, double unit) {
  constexpr int kDigits = 2;
  const double k = estimate.stiffness(joint) / unit;
  const identification::CoverageInterval interval = identification::stiffnessInterval(estimate, joint);
  const auto shown = [unit](double end) { return significant(end / unit, kDigits); };
  if (farFromSymmetric(estimate, joint) && std::isfinite(interval.low)) {
    if (std::isfinite(interval.high))
      return fmt::format("{} ({} to {})", significant(k, kDigits), shown(interval.low), shown(interval.high));
    if (k < 0.0) return fmt::format("above {} (fit {})", shown(interval.low), significant(k, kDigits));
    return fmt::format("{} (above {})", significant(k, kDigits), shown(interval.low));
  }
  const double u = identification::expandedUncertainty(estimate, joint);
  if (!std::isfinite(u)) return fmt::format("{} (U open)", significant(k, kDigits));
  return withUncertainty(k, u / unit);
}

std::string toPlaceOf(double value, double width) {
  if (!std::isfinite(width) || width <= 0.0 || std::abs(value) >= 1e7) return significant(value, 4);
  return fixed(value, placesFor(width, 2));
}

int placesOf(double uncertainty, int without) {
  return std::isfinite(uncertainty) && uncertainty > 0.0 ? std::max(0, placesFor(uncertainty, 2)) : without;
}

std::string asPrinted(double value) { return withMinus(fmt::format("{}", value)); }

std::string percentNumber(double share, int decimals) {
  constexpr int kMostDecimals = 2;
  const auto readsAsWhole = [share](int places) {
    return share < 1.0 && fixed(100.0 * share, places).starts_with("100");
  };
  int places = decimals;
  while (places < kMostDecimals && readsAsWhole(places)) ++places;
  if (readsAsWhole(places)) places = decimals;
  return fixed(100.0 * share, places);
}

std::string percent(double share, int decimals) {
  return std::isfinite(share) ? fmt::format("{}\u00a0%", percentNumber(share, decimals)) : kNoNumber;
}

namespace {

bool partOfWord(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

void replaceWord(std::string& text, std::string_view word, std::string_view by) {
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    const bool begins = at == 0 || !partOfWord(text[at - 1]) || !partOfWord(word.front());
    const std::size_t end = at + word.size();
    const bool ends = end == text.size() || !partOfWord(text[end]) || !partOfWord(word.back());
    if (begins && ends) text.replace(at, word.size(), by);
  }
}

}  // namespace

std::string withMicro(const std::string& text) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kUnits{
      {{"um", "µm"}, {"urad", "µrad"}, {"+-", "±"}, {"chi2", "χ²"}}};
  std::string words = text;
  for (const auto& [from, to] : kUnits) replaceWord(words, from, to);
  return words;
}

std::string microUnits(const std::string& text) {
  std::string changed;
  const auto letter = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || (c & 0x80) != 0;
  };
  for (std::size_t at = 0; at < text.size(); ++at) {
    const bool unit = text[at] == 'u' && (text.compare(at, 2, "um") == 0 || text.compare(at, 4, "urad") == 0);
    const std::size_t end = at + (text.compare(at, 2, "um") == 0 ? 2 : 4);
    if (!unit || (end < text.size() && letter(text[end])) || at == 0 || letter(text[at - 1])) {
      changed += text[at];
      continue;
    }
    const std::size_t before = text.find_last_not_of(" \n", at - 1);
    const bool counts = before != std::string::npos && (std::isdigit(static_cast<unsigned char>(text[before])) != 0 ||
                                                        text[before] == '(' || text[before] == '?');
    changed += counts ? "µ" : "u";
  }
  return changed;
}

namespace {

/// "+-" of a line as ±: before a number "± ", as wide; elsewhere a column narrower, which the last gap of two blanks
/// before it takes.
void replacePlusMinus(std::string& line) {
  for (std::size_t at = line.find("+-"); at != std::string::npos; at = line.find("+-", at + 1)) {
    const bool begins = at == 0 || line[at - 1] == ' ' || line[at - 1] == '(';
    if (!begins) continue;
    const char next = at + 2 < line.size() ? line[at + 2] : ' ';
    if (std::isdigit(static_cast<unsigned char>(next)) != 0 || next == '?' || next == '-') {
      line.replace(at, 2, "± ");
      continue;
    }
    line.replace(at, 2, "±");
    const std::size_t gap = line.rfind("  ", at);
    // Blanks at the beginning are no gap between columns.
    if (gap != std::string::npos && line.find_first_not_of(' ') < gap) line.insert(gap, 1, ' ');
  }
}

}  // namespace

std::string plusMinusSigns(const std::string& text) {
  std::string changed;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string line = text.substr(begin, end - begin);
    replacePlusMinus(line);
    changed += line;
    if (end < text.size()) changed += '\n';
    begin = end + 1;
  }
  return changed;
}

std::string wrapped(const std::string& text, std::size_t indent) {
  constexpr std::size_t kColumns = 98;
  std::istringstream words(text);
  std::string result, word;
  std::size_t column = 0;
  while (words >> word) {
    if (column > 0 && column + 1 + word.size() > kColumns) {
      result += '\n' + std::string(indent, ' ');
      column = indent;
    } else if (column > 0) {
      result += ' ';
      ++column;
    }
    result += word;
    column += word.size();
  }
  return result;
}

std::string forceWords(double newtons) {
  constexpr double kKilo = 1e3;
  // What would print as 1000 N is a kilonewton.
  if (newtons < 0.9995 * kKilo) return significant(newtons, 3) + "\u00a0N";
  return fixed(newtons / kKilo, 2) + "\u00a0kN";
}

double um(double metres) { return metres / io::kMicrometre; }

}  // namespace stiffscope::reports
