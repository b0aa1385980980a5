#pragma once

#include <string>
#include <vector>

// Rich texts of the page and its pictures: `x_{abc}` sets abc as a subscript, a word between backticks is code,
// `@{Audit}` refers to the section that the contents call so; what asIs made stays to the letter.

namespace stiffscope::reports {

/// A stretch of a rich text and how it is set.
struct RichStretch {
  enum Kind { subscript = 0, code = 1, verbatim = 2, reference = 3, normal = 4 };
  std::string text;
  Kind kind = normal;
};

/// The stretches of a rich text in order. A mark without its end is text.
std::vector<RichStretch> richStretches(const std::string& rich_text);

/// A text of a campaign, to stand in a rich text to the letter, whatever is in it; pictures draw it so, too.
std::string asIs(const std::string& text);

/// A sentence of the program's own, without texts of a campaign in it, as a rich text: symbols that a terminal cannot
/// set get their subscripts (P_TCP, P_wrist, K_x, K_c, k1 to k8).
std::string withSubscripts(const std::string& sentence);

/// A rich text without its marks: for alt texts and places that cannot have a subscript.
std::string plain(const std::string& rich_text);

}  // namespace stiffscope::reports
