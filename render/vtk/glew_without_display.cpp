// Lets the GLEW of a VTK that was built for X (Debian's) start without a display. VTK asks this one, which comes before
// libGLEW in the order of symbol look-up: it is in the module that brings VTK in.

#include <dlfcn.h>

extern "C" __attribute__((visibility("default"))) unsigned int glewInit() {
  constexpr unsigned int kNotLoaded = 1;
  // Mesa 22 has a stub for any function, so GLEW asks for the display and there is none; Mesa 25 has none for GLX's.
  constexpr unsigned int kNoGlx = 3, kNoGlxDisplay = 4;
  const auto real = reinterpret_cast<unsigned int (*)()>(dlsym(RTLD_NEXT, "glewInit"));
  if (real == nullptr) return kNotLoaded;
  const unsigned int result = real();
  // By then the function pointers are loaded; only what concerns a display is missing, and there is none.
  return result == kNoGlx || result == kNoGlxDisplay ? 0 : result;
}
