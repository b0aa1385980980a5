#pragma once

#include <vtkNew.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

namespace stiffscope {

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

}  // namespace stiffscope
