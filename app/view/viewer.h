#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/view/view_material.h"

namespace stiffscope::app {

struct ViewKey;

/// What the user has set.
struct ViewSettings {
  bool measured = true, predicted = true, residual = true;
  double magnification = 1;
  double residual_factor = 1;
  bool dark = false;
  bool keys_listed = true;
  bool keys_work = true;  ///< not so in a screenshot, which does not name them then
};

/// What a window does for the viewer.
struct ViewWindow {
  std::function<void(render::View)> look;
  std::function<void(double about_vertical, double towards)> turn;  ///< rad
  std::function<void(double factor)> zoom;
  std::function<std::string(const std::string& name)> save;  ///< what is shown; returns what came of it
  std::function<void()> close;
  std::function<void(const std::string& text)> say;  ///< to standard output
};

/// Steps through a campaign's pictures as keys and clicks want it; knows no window system. After `press` and
/// `pick`, `scene` and `title` are what is to be shown.
class Viewer {
 public:
  /// `by_method`: the same pictures with the predictions of each method, the first to start with; not empty,
  /// and not without frames. `first`: the frame to start with. `magnification`: empty for the one that suits
  /// all postures of that frame's step.
  Viewer(std::vector<ViewMaterial> by_method, std::size_t first, std::optional<double> magnification,
         ViewWindow window);

  ViewSettings& settings() { return settings_; }
  /// A key by its X name, as ArmWindow has it. A key that does nothing is ignored.
  void press(const std::string& key);
  /// The point counted as ArmWindow::Events does; its numbers go to the panel and are said.
  void pick(std::optional<std::size_t> point);

  render::ArmScene scene() const;
  /// "posture 17, load step 3, 1.50 kN, vectors × 100": where one is.
  std::string status() const;
  std::string title() const;

 private:
  const ViewMaterial& material() const { return by_method_[method_]; }
  const ViewFrame& frame() const { return material().frames[at_]; }
  void stepPosture(int by);
  void stepLoad(int by);
  void pickNext();
  void nextMethod();
  void suitMagnification();
  void changeResidualFactor(bool longer);
  void reset();
  void save();
  const render::ScenePoint* pickedPoint() const;
  void showOnlyWanted(render::ArmScene& scene) const;

  friend const std::vector<ViewKey>& viewKeys();

  std::vector<ViewMaterial> by_method_;
  std::size_t method_ = 0, at_ = 0;
  ViewSettings settings_, start_;
  ViewWindow window_;
  std::vector<Eigen::Vector3d> also_fitted_;
  std::string picked_;   // by its label: postures may lack a reflector
  std::string message_;  // until the next key
};

/// One thing that keys do.
struct ViewKey {
  std::vector<std::string> names;  ///< X names
  std::string shown;               ///< in the list; empty: not listed
  std::string does;
  void (*act)(Viewer&);
};

/// All keys, in the order in which they are listed.
const std::vector<ViewKey>& viewKeys();

/// The list for the window and for --help.
render::ScenePanel keysPanel();
std::string keysText();

}  // namespace stiffscope::app
