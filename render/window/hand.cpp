#include "render/window/hand.h"

#include <vtkCommand.h>

#include <cmath>

namespace stiffscope {

namespace {

constexpr double kWheelStep = 1.15;
constexpr double kStill = 4;  // pixels that a click may move

}  // namespace

Hand::Motion Hand::release(Kind of, Spot pointer) {
  if (drag_ != of) return {};
  drag_ = Kind::Nothing;
  if (of == Kind::Turn && !moved_) return {Kind::Click, pointer.x, pointer.y};
  return {};
}

Hand::Motion Hand::take(unsigned long event, Spot pointer) {
  switch (event) {
    case vtkCommand::LeftButtonPressEvent:
    case vtkCommand::MiddleButtonPressEvent:
    case vtkCommand::RightButtonPressEvent:
      drag_ = event == vtkCommand::LeftButtonPressEvent ? Kind::Turn : Kind::Shift;
      pressed_ = last_ = pointer;
      moved_ = false;
      return {};
    case vtkCommand::LeftButtonReleaseEvent:
      return release(Kind::Turn, pointer);
    case vtkCommand::MiddleButtonReleaseEvent:
    case vtkCommand::RightButtonReleaseEvent:
      return release(Kind::Shift, pointer);
    case vtkCommand::MouseWheelForwardEvent:
      return {Kind::Zoom, 0, kWheelStep};
    case vtkCommand::MouseWheelBackwardEvent:
      return {Kind::Zoom, 0, 1 / kWheelStep};
    case vtkCommand::MouseMoveEvent: {
      if (drag_ == Kind::Nothing) return {};
      moved_ = moved_ || std::hypot(pointer.x - pressed_.x, pointer.y - pressed_.y) > kStill;
      if (!moved_) return {};
      const Motion motion{drag_, pointer.x - last_.x, pointer.y - last_.y};
      last_ = pointer;
      return motion;
    }
    default:
      return {};
  }
}

}  // namespace stiffscope
