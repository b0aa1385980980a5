#include "render/vtk/canvas.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vtkBrush.h>
#include <vtkContext2D.h>
#include <vtkFreeTypeTools.h>
#include <vtkPen.h>
#include <vtkTextProperty.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

// The text of the canvas: measured, with subscripts, cut and wrapped.

namespace stiffscope::render {

void Canvas::setStyle(double size, bool bold, Colour colour, Direction direction) const {
  vtkTextProperty* style = context_.GetTextProp();
  style->SetFontFamily(VTK_FONT_FILE);
  style->SetFontFile((bold ? fonts_.bold : fonts_.regular).c_str());
  int pixels = std::max(1, static_cast<int>(std::lround(size * surface_.scale)));
  if (pixels == 16) pixels = 17;  // VTK 9.1 draws the top row of text of 16 pixels below it
  style->SetFontSize(pixels);
  style->SetColor(colour.red / 255.0, colour.green / 255.0, colour.blue / 255.0);
  style->SetJustificationToLeft();
  style->SetVerticalJustificationToBottom();
  style->SetOrientation(direction == Direction::up ? 90 : 0);
}

double Canvas::runWidth(const std::string& run, double size, bool bold) const {
  const auto [place, is_new] = widths_.try_emplace({run, size, bold}, 0.0);
  if (is_new) {
    setStyle(size, bold, colours::kInk, Direction::across);
    std::array<float, 4> bounds{};
    context_.ComputeStringBounds(run.c_str(), bounds.data());
    place->second = bounds[2] / surface_.scale;
  }
  return place->second;
}

namespace {

constexpr double kSubscriptSize = 0.72;
constexpr double kSubscriptDrop = 0.28;

struct Run {
  std::string text;
  bool subscript = false;
};

constexpr char kVerbatim = '\x1b';

/// Appends the runs of a text whose `_{` mean subscripts.
void addRich(const std::string& text, std::vector<Run>& runs) {
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t open = text.find("_{", at);
    const std::size_t close = open == std::string::npos ? open : text.find('}', open);
    if (close == std::string::npos) {
      runs.push_back({text.substr(at)});
      break;
    }
    if (open > at) runs.push_back({text.substr(at, open - at)});
    if (close > open + 2) runs.push_back({text.substr(open + 2, close - open - 2), true});
    at = close + 1;
  }
}

std::vector<Run> runsOf(const std::string& text) {
  std::vector<Run> runs;
  bool verbatim = false;
  for (std::size_t at = 0; at <= text.size(); verbatim = !verbatim) {
    const std::size_t end = std::min(text.find(kVerbatim, at), text.size());
    if (verbatim && end > at) runs.push_back({text.substr(at, end - at)});
    if (!verbatim) addRich(text.substr(at, end - at), runs);
    at = end + 1;
  }
  // A line break would begin a second line where there is no room for it.
  for (Run& run : runs) {
    std::replace_if(
        run.text.begin(), run.text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; }, ' ');
  }
  return runs;
}

/// A verbatim stretch that goes on beyond the end of its line is ended there and begun again in the next.
void mendStretches(std::vector<std::string>& lines) {
  bool open = false;
  for (std::string& line : lines) {
    if (open) line.insert(line.begin(), kVerbatim);
    open = std::count(line.begin(), line.end(), kVerbatim) % 2 != 0;
    if (open) line += kVerbatim;
  }
}

}  // namespace

Spot Canvas::measure(const std::string& text, const TextStyle& style) const {
  double width = 0;
  for (const Run& run : runsOf(text)) {
    width += runWidth(run.text, style.size * (run.subscript ? kSubscriptSize : 1), style.bold);
  }
  return {width, 1.2 * style.size};
}

