#include "render/ticks.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>

namespace stiffscope::render {

namespace {

// Bounds meant to be ticks may miss them by rounding.
constexpr double kSlack = 1e-9;

// Beyond these, numbers are written with powers of ten.
constexpr double kLarge = 1e4;
constexpr double kSmall = 1e-4;

// U+2212, the minus sign proper; the hyphen is too short beside digits.
std::string withMinus(std::string text) {
  if (!text.empty() && text[0] == '-') text.replace(0, 1, "\u2212");
  return text;
}

std::string superscript(int exponent) {
  constexpr std::array digits = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                 "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  std::string text;
  for (const char c : std::to_string(exponent)) {
    text += c == '-' ? "\u207b" : digits[static_cast<std::size_t>(c - '0')];
  }
  return text;
}

// All labels of an axis are written the same way: with as many decimals as the step has, or with powers of
// ten.
std::string tickLabel(double value, double step, double largest) {
  if (value == 0) return "0";
  if (largest >= 10 * kLarge || step < kSmall) return shortNumber(value);
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - kSlack)));
  return withMinus(fmt::format("{:.{}f}", value, decimals));
}

}  // namespace

double roundDown125(double x) {
  const double power = std::pow(10.0, std::floor(std::log10(x)));
  for (const double digit : {10.0, 5.0, 2.0}) {
    if (digit * power <= x * (1 + kSlack)) return digit * power;
  }
  return power;
}

double roundUp125(double x) {
  const double power = std::pow(10.0, std::floor(std::log10(x)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * power >= x * (1 - kSlack)) return digit * power;
  }
  return 10 * power;
}

Ticks linearTicks(double lower, double upper, int most) {
  double step = roundUp125((upper - lower) / std::max(1, most - 1));
  const auto first = [&] { return std::ceil(lower / step - kSlack); };
  const auto last = [&] { return std::floor(upper / step + kSlack); };
  while (first() >= last()) step = roundDown125(0.9 * step);
  Ticks ticks;
  for (double i = first(); i <= last(); ++i) {
    ticks.positions.push_back(i * step);
    ticks.labels.push_back(tickLabel(i * step, step, std::max(std::abs(lower), std::abs(upper))));
  }
  return ticks;
}

Ticks logTicks(double lower, double upper) {
  const double decades = std::log10(upper / lower);
  std::vector<double> digits{1};
  if (decades < 3) digits = {1, 2, 5};
  if (decades < 0.8) digits = {1, 1.5, 2, 3, 4, 5, 6, 7, 8, 9};
  const int every = std::max(1, static_cast<int>(std::ceil(decades / 9)));
  Ticks ticks;
  for (int e = static_cast<int>(std::floor(std::log10(lower))); e <= std::ceil(std::log10(upper)); ++e) {
    if (e % every != 0) continue;
    for (const double digit : digits) {
      const double x = digit * std::pow(10.0, e);
      if (x < lower * (1 - kSlack) || x > upper * (1 + kSlack)) continue;
      ticks.positions.push_back(x);
      ticks.labels.push_back(shortNumber(x));
    }
  }
  return ticks;
}

std::string shortNumber(double x) {
  if (x == 0 || !std::isfinite(x)) return withMinus(fmt::format("{}", x));
  if (std::abs(x) < kLarge && std::abs(x) >= kSmall) return withMinus(fmt::format("{:.4g}", x));
  const std::string scientific = fmt::format("{:.3e}", x);
  const std::size_t e = scientific.find('e');
  const double mantissa = std::stod(scientific.substr(0, e));
  const std::string power = "10" + superscript(std::stoi(scientific.substr(e + 1)));
  if (mantissa == 1) return power;
  if (mantissa == -1) return "\u2212" + power;
  return withMinus(fmt::format("{:.4g}", mantissa)) + "\u00d7" + power;
}

std::string factorText(double x) {
  if (!(x >= 1e4 && x < 1e6) || x != std::round(x)) return shortNumber(x);
  const long whole = std::lround(x);
  return fmt::format("{}\u00a0{:03}", whole / 1000, whole % 1000);
}

}  // namespace stiffscope::render
