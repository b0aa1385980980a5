#include "render/vtk/marks.h"

#include <algorithm>
#include <cmath>

namespace stiffscope {

Colour paler(Colour colour, double share, Colour paper) {
  const auto mix = [share](double channel, double ground) {
    return static_cast<std::uint8_t>(std::lround(ground + share * (channel - ground)));
  };
  return {mix(colour.red, paper.red), mix(colour.green, paper.green), mix(colour.blue, paper.blue)};
}

void drawDiamond(Canvas& canvas, Spot c, double radius, Colour colour) {
  const auto diamond = [c](double r) {
    return std::vector<Spot>{{c.x, c.y - r}, {c.x + r, c.y}, {c.x, c.y + r}, {c.x - r, c.y}};
  };
  canvas.polygon(diamond(radius + 2 * canvas.unit()), canvas.palette().paper);
  canvas.polygon(diamond(radius), colour);
}

void drawPoint(Canvas& canvas, Spot centre, double radius, Colour colour, bool hollow) {
  canvas.disc(centre, radius, colour);
  if (hollow) canvas.disc(centre, 0.6 * radius, canvas.palette().paper);
}

void drawArrowMark(Canvas& canvas, Spot tip, double size, Colour colour, bool upwards) {
  const double base = tip.y + (upwards ? size : -size);
  canvas.polygon({tip, {tip.x - 0.6 * size, base}, {tip.x + 0.6 * size, base}}, colour);
}

void drawWhisker(Canvas& canvas, double x, double from, double to, double cap, Colour colour, bool cap_from,
                 bool cap_to) {
  const double width = 1.5 * canvas.unit();
  canvas.line({x, from}, {x, to}, colour, width);
  if (cap_from) canvas.line({x - cap, from}, {x + cap, from}, colour, width);
  if (cap_to) canvas.line({x - cap, to}, {x + cap, to}, colour, width);
}

void drawArrow(Canvas& canvas, Spot from, Spot to, Colour colour, double width, double head) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  if (!(length > 0)) return;
  head = std::min(head, 0.6 * length);
  const Spot along{(to.x - from.x) / length, (to.y - from.y) / length};
  const Spot neck{to.x - head * along.x, to.y - head * along.y};
  const double half = 0.4 * head;
  canvas.line(from, neck, colour, width);
  canvas.polygon({to,
                  {neck.x - half * along.y, neck.y + half * along.x},
                  {neck.x + half * along.y, neck.y - half * along.x}},
                 colour);
}

void drawKey(Canvas& canvas, Key key, const Box& box, Colour colour) {
  const Spot centre{box.middleX(), box.middleY()};
  const double r = box.width() / 2;
  switch (key) {
    case Key::Square:
      canvas.fill({box.left + 0.1 * r, box.top + 0.3 * r, box.right - 0.1 * r, box.bottom - 0.3 * r}, colour);
      break;
    case Key::Point:
    case Key::HollowPoint:
      drawPoint(canvas, centre, 0.55 * r, colour, key == Key::HollowPoint);
      break;
    case Key::Dashes:
      canvas.line({box.left, centre.y}, {box.right, centre.y}, colour, 2 * canvas.unit(), 0.37 * box.width());
      break;
    case Key::Diamond:
      drawDiamond(canvas, centre, 0.55 * r, colour);
      break;
    case Key::Median:
      canvas.line({box.left, centre.y}, {box.right, centre.y}, colour, 3 * canvas.unit());
      break;
    case Key::ThickArrow:
    case Key::MediumArrow:
    case Key::ThinArrow:
      drawArrow(canvas, {box.left - 0.4 * r, centre.y}, {box.right + 0.4 * r, centre.y}, colour,
                (key == Key::ThickArrow ? 5 : key == Key::MediumArrow ? 3.5 : 2.5) * canvas.unit(), 1.2 * r);
      break;
  }
}

}  // namespace stiffscope
