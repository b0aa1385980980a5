#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/interchange/program_text.h"
#include "core/io/input_error.h"
#include "core/io/units.h"

// ABB's modules, and Rokae's: targets that are declared with a value, one by one or as an array, that a variable is
// given, and that stand in an instruction.

namespace stiffscope::interchange {

bool looksLikeRapid(const LogText& text) {
  const std::string small = lowered(text.text);
  return findWord(small, "jointtarget", 0) != std::string::npos ||
         (text.options.in_instructions && findWord(small, "moveabsj", 0) != std::string::npos);
}

namespace {

constexpr int kRobotAxes = 6;

/// Whether numbers follow, as many, and then the bracket that closes them.
bool takesNumbers(ProgramText& program, int count) {
  for (int i = 0; i < count; ++i) {
    if (i > 0 && !program.take(",")) return false;
    if (std::isnan(decimalOrNan(program.next(), DecimalSign::point))) return false;
  }
  return program.take("]");
}

/// Whether [[q1,...,q6],[e1,...,e6]] starts here, which is a jointtarget, or a table of two rows. External axes may be
/// a variable.
bool isJointtarget(ProgramText program) {
  if (!program.take("[") || !program.take("[") || !takesNumbers(program, kRobotAxes) || !program.take(","))
    return false;
  const std::string_view external = program.next();
  if (external.empty() || (external == "[" && !takesNumbers(program, kRobotAxes))) return false;
  return (external == "[" || isWordCharacter(external.front())) && program.take("]");
}

/// Whether a variable, or a function, stands here.
bool isName(ProgramText program) {
  const std::string_view token = program.next();
  return !token.empty() && isWordCharacter(token.front()) && std::isnan(decimalOrNan(token, DecimalSign::point));
}

/// Whether one of the angles that follow is computed: a variable, a sum.
bool isComputed(ProgramText program) {
  for (int i = 0; i < kRobotAxes; ++i) {
    const std::string_view token = program.next();
    if (token.empty()) return false;
    if (std::isnan(decimalOrNan(token, DecimalSign::point)))
      return token == "(" || token == "-" || token == "+" || isWordCharacter(token.back());
    const std::string_view behind = program.next();
    if (behind.empty() || behind == "]") return false;
    if (behind != ",") return true;
  }
  return false;
}

class RapidTargets {
 public:
  explicit RapidTargets(const LogText& text)
      : text_(text),
        code_(codeOf(text.text, '!')),
        small_(lowered(code_)),
        program_(text.file, code_),
        found_(text, LogFormat::rapid) {}

  RobotLog read() {
    WordsInOrder words(small_, {"jointtarget", "robtarget", "moveabsj", "movej", "movel", "movec", "robax", "j", "["});
    for (auto found = words.next(0); found.at != std::string::npos; found = words.next(program_.place())) {
      program_.goTo(found.at);
      if (found.word == "[") {
        readValue(found.at);
        continue;
      }
      program_.next();
      if (found.word == "jointtarget") {
        readDeclaration();
      } else if (found.word == "robtarget") {
        found_.skip(program_.line());
      } else if (found.word == "robax") {
        readComponent(found.at);
      } else if (found.word == "j") {
        readOfRokae();
      } else {
        readMotion(found.word);
      }
    }
    return found_.log();
  }

 private:
  /// A jointtarget, perhaps with its value: ABB's [[q1,...,q6],[...]], Rokae's j:{q1,...,q6,...}{EJ ...}; of an array a
  /// list of such.
  void readDeclaration() {
    JointSample sample(text_.options.joints);
    sample.line = program_.line();
    sample.name = program_.next();
    const std::size_t dimensions = readDimensions();
    declared_[lowered(sample.name)] = dimensions;
    program_.take(":");
    if (!program_.take("=")) return;  // a parameter, or declared without a value
    if (program_.peek() == "[") return readTargets({sample.name, false}, sample.line, dimensions);
    const std::size_t behind = program_.place();
    if (!program_.take("j") || !program_.take(":")) return program_.returnTo(behind);  // what another one has
    program_.require("{", "behind j:");
    readAngles(std::move(sample), false);
  }

  /// Of an array {2} or {2,3}; 0 of a variable.
  std::size_t readDimensions() {
    if (!program_.take("{")) return 0;
    constexpr std::size_t kMost = 3;
    std::size_t dimensions = 1;
    for (std::string_view token = program_.next(); token != "}"; token = program_.next()) {
      if (token.empty()) program_.refuse(token, "expected '}' behind the size of an array");
      dimensions += token == "," ? 1 : 0;
      if (dimensions > kMost) program_.refuse(token, "expected an array of at most three dimensions");
    }
    return dimensions;
  }

