#pragma once

#include <Eigen/Core>
#include <optional>

#include "render/arm_scene.h"

namespace stiffscope::render {

/// The view that a hand turns, shifts and zooms, as on a turntable: the base z axis stays upright. Until the
/// hand takes it, the picture fits by itself.
class ViewCamera {
 public:
  /// Goes to one of the views, fitted.
  void look(View view);
  /// As ArmWindow::turn. Tipping ends short of the vertical, where up has no direction.
  void turn(double about_vertical, double towards);
  /// By this share of the room's height, to the right and upwards on the picture.
  void shift(double right, double up);
  /// `factor` above 1: nearer.
  void zoom(double factor);
  /// How the last picture was framed: what shifting, zooming and turning start from.
  void framedAs(const SceneFraming& framing) { last_ = framing; }

  /// Makes `scene` be seen from here.
  void apply(ArmScene& scene) const;

 private:
  void hold();

  View view_ = View::oblique;
  std::optional<Eigen::Vector3d> direction_;
  std::optional<SceneFraming> last_, held_;
};

}  // namespace stiffscope::render
