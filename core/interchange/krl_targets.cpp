#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/interchange/program_text.h"
#include "core/io/input_error.h"
#include "core/io/units.h"

// KUKA's programs: targets that are declared with a value, that a variable or an element of an array is given, and that
// stand in an instruction.

namespace stiffscope::interchange {

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
  bool branch = false;    ///< S, T: which of the joint angles that reach there, so that it is no frame

  bool whole() const { return std::count(given.begin(), given.end(), true) == 6; }
};

/// A1 to A6, or E1 to E6.
bool isKrlAxis(const std::string& word, char letter) {
  return word.size() == 2 && word[0] == letter && word[1] >= '1' && word[1] <= '6';
}

/// `space_too`: a target in space is no error.
KrlAggregate readKrlAggregate(ProgramText& program, bool space_too) {
  KrlAggregate found;
  for (std::string_view token = program.next(); token != "}"; token = program.next()) {
    if (token.empty()) program.refuse(token, "expected '}' at the end of this target");
    if (token == ",") continue;
    const std::string word = lowered(token);
    if (word == ":") continue;
    const bool axis = isKrlAxis(word, 'a'), external = isKrlAxis(word, 'e');
    if (word == "axis" || word == "e6axis") continue;  // {E6AXIS: A1 ...}
    if (space_too && !axis && !external) {
      found.in_space = true;
      found.branch = found.branch || word == "s" || word == "t" || word == "pos" || word == "e6pos";
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

class KrlTargets {
 public:
  explicit KrlTargets(const LogText& text)
      : text_(text),
        code_(codeOf(text.text, ';')),
        small_(lowered(code_)),
        program_(text.file, code_),
        found_(text, LogFormat::kuka_krl) {}

  RobotLog read() {
    // Of PTP {A1 ...} the word comes first, so that no other rule sees its brace.
    WordsInOrder words(small_, {"decl", "ptp", "sptp", "lin", "slin", "circ", "scirc", "spl", "{", "a1", "a2", "a3",
                                "a4", "a5", "a6"});
    for (auto found = words.next(0); found.at != std::string::npos; found = words.next(program_.place())) {
      program_.goTo(found.at);
      program_.next();
      if (found.word == "decl") {
        readDeclaration();
      } else if (found.word == "{") {
        readValue(found.at);
      } else if (isKrlAxis(std::string(found.word), 'a')) {
        readComponent(found.at);
      } else {
        readMotion();
      }
    }
    return found_.log();
  }

 private:
  /// A declaration, perhaps with a value: DECL AXIS NAME={A1 ...}.
  void readDeclaration() {
    std::string type = lowered(program_.next());
    while (type == "global" || type == "const") type = lowered(program_.next());
    JointSample sample(6);
    sample.line = program_.line();
    if (type == "e6pos" || type == "pos" || type == "frame") return found_.skip(sample.line);
    if (type != "axis" && type != "e6axis") return addOthers();
    sample.name = program_.next();
    if (!program_.take("=")) return;  // declared without a value
    program_.require("{", "behind the name of a target");
    requireSixJoints(text_, sample.line, "A1 to A6");
    const KrlAggregate value = readKrlAggregate(program_, false);
    if (!value.whole()) throw io::InputError({text_.file, sample.line, ""}, sample.name, "expected A1 to A6");
    sample.figures = value.figures;
    found_.add(std::move(sample), value.places);
  }

  /// Variables of a structure of one's own may have components A1 to A6, too, which are no angles.
  void addOthers() {
    do {
      if (program_.atEnd() || !isWordCharacter(program_.peek().front())) return;
      others_.insert(lowered(program_.next()));
      if (program_.take("[")) program_.close(1, '[', ']');
    } while (program_.take(","));
  }

  /// A value anywhere else: NAME={A1 ...} and NAME[1]={A1 ...} are targets, called so.
  void readValue(std::size_t brace) {
    const std::string first = lowered(program_.peek());
    const bool joints = first == "axis" || first == "e6axis" || isKrlAxis(first, 'a') || isKrlAxis(first, 'e');
    const bool space = first == "pos" || first == "e6pos" || first == "x";
    if (!joints && !space) return;
    const GivenName given = givenName(code_, brace, '[', ']');
    if (others_.contains(given.variable)) return;
    JointSample sample(6);
    sample.line = program_.line();
    const KrlAggregate value = readKrlAggregate(program_, true);
    if (value.in_space || !value.whole()) {
      const bool space = !joints || value.in_space;
      if (!space || value.branch) found_.skip(sample.line, space ? Skip::joints_not_given : Skip::joints_computed);
      return;
    }
    // In a call, in a structure or of PTP_REL: what it is used for is not known here.
    if (given.whole.empty() || given.component) return found_.skip(sample.line, Skip::joints_computed);
    requireSixJoints(text_, sample.line, "A1 to A6");
    sample.name = given.whole;
    sample.figures = value.figures;
    found_.add(std::move(sample), value.places, true);
  }

  /// NAME.A1=..., by which a program computes a target.
  void readComponent(std::size_t letter) {
    const std::size_t line = program_.line();
    if (letter == 0 || code_[letter - 1] != '.' || !program_.take("=")) return;
    if (program_.peek() != "=") found_.skip(line, Skip::joints_computed);
  }

  /// A target that stands in the instruction, PTP {A1 ...}, called by its line. One that gives some axes alone leaves
  /// the others where they are, so that its posture is not known here.
  void readMotion() {
    JointSample sample(6);
    sample.line = program_.line();
    if (!program_.take("{")) return;
    const KrlAggregate value = readKrlAggregate(program_, true);
    if (value.in_space) return found_.skip(sample.line, Skip::joints_not_given);
    if (!value.whole()) return found_.skip(sample.line, Skip::joints_computed);
    if (!text_.options.in_instructions) return found_.skip(sample.line, Skip::in_instruction);
    requireSixJoints(text_, sample.line, "A1 to A6");
    sample.name = fmt::format("line {}", sample.line);
    sample.figures = value.figures;
    found_.add(std::move(sample), value.places);
  }

  const LogText& text_;
  const std::string code_, small_;
  ProgramText program_;
  FoundTargets found_;
  std::set<std::string> others_;  ///< variables of other types, in small letters
};

}  // namespace

RobotLog readKukaData(const LogText& text) { return KrlTargets(text).read(); }

}  // namespace stiffscope::interchange
