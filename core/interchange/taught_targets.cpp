#include <fmt/format.h>
#include <algorithm>
#include <string>
#include <utility>

#include "core/interchange/program_text.h"
#include "core/io/input_error.h"
#include "core/io/units.h"

// FANUC's programs: all targets stand in a section of their own.

namespace stiffscope::interchange {

namespace {

/// Where a section starts, in a text in small letters: its name is the first of a line, while a comment may have the
/// same letters anywhere. npos where there is none.
std::size_t sectionIn(const std::string& small, std::string_view name) {
  for (std::size_t at = small.find(name); at != std::string::npos; at = small.find(name, at + 1)) {
    const std::size_t before = small.find_last_not_of(" \t", at == 0 ? 0 : at - 1), behind = at + name.size();
    const bool starts = at == 0 || before == std::string::npos || small[before] == '\n' || small[before] == '\r';
    if (starts && (behind == small.size() || !isWordCharacter(small[behind]))) return at;
  }
  return std::string::npos;
}

}  // namespace

bool looksLikeFanucProgram(std::string_view text) {
  const std::string small = lowered(text);
  return sectionIn(small, "/prog") != std::string::npos && sectionIn(small, "/pos") != std::string::npos;
}

RobotLog readFanucProgram(const LogText& text) {
  const std::string small = lowered(text.text);
  const std::size_t section = sectionIn(small, "/pos");
  if (section == std::string::npos) throw io::InputError({text.file, 0, ""}, "", "expected a section /POS");
  FoundTargets found(text, LogFormat::fanuc_tp);
  ProgramText program(text.file, text.text, section + 4);
  while (!program.atEnd()) {
    const std::string_view start = program.next();
    if (start == "/") return found.log();  // /END
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
      found.skip(sample.line);
    } else if (joints != wanted || beyond) {
      throw io::InputError(
          {text.file, sample.line, ""}, sample.name,
          fmt::format("expected all {} joints of group 1, or a target in space{}", countedJoints(text.options.joints),
                      beyond ? "; this one has more joints than the machine" : ""));
    } else {
      found.add(std::move(sample), places);
    }
  }
  throw io::InputError({text.file, program.line(), ""}, "", "expected /END; the file ends before it");
}

}  // namespace stiffscope::interchange
