#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "core/interchange/log_formats.h"
#include "core/io/input_error.h"
#include "core/io/units.h"
#include "core/io/xml.h"

// Programs of FANUC, KUKA and ABB name the postures that were taught. Letter case does not count in any of them.

namespace stiffscope::interchange {

namespace {

bool isWordCharacter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '$';
}

/// Goes through a program from token to token, and knows the line of each.
class ProgramText {
 public:
  ProgramText(const std::string& file, std::string_view text, std::size_t from = 0)
      : file_(file), text_(text), at_(from) {}

  bool atEnd() {
    skipBlanks();
    return at_ >= text_.size();
  }
  /// Counted on from where it was asked last: a program of 100 MB has a million targets.
  std::size_t line() const {
    line_ += io::lineOf(text_.substr(counted_, at_ - counted_), std::string_view::npos) - 1;
    counted_ = at_;
    return line_;
  }
  /// Goes on behind a place that was found by a search, never backwards.
  void goTo(std::size_t place) { at_ = std::max(at_, place); }
  std::size_t place() const { return at_; }
  /// To a place behind which nothing was asked for its line yet.
  void returnTo(std::size_t place) { at_ = place; }

  /// A word, a number with its sign and unit left out, or one other character.
  std::string_view next() {
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

  void require(std::string_view wanted, const char* where) {
    const std::string_view found = next();
    if (lowered(found) != lowered(wanted)) refuse(found, fmt::format("expected '{}' {}", wanted, where));
  }

  double number(const char* what) {
    const std::string_view found = next();
    const double value = decimalOrNan(found, DecimalSign::point);
    if (std::isnan(value)) refuse(found, fmt::format("expected a number, {}", what));
    number_ = {at_ - found.size(), found.size()};
    return value;
  }
  /// Where the number stands that was read last.
  const TextSpan& numberPlace() const { return number_; }

  [[noreturn]] void refuse(std::string_view found, const std::string& expectation) const {
    throw io::InputError({file_, line(), ""}, std::string(found),
                         expectation + (at_ >= text_.size() ? "; the file ends here" : ""));
  }

 private:
  void skipBlanks() {
    while (at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos) ++at_;
  }
  /// The sign in 1.5E-3.
  bool isExponentSign(std::size_t from) const {
    const char c = text_[at_], before = text_[at_ - 1];
    return (c == '-' || c == '+') && at_ > from && (before == 'e' || before == 'E') &&
           std::isdigit(static_cast<unsigned char>(
               text_[from == at_ ? from : from + (text_[from] == '-' || text_[from] == '+')])) != 0;
  }

  const std::string& file_;
  std::string_view text_;
  std::size_t at_;
  TextSpan number_;
  mutable std::size_t counted_ = 0, line_ = 1;
};

/// Place of a word of its own in a text in small letters, from `from` on; npos where there is none.
std::size_t findWord(const std::string& small, std::string_view word, std::size_t from) {
  while (true) {
    const std::size_t at = small.find(word, from);
    if (at == std::string::npos) return at;
    const bool starts = at == 0 || !isWordCharacter(small[at - 1]);
    const bool ends = at + word.size() >= small.size() || !isWordCharacter(small[at + word.size()]);
    if (starts && ends) return at;
    from = at + 1;
  }
}

/// The words of a list in the order in which they stand in a text in small letters.
class WordsInOrder {
 public:
  WordsInOrder(const std::string& small, std::vector<std::string_view> words) : small_(small) {
    for (const std::string_view word : words) places_.push_back({word, findWord(small, word, 0)});
  }

  struct Found {
    std::string_view word;
    std::size_t at = std::string::npos;  ///< npos: there is none
  };

  /// The next one that starts at `from` or behind it.
  Found next(std::size_t from) {
    Found first;
    for (Found& one : places_) {
      if (one.at != std::string::npos && one.at < from) one.at = findWord(small_, one.word, from);
      if (one.at < first.at) first = one;
    }
    return first;
  }

