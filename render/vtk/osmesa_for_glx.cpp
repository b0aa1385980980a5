// Lets a VTK that was built for X (Debian's) work on an OSMesa context, without a display. Its GLEW asks GLX
// for function pointers; these answer in its stead. They must come before libGLX and libGLEW in the order of
// symbol look-up, which they do as members of the module that brings VTK in.

#include <GL/osmesa.h>
#include <dlfcn.h>

#define STIFFSCOPE_EXPORT extern "C" __attribute__((visibility("default")))

using GlFunction = void (*)();

STIFFSCOPE_EXPORT GlFunction glXGetProcAddressARB(const unsigned char* name) {
  return OSMesaGetProcAddress(reinterpret_cast<const char*>(name));
}

STIFFSCOPE_EXPORT GlFunction glXGetProcAddress(const unsigned char* name) {
  return glXGetProcAddressARB(name);
}

STIFFSCOPE_EXPORT unsigned int glewInit() {
  constexpr unsigned int kNotLoaded = 1;
  constexpr unsigned int kNoGlxDisplay = 4;
  const auto real = reinterpret_cast<unsigned int (*)()>(dlsym(RTLD_NEXT, "glewInit"));
  if (real == nullptr) return kNotLoaded;
  const unsigned int result = real();
  // By then the function pointers are loaded; only what concerns a display is missing, and there is none.
  return result == kNoGlxDisplay ? 0 : result;
}
