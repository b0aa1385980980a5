#include "render/vtk/chart_frame.h"

namespace stiffscope {

TextStyle titleStyle(const Canvas& canvas) { return {22 * canvas.unit(), true, colours::kInk}; }
TextStyle subtitleStyle(const Canvas& canvas) { return {15 * canvas.unit(), false, colours::kFaintInk}; }
TextStyle axisTitleStyle(const Canvas& canvas) { return {16 * canvas.unit(), false, colours::kInk}; }
TextStyle labelStyle(const Canvas& canvas) { return {14 * canvas.unit(), false, colours::kInk}; }
TextStyle noteStyle(const Canvas& canvas) { return {12.5 * canvas.unit(), false, colours::kFaintInk}; }

}  // namespace stiffscope
