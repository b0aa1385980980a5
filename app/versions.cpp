#include "app/versions.h"

#include <Eigen/Core>
#include <fmt/format.h>

namespace stiffscope::app {

std::vector<reports::NamedText> versions() {
  return {{"stiffscope", STIFFSCOPE_VERSION},
          {"Eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
          {"Ceres Solver", STIFFSCOPE_CERES_VERSION},
          {"VTK", STIFFSCOPE_VTK_VERSION}};
}

}  // namespace stiffscope::app