 private:
  const std::string& small_;
  std::vector<Found> places_;
};

/// Text behind `mark` in each line becomes blanks, so that no target is read out of a comment.
std::string withoutComments(std::string_view text, char mark) {
  std::string code(text);
  bool comment = false, quoted = false;
  for (char& c : code) {
    if (c == '\n' || c == '\r') comment = quoted = false;
    if (c == '"' && !comment) quoted = !quoted;
    comment = comment || (c == mark && !quoted);
    if (comment && c != '\n' && c != '\r') c = ' ';
  }
  return code;
}

/// KRL and RAPID state six axes and external ones; which joint of another machine each is they do not say.
void requireSixJoints(const LogText& text, std::size_t line, const char* stated) {
  if (text.options.joints == 6) return;
  throw io::InputError(
      {text.file, line, "format"}, "",
      fmt::format("expected joints of a machine that has {}, state them as columns; {} are those of a machine of six",
                  countedJoints(text.options.joints), stated));
}

void requireUniqueNames(const LogText& text, const RobotLog& log) {
  std::map<std::string, std::size_t> lines;
  for (const JointSample& sample : log.samples) {
    const auto [first, added] = lines.emplace(lowered(sample.name), sample.line);
    if (!added)
      throw io::InputError({text.file, sample.line, ""}, sample.name,
                           fmt::format("expected a target that does not repeat; line {} has it first", first->second));
  }
}

}  // namespace

bool looksLikeFanucProgram(std::string_view text) {
  const std::string small = lowered(text);
  return small.find("/prog") != std::string::npos && small.find("/pos") != std::string::npos;
}

RobotLog readFanucProgram(const LogText& text) {
  const std::string small = lowered(text.text);
  const std::size_t section = small.find("/pos");
  if (section == std::string::npos) throw io::InputError({text.file, 0, ""}, "", "expected a section /POS");
  RobotLog log;
  log.format = LogFormat::fanuc_tp;
  ProgramText program(text.file, text.text, section + 4);
  while (!program.atEnd()) {
    const std::string_view start = program.next();
    if (start == "/") return requireUniqueNames(text, log), log;  // /END
    if (lowered(start) != "p") program.refuse(start, "expected P[NUMBER]{ or /END");
    const auto wanted = static_cast<std::size_t>(text.options.joints);
    JointSample sample(text.options.joints);
    sample.line = program.line();
    program.require("[", "behind P");
    sample.name = fmt::format("P[{}]", program.next());
    // P[3:"home"] has a comment in it.
    for (std::string_view token = program.next(); token != "{"; token = program.next()) {
      if (token.empty()) program.refuse(token, "expected '{' behind P[NUMBER]");
    }
    PerJoint<bool> given(wanted, false);
    PerJoint<TextSpan> places(wanted);
    bool beyond = false;  // a joint that the machine has not
    int group = 1;
    for (std::string_view token = program.next(); token != "}"; token = program.next()) {
      if (token.empty()) program.refuse(token, "expected '}' at the end of this target");
      const std::string word = lowered(token);
      if (word.size() == 3 && word.starts_with("gp")) group = word[2] - '0';
      if (group != 1 || word.size() != 2 || word[0] != 'j' || word[1] < '1' || word[1] > '9') continue;
      const auto joint = static_cast<std::size_t>(word[1] - '1');
      beyond = beyond || joint >= wanted;
      if (joint >= wanted) continue;
      program.require("=", "behind a joint");
      sample.figures[static_cast<Eigen::Index>(joint)] = program.number("a joint's angle") * io::kDegree;
      places[joint] = program.numberPlace();
      if (lowered(program.next()) != "deg") program.refuse("", "expected deg behind a joint's angle");
      given[joint] = true;
    }
    program.require(";", "behind a target");
    const auto joints = static_cast<std::size_t>(std::count(given.begin(), given.end(), true));
    if (joints == 0 && !beyond) {
      log.skipped.push_back({sample.line, Skip::joints_not_given});
    } else if (joints != wanted || beyond) {
      throw io::InputError(
          {text.file, sample.line, ""}, sample.name,
          fmt::format("expected all {} joints of group 1, or a target in space{}", countedJoints(text.options.joints),
                      beyond ? "; this one has more joints than the machine" : ""));
    } else {
      log.samples.push_back(std::move(sample));
      log.places.push_back(places);
    }
  }
  throw io::InputError({text.file, program.line(), ""}, "", "expected /END; the file ends before it");
}

bool looksLikeKukaData(const LogText& text) {
  const std::string small = lowered(text.text);
  const auto has = [&](std::string_view word) { return findWord(small, word, 0) != std::string::npos; };
  return has("defdat") || (has("decl") && (has("axis") || has("e6axis"))) ||
         (text.options.in_instructions && has("def") && (has("ptp") || has("sptp")));
}

namespace {

/// What stands in the braces of a KRL aggregate, behind '{'.
struct KrlAggregate {
  JointVector figures = JointVector::Zero(6);  ///< rad
  PerJoint<TextSpan> places = PerJoint<TextSpan>(6);
  std::array<bool, 6> given{};
  bool in_space = false;  ///< X, Y, Z, A, B, C