void Canvas::text(const std::string& text, Spot anchor, AlignX x, AlignY y, const TextStyle& style,
                  Direction direction) {
  finish();  // what is under the text
  const bool up = direction == Direction::up;
  const Spot extent = measure(text, style);
  const double width = up ? extent.y : extent.x;
  const double height = up ? extent.x : extent.y;
  const double left = anchor.x - (x == AlignX::left ? 0 : x == AlignX::centre ? width / 2 : width);
  const double top = anchor.y - (y == AlignY::top ? 0 : y == AlignY::centre ? height / 2 : height);

  double along = 0;
  for (const Run& run : runsOf(text)) {
    const double size = style.size * (run.subscript ? kSubscriptSize : 1);
    const double drop = run.subscript ? kSubscriptDrop * style.size : 0;
    const double run_width = runWidth(run.text, size, style.bold);
    setStyle(size, style.bold, style.colour, direction);
    // VTK's text box is as high as the font; its lower edge is the descenders'. Keep one base line.
    const double descent = 0.22 * style.size;
    const double below = up ? left + width - descent - 0.02 * style.size + 0.24 * size + drop
                            : top + height - descent - 0.02 * style.size + 0.24 * size + drop;
    const double at_x = up ? below : left + along;
    const double at_y = up ? top + height - along : below;
    context_.DrawString(static_cast<float>(std::round(at_x * surface_.scale)),
                        static_cast<float>(std::round((surface_.size.height - at_y) * surface_.scale)),
                        run.text.c_str());
    along += run_width;
  }
}

std::string Canvas::shortened(const std::string& text, double width, const TextStyle& style) const {
  // No text of interest is longer, and measuring takes time in proportion to the length.
  constexpr std::size_t kLongest = 1000;
  if (text.size() <= kLongest && measure(text, style).x <= width) return text;
  std::vector<std::size_t> ends;  // where a whole UTF-8 character begins: there the text may be cut
  for (std::size_t at = 1; at < std::min(text.size(), kLongest); ++at) {
    if ((static_cast<unsigned char>(text[at]) & 0xC0) != 0x80) ends.push_back(at);
  }
  const auto cut = [&text](std::size_t end) { return text.substr(0, end) + "\u2026"; };
  const auto first_too_long = std::partition_point(
      ends.begin(), ends.end(), [&](std::size_t end) { return measure(cut(end), style).x <= width; });
  return first_too_long == ends.begin() ? "" : cut(*std::prev(first_too_long));
}

std::vector<std::string> Canvas::wrapped(const std::string& text, double width, const TextStyle& style) const {
  std::vector<std::string> lines;
  std::string line;
  std::size_t at = 0;
  constexpr std::size_t kMostLines = 20;  // no picture has room for more
  while (at < text.size() && lines.size() < kMostLines) {
    const std::size_t space = std::min(text.find(' ', at), text.size());
    const std::string word = shortened(text.substr(at, space - at), width, style);
    const std::string longer = line.empty() ? word : line + " " + word;
    if (!line.empty() && measure(longer, style).x > width) {
      lines.push_back(shortened(line, width, style));
      line = word;
    } else {
      line = longer;
    }
    at = space + 1;
  }
  if (!line.empty()) lines.push_back(shortened(line, width, style));
  mendStretches(lines);
  return lines;
}

namespace {

std::vector<std::string> foldersToSearch() {
  if (const char* chosen = std::getenv("STIFFSCOPE_FONTS"); chosen != nullptr && *chosen != '\0') return {chosen};
  return {
#ifdef STIFFSCOPE_FONT_DIR
      STIFFSCOPE_FONT_DIR,
#endif
      "/usr/share/fonts/truetype/dejavu", "/usr/share/fonts/dejavu", "/usr/share/fonts/dejavu-sans-fonts",
      "/usr/share/fonts/TTF"};
}

}  // namespace

Fonts findFonts() {
  const std::vector<std::string> folders = foldersToSearch();
  for (const std::filesystem::path folder : folders) {
    std::error_code ignored;
    const auto regular = folder / "DejaVuSans.ttf";
    const auto bold = folder / "DejaVuSans-Bold.ttf";
    if (std::filesystem::exists(regular, ignored) && std::filesystem::exists(bold, ignored)) {
      return {regular.string(), bold.string()};
    }
  }
  throw std::runtime_error(
      fmt::format("cannot draw pictures: no DejaVuSans.ttf and DejaVuSans-Bold.ttf in {} (Debian package "
                  "fonts-dejavu-core; STIFFSCOPE_FONTS names another folder)",
                  fmt::join(folders, ", ")));
}

