#include "core/interchange/export_comments.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <vector>

#include "core/interchange/length_unit.h"
#include "core/io/input_error.h"

namespace stiffscope::interchange {

namespace {

constexpr std::array<const char*, 3> kAxisLetters{"x", "y", "z"};

/// Marks of other scripts as ASCII has them: full-width letters, brackets and blanks, ideographic commas, quotation
/// marks.
std::string plainMarks(std::string_view comment) {
  struct Mark {
    std::string_view mark;
    char plain;
  };
  constexpr std::array<Mark, 13> kMarks{{{"\xE3\x80\x80", ' '},
                                         {"\xE3\x80\x81", ','},
                                         {"\xE3\x80\x82", '.'},
                                         {"\xE3\x80\x8C", '\''},
                                         {"\xE3\x80\x8D", '\''},
                                         {"\xE2\x80\x98", '\''},
                                         {"\xE2\x80\x99", '\''},
                                         {"\xE2\x80\x9C", '\''},
                                         {"\xE2\x80\x9D", '\''},
                                         {"\xE2\x80\x9E", '\''},
                                         {"\xC2\xAB", '\''},
                                         {"\xC2\xBB", '\''},
                                         {"\xC2\xB4", '\''}}};
  std::string plain;
  while (!comment.empty()) {
    const auto mark =
        std::find_if(kMarks.begin(), kMarks.end(), [&](const Mark& one) { return comment.starts_with(one.mark); });
    if (mark != kMarks.end()) {
      plain += mark->plain;
      comment.remove_prefix(mark->mark.size());
      continue;
    }
    // U+FF01 to U+FF5E are the characters from '!' to '~' again.
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(comment[i]); };
    const bool wide = comment.size() > 2 && byte(0) == 0xEF && (byte(1) == 0xBC || byte(1) == 0xBD);
    const int code = wide ? (byte(1) - 0xBC) * 0x40 + byte(2) - 0x80 : 0;
    if (wide && code >= 1 && code <= 0x5E) {
      plain += static_cast<char>(code + 0x20);
      comment.remove_prefix(3);
      continue;
    }
    plain += comment.front();
    comment.remove_prefix(1);
  }
  return plain;
}

/// The first text between two marks that holds '::'.
std::string frameIn(std::string_view comment) {
  const std::size_t colons = comment.find("::");
  if (colons == std::string_view::npos) return {};
  for (const char mark : {'\'', '"', '`'}) {
    const std::size_t open = comment.rfind(mark, colons);
    if (open == std::string_view::npos) continue;
    std::string_view rest = comment.substr(open + 1);
    const std::size_t close = rest.find_first_of("'\"");
    if (close != std::string_view::npos) return std::string(trimmed(rest.substr(0, close)));
  }
  // Without marks: the word that the colons are in.
  const std::size_t from = comment.find_last_of(" \t", colons) + 1;
  return std::string(comment.substr(from, comment.find_first_of(" \t", colons) - from));
}

/// Texts between round or square brackets.
std::vector<std::string_view> bracketed(std::string_view comment) {
  std::vector<std::string_view> found;
  while (true) {
    const std::size_t open = comment.find_first_of("([");
    if (open == std::string_view::npos) return found;
    comment.remove_prefix(open);
    const std::size_t close = comment.find(comment.front() == '(' ? ')' : ']');
    if (close == std::string_view::npos) return found;
    found.push_back(trimmed(comment.substr(1, close - 1)));
    comment.remove_prefix(close);
  }
}

bool isLetter(char c) { return (c >= 'a' && c <= 'z') || (c & 0x80) != 0; }

/// Words of letters, digits left out: "u-x" gives u and x.
std::vector<std::string> wordsOf(std::string_view comment) {
  std::vector<std::string> found(1);
  for (const char c : lowered(comment)) {
    if (isLetter(c)) {
      found.back() += c;
    } else if (!found.back().empty()) {
      found.emplace_back();
    }
  }
  if (found.back().empty()) found.pop_back();
  return found;
}

bool namesAxes(const std::vector<std::string>& words) {
  return std::all_of(kAxisLetters.begin(), kAxisLetters.end(),
                     [&](const char* axis) { return std::find(words.begin(), words.end(), axis) != words.end(); });
}

/// Labels of uncertainties: U-x U-y U-z U-mag, whatever stands between the letters.
int uncertaintiesNamed(std::string_view comment) {
  int count = 0;
  const std::vector<std::string> words = wordsOf(comment);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool apart =
        words[i] == "u" && i + 1 < words.size() &&
        (words[i + 1] == "x" || words[i + 1] == "y" || words[i + 1] == "z" || words[i + 1].starts_with("mag"));
    const bool together = words[i] == "ux" || words[i] == "uy" || words[i] == "uz" || words[i].starts_with("umag");
    count += apart || together ? 1 : 0;
  }
  return count;
}

