#include "render/vtk/collect_errors.h"

#include <fmt/format.h>
#include <vtkObjectFactory.h>

#include <stdexcept>
#include <string>

namespace stiffscope {

class ErrorCollector : public vtkOutputWindow {
 public:
  static ErrorCollector* New();
  vtkTypeMacro(ErrorCollector, vtkOutputWindow);
  void DisplayText(const char*) override {}
  void DisplayErrorText(const char* text) override { errors += text; }
  std::string errors;
};
vtkStandardNewMacro(ErrorCollector);

CollectErrors::CollectErrors()
    : before_(vtkOutputWindow::GetInstance()), collector_(vtkSmartPointer<ErrorCollector>::New()) {
  vtkOutputWindow::SetInstance(collector_);
}

CollectErrors::~CollectErrors() { vtkOutputWindow::SetInstance(before_); }

void CollectErrors::throwIfAny() const {
  if (collector_->errors.empty()) return;
  throw std::runtime_error(fmt::format("cannot draw pictures: VTK says: {}", collector_->errors));
}

}  // namespace stiffscope
