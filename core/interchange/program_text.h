#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/interchange/joint_log.h"
#include "core/interchange/log_formats.h"

// How the programs of FANUC, KUKA and ABB are gone through. Letter case does not count in any of them.

namespace stiffscope::interchange {

bool isWordCharacter(char c);

/// Goes through a program from token to token, and knows the line of each.
class ProgramText {
 public:
  ProgramText(const std::string& file, std::string_view text, std::size_t from = 0)
      : file_(file), text_(text), at_(from) {}

  bool atEnd();
  /// Counted on from where it was asked last: a program of 100 MB has a million targets.
  std::size_t line() const;
  /// Goes on behind a place that was found by a search, never backwards.
  void goTo(std::size_t place) { at_ = place > at_ ? place : at_; }
  std::size_t place() const { return at_; }
  /// To a place behind which nothing was asked for its line yet.
  void returnTo(std::size_t place) { at_ = place; }

  /// A word, a number with its sign and unit left out, or one other character.
  std::string_view next();
  /// The same; the place stays.
  std::string_view peek();
  /// Goes behind the next token where it is `wanted`.
  bool take(std::string_view wanted);

  /// Goes behind the bracket that closes `depth` open ones.
  void close(std::size_t depth, char open, char closing);

  /// Throws InputError where the next token is another.
  void require(std::string_view wanted, const char* where);

  double number(const char* what);
  /// Where the number stands that was read last.
  const TextSpan& numberPlace() const { return number_; }

  [[noreturn]] void refuse(std::string_view found, const std::string& expectation) const;

 private:
  void skipBlanks();
  bool isExponentSign(std::size_t from) const;

  const std::string& file_;
  std::string_view text_;
  std::size_t at_;
  TextSpan number_;
  mutable std::size_t counted_ = 0, line_ = 1;
};

/// Place of a word of its own, or of a mark, in a text in small letters, from `from` on; npos where there is none.
std::size_t findWord(const std::string& small, std::string_view word, std::size_t from);

/// The words and marks of a list in the order in which they stand in a text in small letters.
class WordsInOrder {
 public:
  WordsInOrder(const std::string& small, const std::vector<std::string_view>& words);

  struct Found {
    std::string_view word;
    std::size_t at = std::string::npos;  ///< npos: there is none
  };

  /// The next one that starts at `from` or behind it.
  Found next(std::size_t from);

 private:
  const std::string& small_;
  std::vector<Found> places_;
};

/// What a value is given to: the name in front of `NAME{1} := ` or `NAME[1] = `.
struct GivenName {
  std::string whole;       ///< with its index, without blanks; empty: the value stands elsewhere
  std::string variable;    ///< without its index, in small letters
  std::string type;        ///< the word in front of it on its line, in small letters
  bool component = false;  ///< of a structure: A.B
};

/// What the value that starts at `place` is given to; `open` and `closing` are the brackets of an index.
GivenName givenName(std::string_view code, std::size_t place, char open, char closing);

/// Text behind `mark` in each line, and between quotes, becomes blanks, so that no target is read out of a comment.
std::string codeOf(std::string_view text, char mark);

/// KRL and RAPID state six axes and external ones; which joint of another machine each is they do not say.
void requireSixJoints(const LogText& text, std::size_t line, const char* stated);

/// The targets that were found so far. No two have a name in common: of a program that gives a variable several values
/// those behind the first are called by their line where each is replaced by itself.
class FoundTargets {
 public:
  FoundTargets(const LogText& text, LogFormat format) : text_(text) { log_.format = format; }

  /// `given`: by an instruction, not by the declaration.
  void add(JointSample&& sample, const PerJoint<TextSpan>& places, bool given = false);
  /// A target that is not read; a line is listed once.
  void skip(std::size_t line, Skip reason = Skip::joints_not_given);

  /// Throws InputError where two declarations have one name, or, where names tell targets apart, two of any kind.
  RobotLog log();

 private:
  const LogText& text_;
  RobotLog log_;
  std::vector<std::size_t> given_;
};

}  // namespace stiffscope::interchange