/// x, y or z in a comment, as a coordinate or behind U as its uncertainty.
struct AxisLabel {
  int axis = 0;
  std::size_t word = 0;  ///< which one of the comment's, but for those of units
  bool capital = false, negative = false, uncertainty = false;
};

std::vector<AxisLabel> axisLabels(std::string_view comment) {
  const auto isWordAt = [&](std::size_t i) { return isLetter(lowered(comment.substr(i, 1)).front()); };
  std::vector<AxisLabel> labels;
  std::string before;
  std::size_t words = 0;
  for (std::size_t at = 0; at < comment.size();) {
    if (const char open = comment[at]; open == '(' || open == '[') {
      const std::size_t close = comment.find(open == '(' ? ')' : ']', at);
      at = close == std::string_view::npos ? comment.size() : close + 1;
      continue;
    }
    if (!isWordAt(at)) {
      ++at;
      continue;
    }
    const std::size_t from = at;
    while (at < comment.size() && isWordAt(at)) ++at;
    const std::string word = lowered(comment.substr(from, at - from));
    if (metresIn(word)) continue;
    const bool together = word.size() == 2 && word.front() == 'u';
    const std::string letter = together ? word.substr(1) : word;
    const auto axis = std::find(kAxisLetters.begin(), kAxisLetters.end(), letter);
    if (axis != kAxisLetters.end()) {
      AxisLabel label{static_cast<int>(axis - kAxisLetters.begin()), words};
      label.capital = comment[from] >= 'A' && comment[from] <= 'Z';
      label.uncertainty = together || before == "u";
      // Of "Points - X, Y, Z" and "Achse-X" the stroke is no sign.
      label.negative = from > 0 && comment[from - 1] == '-' &&
                       (from == 1 || std::string_view(" \t,;").find(comment[from - 2]) != std::string_view::npos);
      labels.push_back(label);
    }
    before = word;
    ++words;
  }
  return labels;
}

/// In which order labels name all three axes; nullopt where one lacks. `listed`: they follow one another with nothing
/// but units between them, and no fourth follows.
std::optional<AxisOrder> orderOf(const std::vector<AxisLabel>& labels, bool& listed) {
  AxisOrder order{};
  std::size_t found = 0;
  for (const AxisLabel& label : labels) {
    const auto end = order.begin() + static_cast<std::ptrdiff_t>(found);
    if (found < order.size() && std::find(order.begin(), end, label.axis) == end) order[found++] = label.axis;
  }
  if (found < order.size()) return std::nullopt;
  listed = labels[2].word == labels[0].word + 2 &&
           std::equal(order.begin(), order.end(), labels.begin(),
                      [](int axis, const AxisLabel& label) { return axis == label.axis; }) &&
           (labels.size() == order.size() || labels[3].word > labels[2].word + 1);
  return order;
}

