#include "render/vtk/offscreen_picture.h"

#include <fmt/format.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>
#ifdef STIFFSCOPE_VTK_HAS_OSMESA
#include <vtkOSOpenGLRenderWindow.h>
#else
#include <GL/osmesa.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLFramebufferObject.h>
#endif
#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "render/image.h"
#include "render/vtk/arm_layers.h"
#include "render/vtk/canvas.h"
#include "render/vtk/painting.h"
#include "render/vtk/scene_stage.h"

namespace stiffscope::render {

/// Renders `layers`, the first at the back, into a picture of `size` without display or GPU, at
/// kSupersampling times the size, averaged down. One software GL context serves all pictures of the process;
/// calls from several threads wait for each other. Throws std::runtime_error with the reason when there is no
/// context or VTK reports an error.
Image renderOffscreen(const std::vector<vtkSmartPointer<vtkRenderer>>& layers, Size size);

Image drawArmScene(const ArmScene& scene, Size size) {
  requireUsable(size);
  const ArmLayers layers(scene, {size});
  Image image = renderOffscreen(layers.renderers(), size);
  layers.rethrow();
  const auto mark = [&](const ScenePoint& point) {
    const Spot at = layers.stage().projection.spotOf(point.position);
    image.marks.push_back({at.x / size.width, at.y / size.height, point.label, "", 0.0, 0.0});
  };
  for (const ArmPose& pose : scene.poses) {
    for (const ScenePoint& target : pose.targets) mark(target);
    if (pose.wrist) mark(*pose.wrist);
  }
  return image;
}

void requireUsable(Size size) {
  if (size.width < 480 || size.height < 320 || size.width > 8000 || size.height > 8000) {
    throw std::invalid_argument(
        fmt::format("a picture of {} x {} pixels: expected 480 x 320 to 8000 x 8000", size.width, size.height));
  }
}

Image drawFlat(Size size, const std::function<void(Canvas&)>& paint) {
  requireUsable(size);
  const auto layer = vtkSmartPointer<vtkRenderer>::New();
  layer->SetBackground(1, 1, 1);
  std::vector<Mark> marks;
  const Painting painting(*layer, {size}, [&](Canvas& canvas) {
    paint(canvas);
    marks = canvas.takeMarks();
  });
  Image image = renderOffscreen({layer}, size);
  painting.rethrow();
  image.marks = std::move(marks);
  return image;
}

namespace {

/// A VTK render window on a software GL context, with no display. Throws std::runtime_error when there is
/// none to be had.
class GlWindow {
 public:
  GlWindow();
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

// Mesa's software renderer keeps what it has drawn until it draws there again; with threads of its own it draws in
// several places in turn. On the calling thread there is one, and a picture is done as soon: most of it is drawn on
// that thread anyway. Who sets the number has it.
void drawOnThisThread() {
  constexpr int kUnlessSet = 0;
  ::setenv("LP_NUM_THREADS", "0", kUnlessSet);
}

#ifdef STIFFSCOPE_VTK_HAS_OSMESA

struct GlWindow::Context {};

GlWindow::GlWindow() {
  drawOnThisThread();
  window_ = vtkSmartPointer<vtkOSOpenGLRenderWindow>::New();
  window_->SetMultiSamples(0);
}

vtkRenderWindow& GlWindow::makeCurrent() { return *window_; }
void GlWindow::release() {}

#else

/// A window that has pixels where it is drawn on, and nowhere else. VTK makes three framebuffers of a window's size,
/// seven images in all: the others are what a display shows and what multisampling needs, and there is neither here.
/// They stay of one pixel.
class DrawnOnlyWindow : public vtkGenericOpenGLRenderWindow {
 public:
  static DrawnOnlyWindow* New();
  vtkTypeMacro(DrawnOnlyWindow, vtkGenericOpenGLRenderWindow);

  void Start() override {
    const std::pair<int, int> size{Size[0], Size[1]};
    Size[0] = Size[1] = 1;
    Superclass::Start();
    std::tie(Size[0], Size[1]) = size;
    RenderFramebuffer->Resize(size.first, size.second);
  }
  /// Superclass::Frame copies what was drawn to what a display shows.
  void Frame() override {}
};
vtkStandardNewMacro(DrawnOnlyWindow);

// OSMesa wants a buffer to draw on; VTK draws on one of its own, so this one is as small as may be.
struct GlWindow::Context {
  static constexpr int kSide = 16;
  OSMesaContext handle = nullptr;
  std::array<unsigned char, kSide * kSide * 4> buffer{};

