#pragma once

#include <memory>

#include "render/vtk/arm_layers.h"
#include "render/vtk/canvas.h"

class vtkRenderWindow;

namespace stiffscope::render {

/// What the mouse does to a window, out of its single events (those of vtkCommand).
class Hand {
 public:
  enum class Kind { nothing, turn, shift, zoom, click };
  struct Motion {
    Kind kind = Kind::nothing;
    double x = 0, y = 0;  ///< pixels moved, to the right and downwards; Click: where; Zoom: y is the factor
  };
  Motion take(unsigned long event, Spot pointer);

 private:
  Motion release(Kind of, Spot pointer);

  Kind drag_ = Kind::nothing;
  Spot pressed_, last_;
  bool moved_ = false;
};

/// The picture of an arm in a window on a display. Refers to the window.
class ShownLayers {
 public:
  explicit ShownLayers(vtkRenderWindow& window) : window_(window) {}
  ~ShownLayers() { forget(); }
  ShownLayers(const ShownLayers&) = delete;
  ShownLayers& operator=(const ShownLayers&) = delete;

  /// Draws the scene instead of the one before, in the window's present size; a window squeezed to nothing
  /// keeps what it has. Throws what ArmLayers throws, and std::runtime_error for errors of VTK.
  void show(const ArmScene& scene);
  /// How the last scene was projected; none before the first.
  const SceneStage* stage() const { return layers_ ? &layers_->stage() : nullptr; }
  /// What is shown, in the window's pixels.
  Image picture() const;

 private:
  void forget();

  vtkRenderWindow& window_;
  std::unique_ptr<ArmLayers> layers_;
};

}  // namespace stiffscope::render