namespace {

/// FreeType 2.12 begins to count the bytes of its cache of glyphs anywhere (its `cur_weight`): where it takes it for
/// full, it renders each letter anew each time. No cache is full of as many as these, and no picture has many letters.
void keepGlyphs() {
  static const bool kept = [] {
    vtkFreeTypeTools::GetInstance()->SetMaximumNumberOfBytes(std::numeric_limits<unsigned long>::max());
    return true;
  }();
  static_cast<void>(kept);
}

}  // namespace

Canvas::Canvas(vtkContext2D& context, const Surface& surface, Fonts fonts)
    : context_(context),
      surface_(surface),
      fonts_(std::move(fonts)),
      unit_(surface.size.letters *
            std::clamp(std::min(surface.size.width / 1200.0, surface.size.height / 700.0), 0.7, 4.0)) {
  keepGlyphs();
  context_.GetPen()->SetLineType(vtkPen::NO_PEN);
}

Box Canvas::all() const {
  return {0, 0, static_cast<double>(surface_.size.width), static_cast<double>(surface_.size.height)};
}

double Canvas::snapped(double x) { return std::round(x * kSupersampling) / kSupersampling; }

// VTK draws a polygon at a time, each with its own upload and state: a chart with a thousand lines took a tenth of a
// second. As one strip of quadrilaterals that join at points of no area, all of a colour are drawn at once.
void Canvas::polygon(const std::vector<Spot>& corners, Colour colour) {
  if (corners.size() < 3) return;
  if (!(colour == strip_colour_)) finish();
  strip_colour_ = colour;
  const auto add = [&](const Spot& corner) {
    strip_.push_back(static_cast<float>(corner.x * surface_.scale));
    strip_.push_back(static_cast<float>((surface_.size.height - corner.y) * surface_.scale));
  };
  const auto join = [&](const Spot& corner) {
    add(corner);
    add(corner);
  };
  join(corners.front());
  for (std::size_t i = 1; i < corners.size(); ++i) {
    add(corners.front());
    add(corners[i]);
  }
  join(corners.back());
}

void Canvas::finish() {
  if (strip_.empty()) return;
  context_.GetBrush()->SetColor(strip_colour_.red, strip_colour_.green, strip_colour_.blue, 255);
  context_.DrawQuadStrip(strip_.data(), static_cast<int>(strip_.size() / 2));
  strip_.clear();
}

void Canvas::fill(const Box& box, Colour colour) {
  polygon({{box.left, box.top}, {box.right, box.top}, {box.right, box.bottom}, {box.left, box.bottom}}, colour);
}

void Canvas::outline(const Box& box, Colour colour, double width) {
  const double w = width;
  fill({box.left, box.top, box.right, box.top + w}, colour);
  fill({box.left, box.bottom - w, box.right, box.bottom}, colour);
  fill({box.left, box.top, box.left + w, box.bottom}, colour);
  fill({box.right - w, box.top, box.right, box.bottom}, colour);
}

// VTK's own wide lines depend on the driver; a rectangle does not.
void Canvas::line(Spot from, Spot to, Colour colour, double width, double dash) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  if (!(length > 0)) return;
  const Spot along{(to.x - from.x) / length, (to.y - from.y) / length};
  const Spot across{-along.y * width / 2, along.x * width / 2};
  const double piece = dash > 0 ? dash : length;
  for (double s = 0; s<length; s += dash> 0 ? 1.7 * dash : length) {
    const double e = std::min(s + piece, length);
    const Spot a{from.x + along.x * s, from.y + along.y * s};
    const Spot b{from.x + along.x * e, from.y + along.y * e};
    polygon({{a.x + across.x, a.y + across.y},
             {b.x + across.x, b.y + across.y},
             {b.x - across.x, b.y - across.y},
             {a.x - across.x, a.y - across.y}},
            colour);
  }
}

void Canvas::disc(Spot centre, double radius, Colour colour) {
  constexpr int kCorners = 32;
  std::vector<Spot> corners;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * M_PI * i / kCorners;
    corners.push_back({centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)});
  }
  polygon(corners, colour);
}

void Canvas::mark(Spot at, const std::string& series, const std::string& category, double value, double category_at,
                  const std::string& quantity) {
  if (!std::isfinite(at.x) || !std::isfinite(at.y)) return;
  marks_.push_back(
      {at.x / surface_.size.width, at.y / surface_.size.height, series, category, value, category_at, quantity});
}

}  // namespace stiffscope::render
