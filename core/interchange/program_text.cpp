#include "core/interchange/program_text.h"

#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <utility>

#include "core/io/input_error.h"
#include "core/io/xml.h"

namespace stiffscope::interchange {

bool isWordCharacter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '$';
}

bool ProgramText::atEnd() {
  skipBlanks();
  return at_ >= text_.size();
}

std::size_t ProgramText::line() const {
  line_ += io::lineOf(text_.substr(counted_, at_ - counted_), std::string_view::npos) - 1;
  counted_ = at_;
  return line_;
}

std::string_view ProgramText::next() {
  skipBlanks();
  const std::size_t from = at_;
  if (at_ >= text_.size()) return {};
  const auto part = [&](char c) { return isWordCharacter(c) || c == '.'; };
  const bool sign = (text_[at_] == '-' || text_[at_] == '+') && at_ + 1 < text_.size() && part(text_[at_ + 1]);
  if (!sign && !part(text_[at_])) return text_.substr(at_++, 1);
  at_ += sign ? 1 : 0;
  while (at_ < text_.size() && (part(text_[at_]) || isExponentSign(from))) ++at_;
  return text_.substr(from, at_ - from);
}

std::string_view ProgramText::peek() {
  const std::size_t behind = at_;
  const std::string_view token = next();
  at_ = behind;
  return token;
}

bool ProgramText::take(std::string_view wanted) {
  const std::size_t behind = at_;
  if (lowered(next()) == wanted) return true;
  at_ = behind;
  return false;
}

void ProgramText::close(std::size_t depth, char open, char closing) {
  while (depth > 0) {
    const std::string_view token = next();
    if (token.empty()) refuse(token, fmt::format("expected '{}' at the end of this target", closing));
    if (token.size() != 1) continue;
    depth += token[0] == open ? 1 : 0;
    depth -= token[0] == closing ? 1 : 0;
  }
}

void ProgramText::require(std::string_view wanted, const char* where) {
  const std::string_view found = next();
  if (lowered(found) != lowered(wanted)) refuse(found, fmt::format("expected '{}' {}", wanted, where));
}

double ProgramText::number(const char* what) {
  const std::string_view found = next();
  const double value = decimalOrNan(found, DecimalSign::point);
  if (std::isnan(value)) refuse(found, fmt::format("expected a number, {}", what));
  number_ = {at_ - found.size(), found.size()};
  return value;
}

void ProgramText::refuse(std::string_view found, const std::string& expectation) const {
  throw io::InputError({file_, line(), ""}, std::string(found),
                       expectation + (at_ >= text_.size() ? "; the file ends here" : ""));
}

void ProgramText::skipBlanks() {
  while (at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos) ++at_;
}

/// The sign in 1.5E-3.
bool ProgramText::isExponentSign(std::size_t from) const {
  const char c = text_[at_], before = text_[at_ - 1];
  return (c == '-' || c == '+') && at_ > from && (before == 'e' || before == 'E') &&
         std::isdigit(static_cast<unsigned char>(
             text_[from == at_ ? from : from + (text_[from] == '-' || text_[from] == '+')])) != 0;
}

std::size_t findWord(const std::string& small, std::string_view word, std::size_t from) {
  const bool mark = !isWordCharacter(word.front());
  while (true) {
    const std::size_t at = small.find(word, from);
    if (at == std::string::npos || mark) return at;
    const bool starts = at == 0 || !isWordCharacter(small[at - 1]);
    const bool ends = at + word.size() >= small.size() || !isWordCharacter(small[at + word.size()]);
    if (starts && ends) return at;
    from = at + 1;
  }
}

WordsInOrder::WordsInOrder(const std::string& small, const std::vector<std::string_view>& words) : small_(small) {
  for (const std::string_view word : words) places_.push_back({word, findWord(small, word, 0)});
}

WordsInOrder::Found WordsInOrder::next(std::size_t from) {
  Found first;
  for (Found& one : places_) {
    if (one.at != std::string::npos && one.at < from) one.at = findWord(small_, one.word, from);
    if (one.at < first.at) first = one;
  }
  return first;
}