/// The number that ends where `end` is; NaN where there is none.
double numberBefore(std::string_view text, std::size_t end) {
  while (end > 0 && text[end - 1] == ' ') --end;
  std::size_t from = end;
  while (from > 0 && (std::string_view("0123456789.,").find(text[from - 1]) != std::string_view::npos)) --from;
  std::string_view digits = text.substr(from, end - from);
  while (digits.starts_with(',') || digits.starts_with('.')) digits.remove_prefix(1);
  return decimalOrNan(digits, digits.find(',') != std::string_view::npos ? DecimalSign::comma : DecimalSign::point);
}

bool isOneOf(const std::string& word, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// Parts of the words for uncertainty, coverage and confidence: English, German, Romance languages, Dutch, Swedish,
/// Norwegian, Polish, Czech, Turkish, Japanese, Chinese, Korean.
constexpr std::array kCoverageWords{"uncertain",
                                    "coverage",
                                    "confiden",
                                    "unsicher",
                                    "vertrauen",
                                    "konfiden",
                                    "berdeckung",
                                    "erweiterungsfaktor",
                                    "incert",
                                    "couverture",
                                    "confian",
                                    "cobertura",
                                    "copertura",
                                    "fiducia",
                                    "onzeker",
                                    "betrouwba",
                                    "os\xC3\xA4ker",
                                    "usikker",
                                    "niepewno",
                                    "ufno\xC5\x9B",
                                    "nejist",
                                    "belirsiz",
                                    "\xE4\xB8\x8D\xE7\xA2\xBA",
                                    "\xE4\xBF\xA1\xE9\xA0\xBC",
                                    "\xE4\xB8\x8D\xE7\xA1\xAE\xE5\xAE\x9A",
                                    "\xE7\xBD\xAE\xE4\xBF\xA1",
                                    "\xEB\xB6\x88\xED\x99\x95",
                                    "\xEC\x8B\xA0\xEB\xA2\xB0"};

/// Whether a comment in small letters is about uncertainties, their coverage or confidence: by these words, by the
/// labels of the columns, or as it says nothing else than a level. A share of something else, of humidity, says nothing
/// of uncertainties.
bool isAboutCoverage(const std::string& small) {
  const std::vector<std::string> words = wordsOf(small);
  if (namesAxes(words) || uncertaintiesNamed(small) > 0) return true;
  const bool level = std::all_of(words.begin(), words.end(), [](const std::string& word) {
    return isOneOf(word, {"sigma", "\xCF\x83", "k", "level", "interval", "range", "niveau", "bereich", "intervalle",
                          "nivel", "intervalo", "livello", "intervallo"});
  });
  return level || std::any_of(kCoverageWords.begin(), kCoverageWords.end(),
                              [&](const char* part) { return small.find(part) != std::string::npos; });
}

/// The coverage factor that a comment states: "2 sigma", or a level of confidence, of which 95 % is k = 2 as the Guide
/// has it. 0: it states none, or is about something else.
double coverageIn(std::string_view comment) {
  const std::string small = lowered(comment);
  if (!isAboutCoverage(small)) return 0.0;
  const std::size_t sigma = std::min(small.find("sigm"), small.find("\xCF\x83"));
  if (sigma != std::string::npos) {
    const double factor = numberBefore(small, sigma);
    if (factor > 0.0 && factor <= 5.0) return factor;
  }
  const std::size_t percent = small.find('%');
  // Of two shares it is not known which is the level.
  if (percent == std::string::npos || small.find('%', percent + 1) != std::string::npos) return 0.0;
  const double level = numberBefore(small, percent);
  struct Level {
    double percent, factor;
  };
  constexpr std::array<Level, 3> kLevels{{{68.0, 1.0}, {95.0, 2.0}, {99.7, 3.0}}};
  for (const Level& known : kLevels) {
    if (std::abs(level - known.percent) < 0.6) return known.factor;
  }
  return 0.0;
}

/// Coverage beside the columns that it is of, "U-mag (95%)" or "U-mag [mm] (2 sigma)", and no unit.
bool isLevel(const std::string& small) {
  const bool level = small.find('%') != std::string::npos || small.find("sigm") != std::string::npos ||
                     small.find("\xCF\x83") != std::string::npos;
  const std::vector<std::string> words = wordsOf(small);
  return level &&
         std::none_of(words.begin(), words.end(), [](const std::string& word) { return metresIn(word).has_value(); });
}

/// Words of a unit, of which deg and C are no angle.
bool isAngleUnit(const std::string& small) {
  const std::vector<std::string> words = wordsOf(small);
  const bool temperature = std::any_of(words.begin(), words.end(), [](const std::string& word) {
    return isOneOf(word, {"c", "f", "degc", "degf", "\xC2\xB0\x63", "\xC2\xB0\x66", "celsius", "fahrenheit"});
  });
  return !temperature && std::any_of(words.begin(), words.end(), [](const std::string& word) {
    return word.starts_with("d\xC3\xA9g") || word.starts_with("radian") ||
           isOneOf(word, {"deg", "degs", "degree", "degrees", "rad", "grad", "grads", "grades", "gradi", "grados",
                          "graus", "graden", "gon", "\xC2\xB0", "\xE5\xBA\xA6"});
  });
}

/// Whether a comment names the axes of points, Cartesian or not: two coordinates, or a length beside an angle.
bool isAboutAxes(const std::vector<std::string>& words, const std::vector<std::string_view>& units) {
  const auto coordinates = std::count_if(words.begin(), words.end(), [](const std::string& word) {
    return isOneOf(word, {"x",     "y",    "z",         "r",        "h",        "v",    "d",       "rho",
                          "theta", "phi",  "\xCE\xB8",  "\xCF\x86", "\xCF\x81", "az",   "azimuth", "azimut",
                          "el",    "elev", "elevation", "zenith",   "hz",       "dist", "distance"});
  });
  if (coordinates >= 2) return true;
  return std::any_of(units.begin(), units.end(), [](std::string_view unit) {
    const std::vector<std::string> parts = wordsOf(unit);
    return std::any_of(parts.begin(), parts.end(), [](const std::string& part) { return metresIn(part).has_value(); });
  });
}

/// Takes the order in which a comment lists the axes of points and of their uncertainties. `of_columns`: it says units
/// or uncertainties, and is of the columns; another one may speak of axes in any order.
void readAxisOrder(const FileText& text, const TextLine& line, std::string_view comment, bool of_columns,
                   ExportComments& header) {
  std::vector<AxisLabel> coordinates = axisLabels(comment), uncertainties;
  std::copy_if(coordinates.begin(), coordinates.end(), std::back_inserter(uncertainties),
               [](const AxisLabel& label) { return label.uncertainty; });
  std::erase_if(coordinates, [](const AxisLabel& label) { return label.uncertainty; });
  // Small letters are words of some languages: y in Spanish, z in Polish.
  std::vector<AxisLabel> capitals = coordinates;
  std::erase_if(capitals, [](const AxisLabel& label) { return !label.capital; });
  bool listed = false, uncertainties_listed = false;
  std::optional<AxisOrder> order = orderOf(capitals, listed);
  if (order)
    coordinates = capitals;
  else
    order = orderOf(coordinates, listed);
  if (const auto own = orderOf(uncertainties, uncertainties_listed)) header.uncertainty_axes = own;
  if (!order) return;
  const bool negative =
      std::any_of(coordinates.begin(), coordinates.end(), [](const AxisLabel& l) { return l.negative; });
  if ((of_columns || listed) && negative)
    throw io::InputError({text.file, line.number, ""}, std::string(comment),
                         "expected the axes without a sign: export x, y, z");
  if (!listed) {
    if (of_columns && *order != kUsualOrder)
      throw io::InputError({text.file, line.number, ""}, std::string(comment),
                           "expected the axes in the order of their columns, as X, Y, Z: export x, y, z, or name the "
                           "columns (format columns)");
    return;
  }
  if (header.axes && *header.axes != *order)
    throw io::InputError({text.file, line.number, ""}, std::string(comment),
                         "expected the axes in one order; those above are in another");
  header.axes = order;
}

void readExportComment(const FileText& text, const TextLine& line, std::string_view comment, ExportComments& header) {
  const std::string frame = frameIn(comment);
  const double coverage = coverageIn(comment);
  // Exports are appended to each other: what the second says must be what the first did.
  if (!frame.empty() && !header.frame.empty() && frame != header.frame)
    throw io::InputError({text.file, line.number, "frame"}, frame,
                         fmt::format("expected points in one frame; those above are in {}", header.frame));
  if (coverage > 0.0 && header.coverage > 0.0 && coverage != header.coverage)
    throw io::InputError(
        {text.file, line.number, "coverage"}, fmt::format("k = {:g}", coverage),
        fmt::format("expected uncertainties of one coverage; those above have k = {:g}", header.coverage));
  if (header.frame.empty()) header.frame = frame;
  if (header.coverage == 0.0) header.coverage = coverage;
  const std::vector<std::string> words = wordsOf(comment);
  const bool axes = namesAxes(words);
  // Short names (in, m) are words of many languages; of the long ones none is.
  constexpr std::size_t kLongName = 4;
  for (const std::string& word : words) {
    if (word.size() >= kLongName && metresIn(word)) header.unit_word = word;
  }
  if (axes)
    header.uncertainties = uncertaintiesNamed(comment);
  else if (header.uncertainties)
    *header.uncertainties += uncertaintiesNamed(comment);
  const std::vector<std::string_view> units = bracketed(comment);
  const bool about_axes = isAboutAxes(words, units);
  readAxisOrder(text, line, comment, !units.empty() || uncertaintiesNamed(comment) > 0, header);
  for (const std::string_view unit : units) {
    const std::string small = lowered(unit);
    if (about_axes && isAngleUnit(small)) {
      throw io::InputError({text.file, line.number, ""}, std::string(comment),
                           "expected Cartesian axes; these have an angle: export x, y, z");
    }
    if (!axes) continue;
    // Several of one axis comment: "X (mm), Y (mm), Z (mm)".
    const std::optional<double> metres = metresIn(small.substr(0, small.find_first_of(",; ")));
    if (!metres && isLevel(small)) continue;
    if (!metres) {
      throw io::InputError({text.file, line.number, "unit"}, std::string(unit),
                           "expected mm, m or inch in the comment of the axes");
    }
    if (header.unit && *header.unit != *metres)
      throw io::InputError({text.file, line.number, "unit"}, std::string(unit), "expected one unit for all axes");
    header.unit = metres;
  }
}

}  // namespace

ExportComments exportCommentsOf(const FileText& text) {
  ExportComments header;
  for (const TextLine& line : linesOf(text.text)) {
    const std::string_view content = trimmed(line.text);
    if (content.starts_with(kExportComment))
      readExportComment(text, line, plainMarks(trimmed(content.substr(kExportComment.size()))), header);
  }
  return header;
}

double statedUnitOf(const FileText& text, const ExportComments& header, std::vector<std::string>& warnings) {
  const std::string& stated = text.options.unit;
  if (!header.unit) {
    if (stated.empty() && !header.unit_word.empty())
      throw io::InputError({text.file, 0, "unit"}, header.unit_word,
                           "expected the unit in the comment of the axes, as X, Y, Z (mm); this one stands elsewhere: "
                           "state the unit (option unit)");
    return unitOrMillimetres(text.file, stated, warnings);
  }
  if (!stated.empty() && metresIn(stated) != header.unit)
    throw io::InputError({text.file, 0, "unit"}, stated,
                         "expected no unit, or that of the file's comments, which state another");
  return *header.unit;
}

}  // namespace stiffscope::interchange
