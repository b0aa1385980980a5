#pragma once

#include "render/vtk/chart_frame.h"

namespace stiffscope {

/// The sign of a legend entry, in `box`.
void drawKey(Canvas& canvas, Key key, const Box& box, Colour colour);
/// A square on its corner, with a pale rim that sets it off from what lies under it.
void drawDiamond(Canvas& canvas, Spot centre, double radius, Colour colour);
/// A round point; hollow ones are filled with paper.
void drawPoint(Canvas& canvas, Spot centre, double radius, Colour colour, bool hollow);
/// A triangle whose tip is at `tip`, pointing up or down: the drawing goes on beyond the axis.
void drawArrowMark(Canvas& canvas, Spot tip, double size, Colour colour, bool upwards);
/// A line between two heights at `x`, with a cap at each end that is wanted.
void drawWhisker(Canvas& canvas, double x, double from, double to, double cap, Colour colour, bool cap_from,
                 bool cap_to);
/// An arrow as long as stated by its ends; its head takes at most `head` of it.
void drawArrow(Canvas& canvas, Spot from, Spot to, Colour colour, double width, double head);
/// Between the paper and `colour`, for the inside of boxes.
Colour paler(Colour colour, double share, Colour paper = colours::kPaper);

}  // namespace stiffscope
