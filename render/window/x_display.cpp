#include "render/window/x_display.h"

#include <GL/glx.h>
#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <fmt/format.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <array>
#include <cstdlib>
#include <memory>
#include <set>
#include <string>

#include "render/arm_window.h"

// Last: Xlib defines words like None and Status.

// Last: Xlib defines words like None and Status.

namespace stiffscope::render {

namespace {

// Also of glXCreateContextAttribsARB's errors, which X reports by this handler and else by ending the
// process.
int ignoreError(Display*, XErrorEvent*) { return 0; }

using CreateContext = GLXContext (*)(Display*, GLXFBConfig, GLXContext, Bool, const int*);

bool hasCoreContext(Display* display) {
  const std::array<int, 9> wanted{
      GLX_X_RENDERABLE, True, GLX_DRAWABLE_TYPE, GLX_WINDOW_BIT, GLX_DOUBLEBUFFER, True, GLX_RED_SIZE, 8, None};
  int count = 0;
  const std::unique_ptr<GLXFBConfig, int (*)(void*)> configs(
      glXChooseFBConfig(display, DefaultScreen(display), wanted.data(), &count), XFree);
  const auto create = reinterpret_cast<CreateContext>(
      glXGetProcAddressARB(reinterpret_cast<const GLubyte*>("glXCreateContextAttribsARB")));
  if (!configs || count == 0 || create == nullptr) return false;
  const std::array<int, 7> attributes{
      GLX_CONTEXT_MAJOR_VERSION_ARB,    3,   GLX_CONTEXT_MINOR_VERSION_ARB, 2, GLX_CONTEXT_PROFILE_MASK_ARB,
      GLX_CONTEXT_CORE_PROFILE_BIT_ARB, None};
  const auto before = XSetErrorHandler(ignoreError);
  const GLXContext context = create(display, configs.get()[0], nullptr, True, attributes.data());
  XSync(display, False);
  XSetErrorHandler(before);
  if (context != nullptr) glXDestroyContext(display, context);
  return context != nullptr;
}

}  // namespace

void requireDisplay() {
  const char* set = std::getenv("DISPLAY");
  const std::string name = set == nullptr ? "" : set;
  const std::unique_ptr<Display, int (*)(Display*)> display(XOpenDisplay(nullptr), XCloseDisplay);
  if (!display) {
    throw NoDisplay(name.empty() ? "no display to open a window on: DISPLAY is not set"
                                 : fmt::format("no display to open a window on: DISPLAY '{}' does not answer", name));
  }
  if (!glXQueryExtension(display.get(), nullptr, nullptr)) {
    throw NoDisplay(fmt::format("the display '{}' has no OpenGL (no GLX)", name));
  }
  if (!hasCoreContext(display.get())) {
    throw NoDisplay(fmt::format("the display '{}' has no OpenGL 3.2 core context", name));
  }
}

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
  XChangeProperty(display, id, XInternAtom(display, "_NET_WM_NAME", False), XInternAtom(display, "UTF8_STRING", False),
                  8, PropModeReplace, reinterpret_cast<const unsigned char*>(name.data()),
                  static_cast<int>(name.size()));
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

}  // namespace stiffscope::render