  bool makeCurrent() { return OSMesaMakeCurrent(handle, buffer.data(), GL_UNSIGNED_BYTE, kSide, kSide) == GL_TRUE; }
  ~Context() {
    if (handle != nullptr) OSMesaDestroyContext(handle);
  }
};

GlWindow::GlWindow() : context_(std::make_unique<Context>()) {
  drawOnThisThread();
  const std::array<int, 11> attributes = {OSMESA_FORMAT,
                                          OSMESA_RGBA,
                                          OSMESA_DEPTH_BITS,
                                          24,
                                          OSMESA_PROFILE,
                                          OSMESA_CORE_PROFILE,
                                          OSMESA_CONTEXT_MAJOR_VERSION,
                                          3,
                                          OSMESA_CONTEXT_MINOR_VERSION,
                                          2,
                                          0};
  context_->handle = OSMesaCreateContextAttribs(attributes.data(), nullptr);
  if (context_->handle == nullptr) {
    throw std::runtime_error("cannot draw pictures: OSMesa has no OpenGL 3.2 core context");
  }
  if (!context_->makeCurrent()) throw std::runtime_error("cannot draw pictures: OSMesa refuses its context");

  const auto window = vtkSmartPointer<DrawnOnlyWindow>::New();
  window->SetReadyForRendering(true);
  window->SetIsCurrent(true);
  window->SetSupportsOpenGL(true);
  window->SetMultiSamples(0);
  window->SetFrameBlitModeToNoBlit();
  if (!window->InitializeFromCurrentContext()) {
    throw std::runtime_error("cannot draw pictures: VTK does not accept the OSMesa context");
  }
  window_ = window;
}

vtkRenderWindow& GlWindow::makeCurrent() {
  if (!context_->makeCurrent()) throw std::runtime_error("cannot draw pictures: OSMesa refuses its context");
  return *window_;
}

// Mesa keeps a picture's pixels and triangles, tens of megabytes, until it draws again: here one pixel of nothing.
void GlWindow::release() {
  const vtkNew<vtkRenderer> nothing;
  window_->SetSize(1, 1);
  window_->AddRenderer(nothing);
  window_->Render();
  window_->WaitForCompletion();
  window_->RemoveRenderer(nothing);
  OSMesaMakeCurrent(nullptr, nullptr, 0, 0, 0);
}

#endif

// The context belongs to this thread.
struct Current {
  explicit Current(GlWindow& context) : gl(context), window(context.makeCurrent()) {}
  ~Current() { gl.release(); }
  Current(const Current&) = delete;
  Current& operator=(const Current&) = delete;
  GlWindow& gl;
  vtkRenderWindow& window;
};

// The layers are in the window; leaving it frees what they hold of the context.
struct Shown {
  Shown(vtkRenderWindow& w, const std::vector<vtkSmartPointer<vtkRenderer>>& l) : window(w), layers(l) {
    window.SetNumberOfLayers(static_cast<int>(layers.size()));
    for (std::size_t i = 0; i < layers.size(); ++i) {
      layers[i]->SetLayer(static_cast<int>(i));
      window.AddRenderer(layers[i]);
    }
  }
  ~Shown() {
    for (const auto& layer : layers) window.RemoveRenderer(layer);
  }
  Shown(const Shown&) = delete;
  Shown& operator=(const Shown&) = delete;
  vtkRenderWindow& window;
  const std::vector<vtkSmartPointer<vtkRenderer>>& layers;
};

constexpr int kChannels = 4;  // as they are rendered, so that reading does not convert them; a picture has three

/// Means over squares of kSupersampling pixels, of rendered rows into the picture's rows from `y` upwards: VTK's run
/// from bottom to top.
void averageDown(const std::uint8_t* rendered, int rows, int y, Image& image) {
  constexpr int k = kSupersampling;
  const std::ptrdiff_t row = kChannels * static_cast<std::ptrdiff_t>(image.width) * k;
  for (int up = 0; up < rows; ++up) {
    const std::uint8_t* in = rendered + row * k * up;
    std::uint8_t* out = image.rgb.data() + 3 * static_cast<std::ptrdiff_t>(image.width) * (y - up);
    for (int x = 0; x < image.width; ++x, in += kChannels * k, out += 3) {
      for (int channel = 0; channel < 3; ++channel) {
        int sum = k * k / 2;
        for (int i = 0; i < k; ++i) {
          for (int j = 0; j < k; ++j) sum += in[row * i + kChannels * j + channel];
        }
        out[channel] = static_cast<std::uint8_t>(sum / (k * k));
      }
    }
  }
}

/// Rendered rows as they are, from `y` upwards.
void takeOver(const std::uint8_t* rendered, int rows, int y, Image& image) {
  for (int up = 0; up < rows; ++up) {
    const std::uint8_t* in = rendered + kChannels * static_cast<std::ptrdiff_t>(image.width) * up;
    std::uint8_t* out = image.rgb.data() + 3 * static_cast<std::ptrdiff_t>(image.width) * (y - up);
    for (int x = 0; x < image.width; ++x, in += kChannels, out += 3) std::copy_n(in, 3, out);
  }
}

/// What the window shows, band by band: rendered it is four times the picture.
Image readDown(vtkRenderWindow& window, Size size) {
  constexpr int kBand = 64, front = 0;  // rows of the picture
  const int density = size.doubled ? kSupersampling : 1;
  Image image{density * size.width, density * size.height, {}, {}};
  image.rgb.resize(3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  const vtkNew<vtkUnsignedCharArray> pixels;
  for (int low = 0; low < size.height; low += kBand) {
    const int rows = std::min(kBand, size.height - low);
    const int width = kSupersampling * size.width, first = kSupersampling * low, height = kSupersampling * rows;
    window.GetRGBACharPixelData(0, first, width - 1, first + height - 1, front, pixels);
    if (pixels->GetNumberOfValues() != vtkIdType{kChannels} * width * height) {
      throw std::runtime_error(fmt::format("cannot draw pictures: no pixels came back for {} x {}", width, height));
    }
    if (size.doubled)
      takeOver(pixels->GetPointer(0), height, image.height - 1 - first, image);
    else
      averageDown(pixels->GetPointer(0), rows, size.height - 1 - low, image);
  }
  return image;
}

}  // namespace

Image renderOffscreen(const std::vector<vtkSmartPointer<vtkRenderer>>& layers, Size size) {
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  const CollectErrors vtk_messages;
  // Never destroyed: at the end of a process the libraries under the context may be gone before it.
  static GlWindow* const gl = new GlWindow;
  const Current current(*gl);
  vtkRenderWindow& window = current.window;

  window.SetSize(kSupersampling * size.width, kSupersampling * size.height);
  Image image;
  {
    const Shown shown(window, layers);
    window.Render();
    vtk_messages.throwIfAny();
    image = readDown(window, size);
  }
  vtk_messages.throwIfAny();
  return image;
}

}  // namespace stiffscope::render