namespace {

/// A text from behind, within its line.
class Backwards {
 public:
  Backwards(std::string_view text, std::size_t end) : text_(text), end_(end) { skipBlanks(); }

  char last() const { return end_ > 0 ? text_[end_ - 1] : '\0'; }
  void drop() {
    --end_;
    skipBlanks();
  }
  std::string_view word() {
    const std::size_t behind = end_;
    while (end_ > 0 && isWordCharacter(text_[end_ - 1])) --end_;
    const std::string_view found = text_.substr(end_, behind - end_);
    skipBlanks();
    return found;
  }
  /// From an opening bracket to the closing one that is last; empty where it opens in another line, or farther off than
  /// an index is long.
  std::string_view bracketed(char open) {
    constexpr std::size_t kLongest = 100;
    const std::size_t least = end_ - std::min(end_, kLongest);
    const std::size_t place = text_.substr(least, end_ - least).find_last_of(std::string("\r\n") + open);
    const std::size_t from = least + place;
    if (place == std::string_view::npos || text_[from] != open) return {};
    const std::string_view found = text_.substr(from, end_ - from);
    end_ = from;
    skipBlanks();
    return found;
  }

 private:
  void skipBlanks() {
    while (end_ > 0 && (text_[end_ - 1] == ' ' || text_[end_ - 1] == '\t')) --end_;
  }

  std::string_view text_;
  std::size_t end_;
};

}  // namespace

GivenName givenName(std::string_view code, std::size_t place, char open, char closing) {
  Backwards before(code, place);
  if (before.last() != '=') return {};
  before.drop();
  if (before.last() == ':') before.drop();
  const std::string_view index = before.last() == closing ? before.bracketed(open) : std::string_view();
  const std::string_view name = before.word();
  if (name.empty()) return {};
  GivenName given{std::string(name), lowered(name), "", before.last() == '.'};
  std::copy_if(index.begin(), index.end(), std::back_inserter(given.whole),
               [](char c) { return c != ' ' && c != '\t'; });
  given.type = lowered(before.word());
  return given;
}

std::string codeOf(std::string_view text, char mark) {
  std::string code(text);
  bool comment = false, quoted = false;
  for (char& c : code) {
    if (c == '\n' || c == '\r') {
      comment = quoted = false;
      continue;
    }
    if (c == '"' && !comment) {
      quoted = !quoted;
      continue;
    }
    comment = comment || (c == mark && !quoted);
    if (comment || quoted) c = ' ';
  }
  return code;
}

void requireSixJoints(const LogText& text, std::size_t line, const char* stated) {
  if (text.options.joints == 6) return;
  throw io::InputError(
      {text.file, line, "format"}, "",
      fmt::format("expected joints of a machine that has {}, state them as columns; {} are those of a machine of six",
                  countedJoints(text.options.joints), stated));
}

void FoundTargets::add(JointSample&& sample, const PerJoint<TextSpan>& places, bool given) {
  if (given) given_.push_back(log_.samples.size());
  log_.samples.push_back(std::move(sample));
  log_.places.push_back(places);
}

void FoundTargets::skip(std::size_t line, Skip reason) {
  if (log_.skipped.empty() || log_.skipped.back().line != line) log_.skipped.push_back({line, reason});
}

RobotLog FoundTargets::log() {
  std::map<std::string, std::size_t> lines;
  auto given = given_.begin();
  for (std::size_t i = 0; i < log_.samples.size(); ++i) {
    JointSample& sample = log_.samples[i];
    const bool by_instruction = given != given_.end() && *given == i;
    given += by_instruction ? 1 : 0;
    if (by_instruction && text_.options.in_instructions && lines.contains(lowered(sample.name)))
      sample.name = fmt::format("line {}", sample.line);
    const auto [first, added] = lines.emplace(lowered(sample.name), sample.line);
    if (!added)
      throw io::InputError({text_.file, sample.line, ""}, sample.name,
                           fmt::format("expected a target that does not repeat; line {} has it first", first->second));
  }
  return std::move(log_);
}

}  // namespace stiffscope::interchange
