#pragma once

#include <string>

class vtkRenderWindow;
class vtkRenderWindowInteractor;

namespace stiffscope::render {

/// Throws NoDisplay, with the reason, where VTK would end the process: DISPLAY names no X server that
/// answers, or one without GLX or without an OpenGL 3.2 core context.
void requireDisplay();

/// The window's name for the window manager, UTF-8.
void nameWindow(vtkRenderWindow& window, const std::string& name);

/// A key press or a move of the pointer is waiting: what is drawn now would be old at once.
bool inputWaits(vtkRenderWindow& window);

/// The key of a KeyPressEvent, as ArmWindow::Events has it.
std::string keyName(vtkRenderWindowInteractor& interactor);

}  // namespace stiffscope::render
