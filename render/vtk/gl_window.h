#pragma once

#include <vtkRenderWindow.h>
#include <vtkSmartPointer.h>

#include <memory>

namespace stiffscope::render {

/// A VTK render window on a software GL context, with no display. Throws std::runtime_error when there is
/// none to be had.
class GlWindow {
 public:
  GlWindow();
  ~GlWindow();
  GlWindow(const GlWindow&) = delete;
  GlWindow& operator=(const GlWindow&) = delete;

  /// Makes the context that of the calling thread. Throws std::runtime_error when it cannot.
  vtkRenderWindow& makeCurrent();
  /// Takes the context from the calling thread, so that another may have it.
  void release();

 private:
  struct Context;
  std::unique_ptr<Context> context_;
  vtkSmartPointer<vtkRenderWindow> window_;
};

}  // namespace stiffscope::render
