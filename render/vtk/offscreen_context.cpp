#include "render/vtk/offscreen_context.h"

#include <fmt/format.h>
#include <vtkNew.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include <mutex>
#include <stdexcept>

#include "render/vtk/collect_errors.h"
#include "render/vtk/gl_window.h"

namespace stiffscope {

namespace {

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

// Means over squares of kSupersampling pixels. VTK's rows run from bottom to top.
Image averageDown(const std::uint8_t* pixels, Size size) {
  constexpr int k = kSupersampling;
  Image image{size.width, size.height, {}};
  image.rgb.resize(3 * static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
  const std::ptrdiff_t row = 3 * static_cast<std::ptrdiff_t>(size.width) * k;
  std::uint8_t* out = image.rgb.data();
  for (int y = size.height - 1; y >= 0; --y) {
    const std::uint8_t* in = pixels + row * k * y;
    for (int x = 0; x < size.width; ++x, in += 3 * k, out += 3) {
      for (int channel = 0; channel < 3; ++channel) {
        int sum = k * k / 2;
        for (int i = 0; i < k; ++i) {
          for (int j = 0; j < k; ++j) sum += in[row * i + 3 * j + channel];
        }
        out[channel] = static_cast<std::uint8_t>(sum / (k * k));
      }
    }
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

  const int width = kSupersampling * size.width;
  const int height = kSupersampling * size.height;
  window.SetSize(width, height);
  vtkNew<vtkUnsignedCharArray> pixels;
  {
    const Shown shown(window, layers);
    window.Render();
    const int front = 0;
    window.GetPixelData(0, 0, width - 1, height - 1, front, pixels);
  }
  vtk_messages.throwIfAny();
  if (pixels->GetNumberOfValues() != vtkIdType{3} * width * height) {
    throw std::runtime_error(
        fmt::format("cannot draw pictures: no pixels came back for {} x {}", width, height));
  }
  return averageDown(pixels->GetPointer(0), size);
}

}  // namespace stiffscope
