#include "render/window/x_window.h"

#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>

#include <set>

// Last: Xlib defines words like None and Status.
#include <X11/Xatom.h>
#include <X11/Xlib.h>

namespace stiffscope {

namespace {

Display* displayOf(vtkRenderWindow& window) { return static_cast<Display*>(window.GetGenericDisplayId()); }

// Takes nothing from the queue: it never says yes, it only looks.
Bool lookForInput(Display*, XEvent* event, XPointer found) {
  if (event->type == KeyPress || event->type == MotionNotify) *reinterpret_cast<bool*>(found) = true;
  return False;
}

}  // namespace

void nameWindow(vtkRenderWindow& window, const std::string& name) {
  window.SetWindowName(name.c_str());
  // What VTK sets is Latin-1 for most window managers.
  Display* display = displayOf(window);
  const auto id = reinterpret_cast<Window>(window.GetGenericWindowId());
  if (display == nullptr || id == 0) return;
  XChangeProperty(display, id, XInternAtom(display, "_NET_WM_NAME", False),
                  XInternAtom(display, "UTF8_STRING", False), 8, PropModeReplace,
                  reinterpret_cast<const unsigned char*>(name.data()), static_cast<int>(name.size()));
  XFlush(display);
}

bool inputWaits(vtkRenderWindow& window) {
  Display* display = displayOf(window);
  if (display == nullptr || XPending(display) == 0) return false;
  bool found = false;
  XEvent event;
  XCheckIfEvent(display, &event, lookForInput, reinterpret_cast<XPointer>(&found));
  return found;
}

std::string keyName(vtkRenderWindowInteractor& interactor) {
  const char* symbol = interactor.GetKeySym();
  const std::string name = symbol == nullptr ? "" : symbol;
  const std::set<std::string> silent{"Left", "Right", "Up", "Down", "Tab"};
  return interactor.GetShiftKey() != 0 && silent.count(name) != 0 ? "Shift+" + name : name;
}

}  // namespace stiffscope
