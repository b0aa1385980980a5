#pragma once

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "render/colours.h"
#include "render/image.h"

class vtkContext2D;

namespace stiffscope::render {

/// The font files of all pictures: DejaVu Sans, which has Greek letters and subscript digits.
struct Fonts {
  std::string regular;
  std::string bold;
};

/// Looks in the folder that the environment variable STIFFSCOPE_FONTS names and nowhere else, or else in the
/// one found when this was built, then in those where Linux distributions put DejaVu. Throws
/// std::runtime_error that names the folders looked in.
Fonts findFonts();

/// How many rendered pixels a pixel of an offscreen picture is averaged from, in each direction: its
/// antialiasing.
inline constexpr int kSupersampling = 2;

/// What a canvas paints on.
struct Surface {
  Size size;                      ///< of the picture
  double scale = kSupersampling;  ///< rendered pixels to one of the picture, in each direction
  Palette palette = kLightPalette;
};

/// A place on the picture: pixels from the left and from the top.
struct Spot {
  double x = 0;
  double y = 0;
};

/// An upright rectangle on the picture; top < bottom.
struct Box {
  double left = 0;
  double top = 0;
  double right = 0;
  double bottom = 0;

  double width() const { return right - left; }
  double height() const { return bottom - top; }
  double middleX() const { return (left + right) / 2; }
  double middleY() const { return (top + bottom) / 2; }
  bool overlaps(const Box& other) const {
    return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
  }
};

enum class AlignX { left, centre, right };
enum class AlignY { top, centre, bottom };
enum class Direction { across, up };

struct TextStyle {
  double size = 14;  ///< of the font, pixels
  bool bold = false;
  Colour colour = colours::kInk;
};

/// Draws on the picture through VTK's 2-D context, in pixels of the finished picture; text measures what it
/// will take. In every text `x_{abc}` sets abc as a subscript; what stands between two escape characters (0x1B) is
/// taken to the letter: the names of a campaign are not ours. Colours are opaque.
class Canvas {
 public:
  Canvas(vtkContext2D& context, const Surface& surface, Fonts fonts);

  Box all() const;
  /// 1 at 1200 x 700; every length that is not given by the data is multiplied by it.
  double unit() const { return unit_; }
  const Palette& palette() const { return surface_.palette; }
  /// To the nearest rendered pixel of an offscreen picture, so that edges are sharp.
  static double snapped(double x);

  void fill(const Box& box, Colour colour);
  void outline(const Box& box, Colour colour, double width);
  /// Straight from one spot to the other; dashes of `dash` pixels when that is positive.
  void line(Spot from, Spot to, Colour colour, double width, double dash = 0);
  /// Convex, or seen whole from its first corner.
  void polygon(const std::vector<Spot>& corners, Colour colour);
  void disc(Spot centre, double radius, Colour colour);

  /// Width and height of `text` written across; the height depends on the style only.
  Spot measure(const std::string& text, const TextStyle& style) const;
  /// `text` placed with the named side or centre at `anchor`. Direction::up runs from bottom to top.
  void text(const std::string& text, Spot anchor, AlignX x, AlignY y, const TextStyle& style,
            Direction direction = Direction::across);
  /// `text` cut with an ellipsis, if need be, to be no wider than `width`.
  std::string shortened(const std::string& text, double width, const TextStyle& style) const;
  /// `text` broken between words into lines no wider than `width`; a single longer word is cut.
  std::vector<std::string> wrapped(const std::string& text, double width, const TextStyle& style) const;

  /// Notes that a value stands there; draws nothing. Spots that are not finite are left out.
  void mark(Spot at, const std::string& series, const std::string& category, double value, double category_at = 0,
            const std::string& quantity = "");
  std::vector<Mark> takeMarks() { return std::move(marks_); }
  /// Draws what has been asked for and is not drawn yet: at the end of a painting.
  void finish();

 private:
  void setStyle(double size, bool bold, Colour colour, Direction direction) const;
  double runWidth(const std::string& run, double size, bool bold) const;

  vtkContext2D& context_;
  Surface surface_;
  Fonts fonts_;
  double unit_;
  std::vector<Mark> marks_;
  std::vector<float> strip_;  ///< x, y of polygons of one colour that are not drawn yet
  Colour strip_colour_;
  mutable std::map<std::tuple<std::string, double, bool>, double> widths_;  ///< of runs measured so far
};

}  // namespace stiffscope::render
