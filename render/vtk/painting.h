#pragma once

#include <vtkNew.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>
#include <functional>
#include <memory>

#include "render/vtk/canvas.h"

class vtkRenderer;

namespace stiffscope::render {

class ErrorCollector;

/// While it lives, gathers what VTK would print to the terminal; a library does not print.
class CollectErrors {
 public:
  CollectErrors();
  ~CollectErrors();
  CollectErrors(const CollectErrors&) = delete;
  CollectErrors& operator=(const CollectErrors&) = delete;
  /// Throws std::runtime_error with the errors, if there were any.
  void throwIfAny() const;

 private:
  vtkSmartPointer<vtkOutputWindow> before_;
  vtkSmartPointer<ErrorCollector> collector_;
};

/// Lets `paint` draw over all else in `layer`, each time that is rendered. What `paint` throws is kept for
/// `rethrow`, because an exception must not cross VTK's pipeline.
class Painting {
 public:
  Painting(vtkRenderer& layer, const Surface& surface, std::function<void(Canvas&)> paint);
  /// Throws what the painting threw.
  void rethrow() const;

 private:
  struct Outcome;
  std::shared_ptr<Outcome> outcome_;
};

}  // namespace stiffscope::render
