#pragma once

namespace stiffscope {

/// Throws NoDisplay, with the reason, where VTK would end the process: DISPLAY names no X server that
/// answers, or one without GLX or without an OpenGL 3.2 core context.
void requireDisplay();

}  // namespace stiffscope
