#ifdef STIFFSCOPE_VIEW_BINARY

#include "tests/app/view_session.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <opencv2/imgproc.hpp>
#include <thread>

// Last: Xlib defines words like None and Status.
#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/extensions/XTest.h>

namespace stiffscope {

namespace {

using Clock = std::chrono::steady_clock;

void rest(int milliseconds) { std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds)); }

/// Ends a process and waits for it.
void end(pid_t process) {
  if (process <= 0) return;
  kill(process, SIGTERM);
  waitpid(process, nullptr, 0);
}

}  // namespace

VirtualDisplay::VirtualDisplay() {
  int tube[2];
  if (pipe(tube) != 0) return;
  server_ = fork();
  if (server_ == 0) {
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, 1);
    dup2(nowhere, 2);
    close(tube[0]);
    const std::string number = std::to_string(tube[1]);
    execlp("Xvfb", "Xvfb", "-displayfd", number.c_str(), "-screen", "0", "1280x960x24", "-nolisten", "tcp",
           static_cast<char*>(nullptr));
    _exit(127);
  }
  close(tube[1]);
  // It writes its number and a line end once it answers; without Xvfb the tube just ends.
  std::string number;
  pollfd ready{tube[0], POLLIN, 0};
  char c = 0;
  while (poll(&ready, 1, 20'000) > 0 && read(tube[0], &c, 1) == 1 && c != '\n') number += c;
  close(tube[0]);
  if (c == '\n') name_ = ":" + number;
}

VirtualDisplay::~VirtualDisplay() { end(server_); }

struct ViewSession::Connection {
  explicit Connection(const std::string& name) : display(XOpenDisplay(name.c_str())) {}
  ~Connection() {
    if (display != nullptr) XCloseDisplay(display);
  }

  std::string nameOf(Window id) const {
    Atom type = 0;
    int format = 0;
    unsigned long count = 0, rest_of_it = 0;
    unsigned char* data = nullptr;
    XGetWindowProperty(display, id, XInternAtom(display, "_NET_WM_NAME", False), 0, 1000, False,
                       XInternAtom(display, "UTF8_STRING", False), &type, &format, &count, &rest_of_it, &data);
    std::string name = data == nullptr ? "" : std::string(reinterpret_cast<char*>(data), count);
    if (data != nullptr) XFree(data);
    return name;
  }

  /// The one window with a name; it gets it when it is drawn.
  Window find() const {
    Window root = 0, parent = 0, *children = nullptr, found = 0;
    unsigned int count = 0;
    XQueryTree(display, DefaultRootWindow(display), &root, &parent, &children, &count);
    for (unsigned int i = 0; i < count; ++i) {
      if (!nameOf(children[i]).empty()) found = children[i];
    }
    if (children != nullptr) XFree(children);
    return found;
  }

  void flush() const { XSync(display, False); }

  Display* display;
  Window window = 0;
};

ViewSession::ViewSession(const std::string& display, std::vector<std::string> words,
                         const std::filesystem::path& folder)
    : x_(std::make_unique<Connection>(display)), folder_(folder) {
  if (x_->display == nullptr) return;
  words.insert(words.begin(), STIFFSCOPE_VIEW_BINARY);
  program_ = fork();
  if (program_ == 0) {
    setenv("DISPLAY", display.c_str(), 1);
    if (chdir(folder.c_str()) != 0) _exit(126);
    dup2(open("stdout", O_WRONLY | O_CREAT, 0600), 1);
    dup2(open("stderr", O_WRONLY | O_CREAT, 0600), 2);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    execv(arguments[0], arguments.data());
    _exit(127);
  }
  const auto deadline = Clock::now() + std::chrono::seconds(20);
  while (x_->window == 0 && Clock::now() < deadline) {
    rest(30);
    x_->window = x_->find();
  }
  if (x_->window == 0) return;
  // There is no window manager: the keys are given to the window here.
  XSetInputFocus(x_->display, x_->window, RevertToParent, CurrentTime);
  x_->flush();
  waitForChange(cv::Mat());
}

ViewSession::~ViewSession() { end(program_); }

bool ViewSession::opened() const { return x_->window != 0; }

cv::Mat ViewSession::picture() {
  XWindowAttributes attributes;
  XGetWindowAttributes(x_->display, x_->window, &attributes);
  XImage* image = XGetImage(x_->display, x_->window, 0, 0, static_cast<unsigned>(attributes.width),
                            static_cast<unsigned>(attributes.height), AllPlanes, ZPixmap);
  if (image == nullptr) return {};
  const cv::Mat seen(image->height, image->width, CV_8UC4, image->data,
                     static_cast<std::size_t>(image->bytes_per_line));
  cv::Mat bgr;
  cv::cvtColor(seen, bgr, cv::COLOR_BGRA2BGR);
  XDestroyImage(image);
  return bgr;
}

void ViewSession::waitForChange(const cv::Mat& before) {
  const auto same = [](const cv::Mat& a, const cv::Mat& b) {
    return a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0;
  };
  const auto deadline = Clock::now() + std::chrono::seconds(8);
  cv::Mat last = picture();
  while (Clock::now() < deadline) {
    rest(60);
    const cv::Mat now = picture();
    if (same(now, last) && (before.empty() || !same(now, before))) return;
    last = now;
  }
}

void ViewSession::press(const char* key, bool shift) {
  const cv::Mat before = picture();
  const auto code = [&](KeySym symbol) { return XKeysymToKeycode(x_->display, symbol); };
  const KeyCode shift_key = code(XStringToKeysym("Shift_L")), wanted = code(XStringToKeysym(key));
  if (shift) XTestFakeKeyEvent(x_->display, shift_key, True, CurrentTime);
  XTestFakeKeyEvent(x_->display, wanted, True, CurrentTime);
  XTestFakeKeyEvent(x_->display, wanted, False, CurrentTime);
  if (shift) XTestFakeKeyEvent(x_->display, shift_key, False, CurrentTime);
  x_->flush();
  if (std::string(key) != "q" && std::string(key) != "Escape") waitForChange(before);
}

void ViewSession::close() {
  XEvent event{};
  event.xclient.type = ClientMessage;
  event.xclient.window = x_->window;
  event.xclient.message_type = XInternAtom(x_->display, "WM_PROTOCOLS", False);
  event.xclient.format = 32;
  event.xclient.data.l[0] = static_cast<long>(XInternAtom(x_->display, "WM_DELETE_WINDOW", False));
  XSendEvent(x_->display, x_->window, False, NoEventMask, &event);
  x_->flush();
}

void ViewSession::click(cv::Point at) { drag(at, at); }

void ViewSession::drag(cv::Point from, cv::Point to) {
  const cv::Mat before = picture();
  XTestFakeMotionEvent(x_->display, -1, from.x, from.y, CurrentTime);
  XTestFakeButtonEvent(x_->display, 1, True, CurrentTime);
  for (int i = 1; i <= 4 && from != to; ++i) {
    const cv::Point at = from + (to - from) * i / 4;
    XTestFakeMotionEvent(x_->display, -1, at.x, at.y, CurrentTime);
  }
  XTestFakeButtonEvent(x_->display, 1, False, CurrentTime);
  x_->flush();
  waitForChange(before);
}

void ViewSession::wheel(cv::Point at, bool forward) {
  const cv::Mat before = picture();
  XTestFakeMotionEvent(x_->display, -1, at.x, at.y, CurrentTime);
  XTestFakeButtonEvent(x_->display, forward ? 4 : 5, True, CurrentTime);
  XTestFakeButtonEvent(x_->display, forward ? 4 : 5, False, CurrentTime);
  x_->flush();
  waitForChange(before);
}

std::string ViewSession::title() { return x_->nameOf(x_->window); }

std::string ViewSession::out() const { return contentsOf(folder_ / "stdout"); }

Ran ViewSession::ended() {
  Ran ran;
  for (int i = 0; i < 100 && program_ > 0; ++i) {
    int raw = 0;
    if (waitpid(program_, &raw, WNOHANG) == program_) {
      program_ = -1;
      ran.status = WIFEXITED(raw) ? WEXITSTATUS(raw) : -1;
    } else {
      rest(50);
    }
  }
  ran.out = out();
  ran.err = contentsOf(folder_ / "stderr");
  return ran;
}

}  // namespace stiffscope

#endif
