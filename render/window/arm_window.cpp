#include "render/window/arm_window.h"

#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <stdexcept>
#include <utility>

#include "render/arm_window.h"
#include "render/view_camera.h"
#include "render/vtk/arm_shape.h"
#include "render/vtk/painting.h"
#include "render/window/x_display.h"

namespace stiffscope::render {

namespace {

constexpr double kWheelStep = 1.15;
constexpr double kStill = 4;  // pixels that a click may move

}  // namespace

Hand::Motion Hand::release(Kind of, Spot pointer) {
  if (drag_ != of) return {};
  drag_ = Kind::nothing;
  if (of == Kind::turn && !moved_) return {Kind::click, pointer.x, pointer.y};
  return {};
}

Hand::Motion Hand::take(unsigned long event, Spot pointer) {
  switch (event) {
    case vtkCommand::LeftButtonPressEvent:
    case vtkCommand::MiddleButtonPressEvent:
    case vtkCommand::RightButtonPressEvent:
      drag_ = event == vtkCommand::LeftButtonPressEvent ? Kind::turn : Kind::shift;
      pressed_ = last_ = pointer;
      moved_ = false;
      return {};
    case vtkCommand::LeftButtonReleaseEvent:
      return release(Kind::turn, pointer);
    case vtkCommand::MiddleButtonReleaseEvent:
    case vtkCommand::RightButtonReleaseEvent:
      return release(Kind::shift, pointer);
    case vtkCommand::MouseWheelForwardEvent:
      return {Kind::zoom, 0, kWheelStep};
    case vtkCommand::MouseWheelBackwardEvent:
      return {Kind::zoom, 0, 1 / kWheelStep};
    case vtkCommand::MouseMoveEvent: {
      if (drag_ == Kind::nothing) return {};
      moved_ = moved_ || std::hypot(pointer.x - pressed_.x, pointer.y - pressed_.y) > kStill;
      if (!moved_) return {};
      const Motion motion{drag_, pointer.x - last_.x, pointer.y - last_.y};
      last_ = pointer;
      return motion;
    }
    default:
      return {};
  }
}

void ShownLayers::forget() {
  if (!layers_) return;
  for (const auto& layer : layers_->renderers()) window_.RemoveRenderer(layer);
  layers_.reset();
}

void ShownLayers::show(const ArmScene& scene) {
  const int* size = window_.GetSize();
  if (size[0] < 240 || size[1] < 160) return;
  const CollectErrors vtk_messages;
  auto next = std::make_unique<ArmLayers>(scene, Surface{{size[0], size[1]}, 1});
  forget();
  layers_ = std::move(next);
  window_.SetNumberOfLayers(static_cast<int>(layers_->renderers().size()));
  int at = 0;
  for (const auto& layer : layers_->renderers()) {
    layer->SetLayer(at++);
    window_.AddRenderer(layer);
  }
  window_.Render();
  layers_->rethrow();
  vtk_messages.throwIfAny();
}

Image ShownLayers::picture() const {
  const int* size = window_.GetSize();
  Image image{size[0], size[1], {}, {}};
  vtkNew<vtkUnsignedCharArray> pixels;
  const int front = 0;
  window_.GetPixelData(0, 0, image.width - 1, image.height - 1, front, pixels);
  const std::ptrdiff_t row = std::ptrdiff_t{3} * image.width;
  if (pixels->GetNumberOfValues() != row * image.height) {
    throw std::runtime_error("cannot draw pictures: no pixels came back from the window");
  }
  image.rgb.reserve(static_cast<std::size_t>(row * image.height));
  for (int y = image.height - 1; y >= 0; --y) {  // VTK's rows run from bottom to top
    const std::uint8_t* from = pixels->GetPointer(row * y);
    image.rgb.insert(image.rgb.end(), from, from + row);
  }
  return image;
}

namespace {

constexpr int kAntialiasing = 4;    // samples a pixel
constexpr double kPickRadius = 16;  // pixels at 1200 x 700

vtkSmartPointer<vtkRenderWindow> newWindow() {
  requireDisplay();
  return vtkSmartPointer<vtkRenderWindow>::New();
}

}  // namespace

class ArmWindow::Implementation {
 public:
  explicit Implementation(Size size);

  void show(const ArmScene& scene, const std::string& title) {
    scene_ = scene;
    title_ = title;
    changed();
  }
  template <class Change>
  void changeView(const Change& change) {
    change(camera_);
    if (!scene_.poses.empty()) changed();
  }
  Image picture() { return shown_.picture(); }
  void run(const Events& events);
  void close() { interactor_->TerminateApp(); }

 private:
  void changed();
  void draw();
  void observe();
  void handle(unsigned long event);
  void move(Hand::Motion motion);
  std::optional<std::size_t> pointAt(Spot spot) const;
  Spot pointer() const;

