#pragma once

#include <sys/types.h>

#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "tests/app/command.h"

namespace stiffscope {

/// An X server without a screen of its own (Xvfb), on a display number that is free.
class VirtualDisplay {
 public:
  VirtualDisplay();
  ~VirtualDisplay();
  VirtualDisplay(const VirtualDisplay&) = delete;
  VirtualDisplay& operator=(const VirtualDisplay&) = delete;
  /// ":7"; empty where there is no Xvfb or it does not start.
  const std::string& name() const { return name_; }

 private:
  pid_t server_ = -1;
  std::string name_;
};

/// stiffscope-view on a virtual display, driven by keys and the mouse as a hand would (XTest).
class ViewSession {
 public:
  /// Starts the program with these words in `folder`, and waits until its window is drawn.
  ViewSession(const std::string& display, std::vector<std::string> words, const std::filesystem::path& folder);
  ~ViewSession();
  ViewSession(const ViewSession&) = delete;
  ViewSession& operator=(const ViewSession&) = delete;

  bool opened() const;
  /// A key by its X name, with Shift where wanted; waits until the picture has changed and stands still,
  /// eight seconds at most.
  void press(const char* key, bool shift = false);
  void click(cv::Point at);
  /// As a window manager closes it.
  void close();
  void drag(cv::Point from, cv::Point to);
  void wheel(cv::Point at, bool forward);

  /// What the window shows, blue green red.
  cv::Mat picture();
  /// The window's name.
  std::string title();
  /// The exit status after `press` of "q" or "Escape" or `close`, -1 if it has not ended within five seconds;
  /// standard output and error.
  Ran ended();
  /// What the program has written to standard output so far.
  std::string out() const;

 private:
  struct Connection;
  void waitForChange(const cv::Mat& before);

  std::unique_ptr<Connection> x_;
  std::filesystem::path folder_;
  pid_t program_ = -1;
};

}  // namespace stiffscope
