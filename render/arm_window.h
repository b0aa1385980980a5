#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "render/arm_scene.h"

namespace stiffscope::render {

/// There is no display to open a window on, or none with OpenGL 3.2. The message says which and why.
class NoDisplay : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A window on the desktop (X11) with one ArmScene, drawn by the code of `render`. Left drag turns about the
/// vertical and tips, right or middle drag shifts, the wheel zooms; a click picks the point under it. The
/// view is the window's: `view_direction` and `framing` of the scenes it shows are not looked at. Until it is
/// turned, shifted or zoomed the picture fits the window, as it does again after `look`.
class ArmWindow {
 public:
  /// What a user does. A key comes by its X name ("Right", "plus", "q"), with "Shift+" before the name of one
  /// that types nothing. A picked point is counted as the scene lists them: the first pose's targets, its
  /// wrist centre last; none where nothing was under the click.
  struct Events {
    std::function<void(const std::string& key)> key;
    std::function<void(std::optional<std::size_t> point)> pick;
  };

  /// Nothing is opened yet but the connection. Throws NoDisplay.
  explicit ArmWindow(Size size = {1280, 860});
  ~ArmWindow();
  ArmWindow(const ArmWindow&) = delete;
  ArmWindow& operator=(const ArmWindow&) = delete;

  /// Draws the scene; `title` is the window's. Throws what `render` throws.
  void show(const ArmScene& scene, const std::string& title);
  /// Goes to one of the views, fitted.
  void look(View view);
  /// Turns by these angles, rad: about the vertical, positive as the hand pulls the scene to the right, and
  /// tipping it towards the viewer.
  void turn(double about_vertical, double towards);
  void zoom(double factor);

  /// What is shown, in the window's pixels.
  Image picture();

  /// Handles events until `close` or until the window is closed. Throws what the handlers throw.
  void run(const Events& events);
  void close();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace stiffscope::render