  ViewCamera camera_;
  Hand hand_;
  ArmScene scene_;
  std::string title_;
  vtkSmartPointer<vtkRenderWindow> window_;
  vtkSmartPointer<vtkRenderWindowInteractor> interactor_;
  vtkNew<vtkCallbackCommand> command_;
  ShownLayers shown_;
  const Events* events_ = nullptr;
  std::exception_ptr failure_;
  bool handling_ = false, stale_ = false;
};

ArmWindow::Implementation::Implementation(Size size) : window_(newWindow()), shown_(*window_) {
  // VTK's errors are thrown (CollectErrors); its warnings, as of having no interactor style, are not for
  // users.
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  window_->SetSize(size.width, size.height);
  window_->SetMultiSamples(kAntialiasing);
  interactor_ = vtkSmartPointer<vtkRenderWindowInteractor>::New();
  interactor_->SetRenderWindow(window_);
  interactor_->SetInteractorStyle(nullptr);  // its keys and its camera are not ours
  interactor_->EnableRenderOff();            // what is to be drawn, and when, is decided here
}

void ArmWindow::Implementation::changed() {
  stale_ = true;
  if (!handling_) draw();  // else once the event is done with, and those that wait behind it
}

void ArmWindow::Implementation::draw() {
  stale_ = false;
  camera_.apply(scene_);
  const bool first = shown_.stage() == nullptr;  // the window is made by drawing
  if (!first) nameWindow(*window_, title_);
  shown_.show(scene_);
  if (first) nameWindow(*window_, title_);
  if (const SceneStage* stage = shown_.stage()) camera_.framedAs(stage->projection.framingOf(stage->room));
}

void ArmWindow::Implementation::observe() {
  command_->SetClientData(this);
  command_->SetCallback(
      [](vtkObject*, unsigned long event, void* self, void*) { static_cast<Implementation*>(self)->handle(event); });
  for (const auto event :
       {vtkCommand::KeyPressEvent, vtkCommand::MouseMoveEvent, vtkCommand::LeftButtonPressEvent,
        vtkCommand::LeftButtonReleaseEvent, vtkCommand::MiddleButtonPressEvent, vtkCommand::MiddleButtonReleaseEvent,
        vtkCommand::RightButtonPressEvent, vtkCommand::RightButtonReleaseEvent, vtkCommand::MouseWheelForwardEvent,
        vtkCommand::MouseWheelBackwardEvent, vtkCommand::ConfigureEvent, vtkCommand::ExposeEvent,
        vtkCommand::ExitEvent}) {
    interactor_->AddObserver(event, command_);
  }
}

void ArmWindow::Implementation::run(const Events& events) {
  events_ = &events;
  interactor_->Initialize();
  observe();
  stale_ = true;
  interactor_->Start();
  interactor_->RemoveObserver(command_);
  events_ = nullptr;
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

Spot ArmWindow::Implementation::pointer() const {
  const int* at = interactor_->GetEventPosition();  // from the lower left
  return {static_cast<double>(at[0]), static_cast<double>(window_->GetSize()[1] - 1 - at[1])};
}

// An exception must not cross VTK and X: it ends the loop and is thrown by `run`.
void ArmWindow::Implementation::handle(unsigned long event) {
  handling_ = true;
  try {
    switch (event) {
      case vtkCommand::KeyPressEvent:
        if (events_->key) events_->key(keyName(*interactor_));
        break;
      case vtkCommand::ConfigureEvent:
      case vtkCommand::ExposeEvent:
        stale_ = true;
        break;
      case vtkCommand::ExitEvent:
        close();
        break;
      default:
        move(hand_.take(event, pointer()));
    }
    handling_ = false;
    if (stale_ && !inputWaits(*window_)) draw();
  } catch (...) {
    failure_ = std::current_exception();
    close();
  }
  handling_ = false;
}

void ArmWindow::Implementation::move(Hand::Motion motion) {
  const double height = shown_.stage() != nullptr ? shown_.stage()->room.height() : window_->GetSize()[1];
  switch (motion.kind) {
    case Hand::Kind::nothing:
      break;
    case Hand::Kind::turn:  // half a turn over the height of the room
      changeView([&](ViewCamera& camera) { camera.turn(M_PI * motion.x / height, M_PI * motion.y / height); });
      break;
    case Hand::Kind::shift:
      changeView([&](ViewCamera& camera) { camera.shift(motion.x / height, -motion.y / height); });
      break;
    case Hand::Kind::zoom:
      changeView([&](ViewCamera& camera) { camera.zoom(motion.y); });
      break;
    case Hand::Kind::click:
      if (events_->pick) events_->pick(pointAt({motion.x, motion.y}));
      break;
  }
}

std::optional<std::size_t> ArmWindow::Implementation::pointAt(Spot spot) const {
  if (shown_.stage() == nullptr) return std::nullopt;
  const SceneStage& stage = *shown_.stage();
  std::optional<std::size_t> nearest;
  const double ball = ArmProportions(scene_.poses.front()).target_radius * stage.projection.pixelsPerMetre();
  double least = std::max(kPickRadius * stage.unit, ball);
  std::size_t index = 0;
  const auto consider = [&](const ScenePoint& point) {
    const Spot at = stage.projection.spotOf(point.position);
    const double distance = std::hypot(at.x - spot.x, at.y - spot.y);
    if (distance < least) {
      least = distance;
      nearest = index;
    }
    ++index;
  };
  for (const ScenePoint& target : scene_.poses.front().targets) consider(target);
  if (scene_.poses.front().wrist) consider(*scene_.poses.front().wrist);
  return nearest;
}

ArmWindow::ArmWindow(Size size) : implementation_(std::make_unique<Implementation>(size)) {}
ArmWindow::~ArmWindow() = default;

void ArmWindow::show(const ArmScene& scene, const std::string& title) { implementation_->show(scene, title); }
void ArmWindow::look(View view) {
  implementation_->changeView([&](ViewCamera& camera) { camera.look(view); });
}
void ArmWindow::turn(double about_vertical, double towards) {
  implementation_->changeView([&](ViewCamera& camera) { camera.turn(about_vertical, towards); });
}
void ArmWindow::zoom(double factor) {
  implementation_->changeView([&](ViewCamera& camera) { camera.zoom(factor); });
}
Image ArmWindow::picture() { return implementation_->picture(); }
void ArmWindow::run(const Events& events) { implementation_->run(events); }
void ArmWindow::close() { implementation_->close(); }

}  // namespace stiffscope::render
