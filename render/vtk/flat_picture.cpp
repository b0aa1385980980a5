#include "render/vtk/flat_picture.h"

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
#include <utility>

#include "render/vtk/offscreen_context.h"

namespace stiffscope {

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

void requireUsable(Size size) {
  if (size.width < 480 || size.height < 320 || size.width > 8000 || size.height > 8000) {
    throw std::invalid_argument(fmt::format("a picture of {} x {} pixels: expected 480 x 320 to 8000 x 8000",
                                            size.width, size.height));
  }
}

Painting::Painting(vtkRenderer& layer, Size size, std::function<void(Canvas&)> paint)
    : outcome_(std::make_shared<Outcome>()) {
  const vtkNew<PaintedItem> item;
  item->paint = [outcome = outcome_, size, paint = std::move(paint),
                 fonts = findFonts()](vtkContext2D& context) {
    try {
      Canvas canvas(context, size, fonts);
      paint(canvas);
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

Image drawFlat(Size size, const std::function<void(Canvas&)>& paint) {
  requireUsable(size);
  const auto layer = vtkSmartPointer<vtkRenderer>::New();
  layer->SetBackground(1, 1, 1);
  const Painting painting(*layer, size, paint);
  Image image = renderOffscreen({layer}, size);
  painting.rethrow();
  return image;
}

}  // namespace stiffscope
