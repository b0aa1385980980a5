#include "render/backend.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>

namespace stiffscope::render {

namespace {

constexpr const char* kModuleName = "libstiffscope_render.so";

std::filesystem::path findModule() {
  std::error_code error;
  const auto folder = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  if (error) throw std::runtime_error(fmt::format("cannot find the own executable: {}", error.message()));
  const auto beside = folder / kModuleName;
  const auto installed = folder / STIFFSCOPE_MODULE_FROM_BIN / kModuleName;
  for (const auto& candidate : {beside, installed}) {
    if (std::filesystem::exists(candidate, error)) return candidate;
  }
  throw std::runtime_error(fmt::format("cannot draw pictures: {} is neither at {} nor at {}", kModuleName,
                                       beside.string(), installed.lexically_normal().string()));
}

// RTLD_DEEPBIND: VTK in the module must find the module's OSMesa and not a GLX that the program has brought
// along (OpenCV does). Sanitizers refuse that flag; their programs have osmesa_for_glx.cpp of their own.
#if defined(__has_feature)  // Clang says it this way, GCC by a macro
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define STIFFSCOPE_SANITIZED
#endif
#endif
#if defined(STIFFSCOPE_SANITIZED) || defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || \
    !defined(RTLD_DEEPBIND)
constexpr int kFlags = RTLD_NOW | RTLD_LOCAL;
#else
constexpr int kFlags = RTLD_NOW | RTLD_LOCAL | RTLD_DEEPBIND;
#endif

// The module stays loaded: VTK and LLVM do not survive being unloaded.
Backend* load() {
  const std::string path = findModule().string();
  void* module = dlopen(path.c_str(), kFlags);
  if (module == nullptr) throw std::runtime_error(fmt::format("cannot draw pictures: {}", dlerror()));
  auto* function = reinterpret_cast<BackendFunction*>(dlsym(module, kBackendSymbol));
  if (function == nullptr) {
    throw std::runtime_error(fmt::format("cannot draw pictures: {} belongs to another version", path));
  }
  return function();
}

Backend& backend() {
  static Backend* const loaded = load();
  return *loaded;
}

}  // namespace

Image render(const GroupedBarChart& chart, Size size) { return backend().draw(chart, size); }
Image render(const SpreadChart& chart, Size size) { return backend().draw(chart, size); }
Image render(const IntervalChart& chart, Size size) { return backend().draw(chart, size); }
Image render(const PointChart& chart, Size size) { return backend().draw(chart, size); }
Image render(const DotRowChart& chart, Size size) { return backend().draw(chart, size); }
Image render(const ArmScene& scene, Size size) { return backend().draw(scene, size); }

}  // namespace stiffscope::render
