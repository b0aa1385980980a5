#include "render/vtk/chart_frame.h"

namespace stiffscope {

TextStyle titleStyle(const Canvas& canvas) { return {22 * canvas.unit(), true, canvas.palette().ink}; }
TextStyle subtitleStyle(const Canvas& canvas) { return {15 * canvas.unit(), false, canvas.palette().faint_ink}; }
TextStyle axisTitleStyle(const Canvas& canvas) { return {16 * canvas.unit(), false, canvas.palette().ink}; }
TextStyle labelStyle(const Canvas& canvas) { return {14 * canvas.unit(), false, canvas.palette().ink}; }
TextStyle noteStyle(const Canvas& canvas) { return {12.5 * canvas.unit(), false, canvas.palette().faint_ink}; }

}  // namespace stiffscope