  /// A value anywhere else, in front of its bracket. A variable that was declared here as a jointtarget is given one.
  void readValue(std::size_t bracket) {
    const GivenName given = givenName(code_, bracket, '{', '}');
    const std::size_t line = program_.line();
    const bool angles = given.type != "num" && given.type != "dnum";
    const bool jointtarget = isJointtarget(program_);
    program_.next();
    const auto own = declared_.find(given.variable);
    // Another variable of that name may have numbers.
    const bool target = own != declared_.end() && (program_.peek() == "[" || isName(program_));
    if (angles && target && !given.component) {
      program_.returnTo(bracket);
      return readTargets({given.whole, true}, line, lowered(given.whole) == given.variable ? own->second : 0);
    }
    // In a call, in a structure, or of a variable that is declared elsewhere: what it is for is not known here.
    if (angles && jointtarget) found_.skip(line, Skip::joints_computed);
    if (!angles || jointtarget) program_.close(1, '[', ']');
  }

  /// NAME.robax.rax_1:=..., by which a program computes a target.
  void readComponent(std::size_t word) {
    const std::size_t line = program_.line();
    if (word == 0 || code_[word - 1] != '.') return;
    if (program_.take(":") && program_.take("=")) found_.skip(line, Skip::joints_computed);
  }

  /// A target of Rokae's that is not declared: j:{...}.
  void readOfRokae() {
    const std::size_t line = program_.line();
    if (program_.take(":") && program_.take("{")) found_.skip(line, Skip::joints_computed);
  }

  /// A target that stands in the instruction, called by its line: MoveAbsJ [[q1,...],[...]], or of the others one in
  /// space. Switches may stand in front of it: MoveAbsJ \Conc, [[...
  void readMotion(std::string_view word) {
    const std::size_t line = program_.line();
    while (program_.take("\\")) {
      program_.next();
      program_.take(",");
    }
    if (program_.peek() != "[") return;
    if (word == "moveabsj" && text_.options.in_instructions)
      return readTargets({fmt::format("line {}", line), false}, line, 0);
    found_.skip(line, word == "moveabsj" ? Skip::in_instruction : Skip::joints_not_given);
    program_.next();
    program_.close(1, '[', ']');
  }

  /// What the targets of a value are called, and whether an instruction gives it.
  struct Called {
    std::string name;
    bool given = false;
  };

  /// A value, in front of its bracket. Of an array those in it are called NAME{1}, or NAME{1,2}.
  void readTargets(const Called& called, std::size_t line, std::size_t dimensions,
                   const std::vector<std::size_t>& place = {}) {
    if (!place.empty() && isName(program_)) {
      // An element that another variable has.
      found_.skip(line, Skip::joints_computed);
      while (program_.peek() != "," && program_.peek() != "]" && !program_.atEnd()) program_.next();
      return;
    }
    program_.require("[", dimensions > 0 ? "before the elements of an array" : "before six angles");
    if (dimensions > 0) {
      std::vector<std::size_t> element = place;
      element.push_back(0);
      do {
        ++element.back();
        program_.atEnd();  // the blanks in front of it
        readTargets(called, program_.line(), dimensions - 1, element);
      } while (program_.take(","));
      return program_.require("]", "behind the last element of an array");
    }
    if (isName(program_)) {
      found_.skip(line, Skip::joints_computed);
      return program_.close(1, '[', ']');
    }
    program_.require("[", "before six angles");
    if (isComputed(program_)) {
      found_.skip(line, Skip::joints_computed);
      return program_.close(2, '[', ']');
    }
    requireSixJoints(text_, line, "the robot axes of a jointtarget");
    JointSample sample(kRobotAxes);
    sample.line = line;
    sample.name = place.empty() ? called.name : fmt::format("{}{{{}}}", called.name, fmt::join(place, ","));
    readAngles(std::move(sample), called.given);
    program_.close(2, '[', ']');
  }

  /// The angles behind '[[', or of Rokae behind 'j:{', as many as the sample has.
  void readAngles(JointSample&& sample, bool given) {
    PerJoint<TextSpan> places(static_cast<std::size_t>(sample.figures.size()));
    for (int j = 0; j < sample.figures.size(); ++j) {
      if (j > 0) program_.require(",", "between angles");
      sample.figures[j] = program_.number("a joint's angle") * io::kDegree;
      places[static_cast<std::size_t>(j)] = program_.numberPlace();
    }
    if (sample.figures.size() != kRobotAxes && program_.peek() == ",")
      program_.refuse(program_.next(),
                      fmt::format("expected {} angles", countedJoints(static_cast<int>(sample.figures.size()))));
    found_.add(std::move(sample), places, given);
  }

  const LogText& text_;
  const std::string code_, small_;
  ProgramText program_;
  FoundTargets found_;
  std::map<std::string, std::size_t> declared_;  ///< dimensions of variables that are jointtargets, in small letters
};

}  // namespace

RobotLog readRapid(const LogText& text) { return RapidTargets(text).read(); }

}  // namespace stiffscope::interchange
