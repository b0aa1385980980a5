#include "render/vtk/gl_window.h"

#include <cstdlib>
#include <stdexcept>

namespace stiffscope::render {

namespace {

// Mesa's software renderer keeps what it has drawn until it draws there again; with threads of its own it draws in
// several places in turn. On the calling thread there is one, and a picture is done as soon: most of it is drawn on
// that thread anyway. Who sets the number has it.
void drawOnThisThread() {
  constexpr int kUnlessSet = 0;
  ::setenv("LP_NUM_THREADS", "0", kUnlessSet);
}

}  // namespace

}  // namespace stiffscope::render

#ifdef STIFFSCOPE_VTK_HAS_OSMESA

#include <vtkOSOpenGLRenderWindow.h>

namespace stiffscope::render {

struct GlWindow::Context {};

GlWindow::GlWindow() {
  drawOnThisThread();
  window_ = vtkSmartPointer<vtkOSOpenGLRenderWindow>::New();
  window_->SetMultiSamples(0);
}
GlWindow::~GlWindow() = default;

vtkRenderWindow& GlWindow::makeCurrent() { return *window_; }
void GlWindow::release() {}

}  // namespace stiffscope::render

#else

#include <GL/osmesa.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLFramebufferObject.h>
#include <vtkRenderer.h>

#include <array>
#include <tuple>
#include <utility>

namespace stiffscope::render {

namespace {

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

}  // namespace

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

GlWindow::~GlWindow() = default;

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

}  // namespace stiffscope::render

#endif
