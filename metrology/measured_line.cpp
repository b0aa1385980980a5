#include "metrology/measured_line.h"

#include <Eigen/Geometry>

namespace stiffscope {

Line MeasuredLine::moved(const Eigen::Vector4d& step) const {
  return {line.point + step[0] * across_u + step[1] * across_v,
          (line.direction + step[2] * across_u + step[3] * across_v).normalized()};
}

void basisAcross(const Eigen::Vector3d& direction, Eigen::Vector3d& u, Eigen::Vector3d& v) {
  u = direction.unitOrthogonal();
  v = direction.cross(u);
}

}  // namespace stiffscope