  bool whole() const { return std::count(given.begin(), given.end(), true) == 6; }
};

/// `space_too`: a target in space is no error.
KrlAggregate readKrlAggregate(ProgramText& program, bool space_too) {
  KrlAggregate found;
  for (std::string_view token = program.next(); token != "}"; token = program.next()) {
    if (token.empty()) program.refuse(token, "expected '}' at the end of this target");
    if (token == ",") continue;
    const std::string word = lowered(token);
    if (word == ":") continue;
    const bool axis = word.size() == 2 && word[0] == 'a' && word[1] >= '1' && word[1] <= '6';
    const bool external = word.size() == 2 && word[0] == 'e' && word[1] >= '1' && word[1] <= '6';
    if (word == "axis" || word == "e6axis") continue;  // {E6AXIS: A1 ...}
    if (space_too && !axis && !external) {
      found.in_space = true;
      continue;
    }
    if (!axis && !external) program.refuse(token, "expected A1 to A6 or E1 to E6");
    const double value = program.number("an axis's angle");
    if (!axis) continue;
    const auto joint = static_cast<std::size_t>(word[1] - '1');
    found.given[joint] = true;
    found.places[joint] = program.numberPlace();
    found.figures[word[1] - '1'] = value * io::kDegree;
  }
  return found;
}

/// A target that is declared: DECL AXIS NAME={A1 ...}.
void readKrlDeclaration(const LogText& text, ProgramText& program, RobotLog& log) {
  std::string type = lowered(program.next());
  if (type == "global" || type == "const") type = lowered(program.next());
  JointSample sample(6);
  sample.line = program.line();
  if (type == "e6pos" || type == "pos" || type == "frame") log.skipped.push_back({sample.line, Skip::joints_not_given});
  if (type != "axis" && type != "e6axis") return;
  sample.name = program.next();
  if (program.next() != "=") return;  // declared without a value
  program.require("{", "behind the name of a target");
  requireSixJoints(text, sample.line, "A1 to A6");
  const KrlAggregate found = readKrlAggregate(program, false);
  if (!found.whole()) throw io::InputError({text.file, sample.line, ""}, sample.name, "expected A1 to A6");
  sample.figures = found.figures;
  log.samples.push_back(std::move(sample));
  log.places.push_back(found.places);
}

/// A target that stands in the instruction, PTP {A1 ...}, called by its line. One that gives some axes alone leaves the
/// others where they are, so that its posture is not known here.
void readKrlMotion(const LogText& text, ProgramText& program, RobotLog& log) {
  JointSample sample(6);
  sample.line = program.line();
  const std::size_t behind = program.place();
  if (program.next() != "{") {
    program.returnTo(behind);
    return;
  }
  const KrlAggregate found = readKrlAggregate(program, true);
  if (found.in_space || !found.whole()) {
    log.skipped.push_back({sample.line, Skip::joints_not_given});
    return;
  }
  requireSixJoints(text, sample.line, "A1 to A6");
  sample.name = fmt::format("line {}", sample.line);
  sample.figures = found.figures;
  log.samples.push_back(std::move(sample));
  log.places.push_back(found.places);
}

}  // namespace

RobotLog readKukaData(const LogText& text) {
  const std::string code = withoutComments(text.text, ';'), small = lowered(code);
  RobotLog log;
  log.format = LogFormat::kuka_krl;
  ProgramText program(text.file, code);
  std::vector<std::string_view> starts{"decl"};
  if (text.options.in_instructions) starts.insert(starts.end(), {"ptp", "sptp", "lin", "slin", "circ", "scirc", "spl"});
  WordsInOrder words(small, starts);
  for (auto found = words.next(0); found.at != std::string::npos; found = words.next(program.place())) {
    program.goTo(found.at);
    program.next();
    if (found.word == "decl") {
      readKrlDeclaration(text, program, log);
    } else {
      readKrlMotion(text, program, log);
    }
  }
  requireUniqueNames(text, log);
  return log;
}

bool looksLikeRapid(const LogText& text) {
  const std::string small = lowered(text.text);
  return findWord(small, "jointtarget", 0) != std::string::npos ||
         (text.options.in_instructions && findWord(small, "moveabsj", 0) != std::string::npos);
}

namespace {

/// The angles behind '[[', or of Rokae behind 'j:{', as many as the sample has.
void readAngles(ProgramText& program, JointSample& sample, RobotLog& log) {
  PerJoint<TextSpan> places(static_cast<std::size_t>(sample.figures.size()));
  for (int j = 0; j < sample.figures.size(); ++j) {
    if (j > 0) program.require(",", "between angles");
    sample.figures[j] = program.number("a joint's angle") * io::kDegree;
    places[static_cast<std::size_t>(j)] = program.numberPlace();
  }
  if (sample.figures.size() != 6) {
    const std::size_t behind = program.place();
    if (const std::string_view more = program.next(); more == ",")
      program.refuse(more, fmt::format("expected {} angles", countedJoints(static_cast<int>(sample.figures.size()))));
    program.returnTo(behind);
  }
  log.samples.push_back(std::move(sample));
  log.places.push_back(places);
}

/// A jointtarget with its value: ABB's [[q1,...,q6],[...]], Rokae's j:{q1,...,q6,...}{EJ ...}.
void readRapidDeclaration(const LogText& text, ProgramText& program, RobotLog& log) {
  JointSample sample(text.options.joints);
  sample.line = program.line();
  sample.name = program.next();
  std::string_view token = program.next();
  if (token == ":") token = program.next();
  if (token != "=") return;  // a parameter, or declared without a value
  token = program.next();
  if (lowered(token) == "j") {
    program.require(":", "behind j");
    program.require("{", "behind j:");
  } else {
    if (token != "[") program.refuse(token, "expected [[q1, ..., q6], [...]]");
    requireSixJoints(text, sample.line, "the robot axes of a jointtarget");
    program.require("[", "before six angles");
  }
  readAngles(program, sample, log);
}

/// A target that stands in the instruction, called by its line: MoveAbsJ [[q1,...],[...]], or of the others one in
/// space.
void readRapidMotion(const LogText& text, std::string_view word, ProgramText& program, RobotLog& log) {
  JointSample sample(text.options.joints);
  sample.line = program.line();
  const std::size_t behind = program.place();
  if (program.next() != "[") {
    program.returnTo(behind);
    return;
  }
  if (word != "moveabsj") {
    log.skipped.push_back({sample.line, Skip::joints_not_given});
    return;
  }
  requireSixJoints(text, sample.line, "the robot axes of a jointtarget");
  program.require("[", "before six angles");
  sample.name = fmt::format("line {}", sample.line);
  readAngles(program, sample, log);
}

}  // namespace

RobotLog readRapid(const LogText& text) {
  const std::string code = withoutComments(text.text, '!'), small = lowered(code);
  RobotLog log;
  log.format = LogFormat::rapid;
  ProgramText program(text.file, code);
  std::vector<std::string_view> starts{"jointtarget", "robtarget"};
  if (text.options.in_instructions) starts.insert(starts.end(), {"moveabsj", "movej", "movel", "movec"});
  WordsInOrder words(small, starts);
  for (auto found = words.next(0); found.at != std::string::npos; found = words.next(program.place())) {
    program.goTo(found.at);
    program.next();
    if (found.word == "jointtarget") {
      readRapidDeclaration(text, program, log);
    } else if (found.word == "robtarget") {
      log.skipped.push_back({program.line(), Skip::joints_not_given});
    } else {
      readRapidMotion(text, found.word, program, log);
    }
  }
  requireUniqueNames(text, log);
  return log;
}

}  // namespace stiffscope::interchange
