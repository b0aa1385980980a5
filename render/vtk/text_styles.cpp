#include "render/vtk/chart_frame.h"

namespace stiffscope {

// A report shows a picture of 1200 pixels about 700 wide, and prints it 16 cm wide: 17 pixels are then 10 on the screen
// and 6.5 points on paper.

TextStyle titleStyle(const Canvas& canvas) { return {24 * canvas.unit(), true, canvas.palette().ink}; }
TextStyle subtitleStyle(const Canvas& canvas) { return {17 * canvas.unit(), false, canvas.palette().faint_ink}; }
TextStyle axisTitleStyle(const Canvas& canvas) { return {18.5 * canvas.unit(), false, canvas.palette().ink}; }
TextStyle labelStyle(const Canvas& canvas) { return {17 * canvas.unit(), false, canvas.palette().ink}; }
TextStyle noteStyle(const Canvas& canvas) { return {15 * canvas.unit(), false, canvas.palette().faint_ink}; }

}  // namespace stiffscope
