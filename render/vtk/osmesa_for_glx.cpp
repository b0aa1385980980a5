// Lets a VTK that was built for X (Debian's) work on an OSMesa context, without a display. Its GLEW asks GLX
// for function pointers; these answer in its stead. They must come before libGLX in the order of symbol look-up, which
// they do as members of the module that brings VTK in, or, where that is loaded without RTLD_DEEPBIND, of the program.

#include <GL/osmesa.h>

#define STIFFSCOPE_EXPORT extern "C" __attribute__((visibility("default")))

using GlFunction = void (*)();

STIFFSCOPE_EXPORT GlFunction glXGetProcAddressARB(const unsigned char* name) {
  return OSMesaGetProcAddress(reinterpret_cast<const char*>(name));
}

STIFFSCOPE_EXPORT GlFunction glXGetProcAddress(const unsigned char* name) { return glXGetProcAddressARB(name); }
