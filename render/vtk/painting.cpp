#include "render/vtk/painting.h"

#include <fmt/format.h>
#include <vtkContext2D.h>
#include <vtkContextActor.h>
#include <vtkContextItem.h>
#include <vtkContextScene.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkRenderer.h>
#include <exception>
#include <stdexcept>
#include <string>
#include <utility>

namespace stiffscope::render {

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

struct Painting::Outcome {
  std::exception_ptr failure;
};

namespace {

class PaintedItem : public vtkContextItem {
 public:
  static PaintedItem* New();
  vtkTypeMacro(PaintedItem, vtkContextItem);
  bool Paint(vtkContext2D* context) override {
    paint(*context);
    return true;
  }
  std::function<void(vtkContext2D&)> paint;
};
vtkStandardNewMacro(PaintedItem);

}  // namespace

Painting::Painting(vtkRenderer& layer, const Surface& surface, std::function<void(Canvas&)> paint)
    : outcome_(std::make_shared<Outcome>()) {
  const vtkNew<PaintedItem> item;
  item->paint = [outcome = outcome_, surface, paint = std::move(paint), fonts = findFonts()](vtkContext2D& context) {
    try {
      Canvas canvas(context, surface, fonts);
      paint(canvas);
      canvas.finish();
    } catch (...) {
      outcome->failure = std::current_exception();
    }
  };
  const vtkNew<vtkContextActor> actor;
  actor->GetScene()->AddItem(item);
  layer.AddActor(actor);
}

void Painting::rethrow() const {
  if (outcome_->failure) std::rethrow_exception(outcome_->failure);
}

}  // namespace stiffscope::render
