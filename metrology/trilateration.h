#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

namespace stiffscope::metrology {

/// The trilateration frame at three points, paper equations (18)-(20), with (19) read as
/// e_y along P12 - P10 - i e_x.
struct TrilaterationFrame {
  Eigen::Vector3d ex, ey, ez;
  double d = 0.0;  ///< |P11 - P10|, (20)
  double i = 0.0;  ///< <e_x, P12 - P10>, (18)
  double j = 0.0;  ///< <e_y, P12 - P10>, (19)
};

/// Empty where the three points lie on one line.
std::optional<TrilaterationFrame> trilaterationFrame(const Eigen::Vector3d& p10, const Eigen::Vector3d& p11,
                                                     const Eigen::Vector3d& p12);

/// Both intersections of three spheres, paper (13) and (14): root [0] on the side of +e_z, [1] on that of -e_z.
struct Trilateration {
  std::array<Eigen::Vector3d, 2> roots;
  double height_squared = 0.0;  ///< z^2 of (17), m^2; negative where noise keeps the spheres from meeting: z = 0
};

/// Points on the spheres of the given radii about the three points, (13)-(20). All in one frame, m.
/// Empty where the three points lie on one line.
std::optional<Trilateration> trilaterate(const std::array<Eigen::Vector3d, 3>& points,
                                         const std::array<double, 3>& radii);

/// The root nearer to `expected`, as the paper chooses it.
Eigen::Vector3d nearerRoot(const Trilateration& both, const Eigen::Vector3d& expected);

}  // namespace stiffscope::metrology
