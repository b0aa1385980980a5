#pragma once

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <vector>

namespace stiffscope::metrology {

/// An infinite, directed line: a joint axis, or the intersection of two planes.
/// `point` is any point on it (m), `direction` has unit length; both in one frame that the name of the
/// variable states (`axes_in_base`).
struct Line {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
};

/// A measured line with its uncertainty. The four degrees of freedom of a line are taken at `line.point`:
/// shifts along `across_u` and `across_v` (m), then tilts of the direction towards them (rad).
/// `covariance` is that of (shift_u, shift_v, tilt_u, tilt_v).
struct MeasuredLine {
  Line line;
  Eigen::Vector3d across_u = Eigen::Vector3d::UnitX();
  Eigen::Vector3d across_v = Eigen::Vector3d::UnitY();
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();

  /// The line moved by a small step of its four parameters.
  Line moved(const Eigen::Vector4d& step) const;

  /// The same line directed the other way: its tilts change their sign, so that their covariance with the shifts does.
  MeasuredLine reversed() const;

  /// The four parameters that bring the line onto another nearby, whichever way that one is directed: what `moved`
  /// undoes.
  Eigen::Vector4d stepTo(const Line& other) const;
};

/// Two unit vectors that make a right-handed frame (u, v, direction).
void basisAcross(const Eigen::Vector3d& direction, Eigen::Vector3d& u, Eigen::Vector3d& v);

/// Where a point lies about an axis. Radius and height in extended precision: residuals are made of them.
struct PlaceAboutAxis {
  long double radius = 0.0L, height = 0.0L;
  double outward_u = 1.0,
         outward_v = 0.0;  ///< components of the unit vector outward; towards u on the axis itself
};

/// A line that a fit moves, with a basis (across_u, across_v, direction). On machines whose long double is no
/// longer than double the fits lose about the digits that short arcs cost; nothing else changes.
class AxisFrame {
 public:
  AxisFrame(const Eigen::Vector3d& point, const Eigen::Vector3d& direction);

  const Eigen::Vector3d& point() const { return axis_.line.point; }
  const Eigen::Vector3d& direction() const { return axis_.line.direction; }
  const Eigen::Vector3d& u() const { return axis_.across_u; }
  const Eigen::Vector3d& v() const { return axis_.across_v; }
  const MeasuredLine& measured() const { return axis_; }

  /// Along the direction, from point().
  long double heightOf(const Eigen::Vector3d& at) const {
    long double height = 0.0L;
    for (int k = 0; k < 3; ++k) height += exact_[k] * (static_cast<long double>(at[k]) - axis_.line.point[k]);
    return height;
  }

  PlaceAboutAxis placeOf(const Eigen::Vector3d& at) const {
    const long double x = static_cast<long double>(at.x()) - axis_.line.point.x();
    const long double y = static_cast<long double>(at.y()) - axis_.line.point.y();
    const long double z = static_cast<long double>(at.z()) - axis_.line.point.z();
    PlaceAboutAxis place;
    place.height = exact_[0] * x + exact_[1] * y + exact_[2] * z;
    const long double rx = x - place.height * exact_[0], ry = y - place.height * exact_[1],
                      rz = z - place.height * exact_[2];
    place.radius = std::sqrt(rx * rx + ry * ry + rz * rz);
    if (place.radius > 0.0L) {
      const Eigen::Vector3d radial(static_cast<double>(rx), static_cast<double>(ry), static_cast<double>(rz));
      const double inverse = 1.0 / static_cast<double>(place.radius);
      place.outward_u = inverse * radial.dot(axis_.across_u);
      place.outward_v = inverse * radial.dot(axis_.across_v);
    }
    return place;
  }

  /// By the four parameters of a line: (shift_u, shift_v, tilt_u, tilt_v).
  void move(const Eigen::Vector4d& step);

 private:
  void setBasis();
  MeasuredLine axis_;
  long double exact_[3];  ///< the direction with its length divided out beyond double precision
};

/// The unit vector with its largest component positive: lines and planes have no sense of their own.
Eigen::Vector3d largestPositive(const Eigen::Vector3d& direction);

/// The shortest segment between two lines.
struct CommonPerpendicular {
  Eigen::Vector3d foot_on_first;
  Eigen::Vector3d foot_on_second;
  double distance = 0.0;  ///< between the feet, m
  double angle = 0.0;     ///< between the lines, rad, 0..pi/2
};

/// Feet are undetermined for parallel lines and ill-determined near that: for lines within a degree of parallel
/// use distanceAcross at a stated point instead (Hayati's convention).
CommonPerpendicular commonPerpendicular(const Line& first, const Line& second);

/// Distance from `at_point` on the first line to the second line's piercing point through the plane normal to
/// the first line at that point (m). Stays well determined when the lines are parallel.
double distanceAcross(const Line& first, const Line& second, const Eigen::Vector3d& at_point);

/// Angle between two lines, rad, 0..pi/2; accurate for small angles too.
double angleBetween(const Line& first, const Line& second);

/// rad: lines within a degree count as parallel; where their common perpendicular stands is undetermined.
inline constexpr double kNearParallel = std::numbers::pi / 180.0;

/// The point of the line nearest to `point`.
Eigen::Vector3d nearestPoint(const Line& line, const Eigen::Vector3d& point);

using LineNumbers = std::function<Eigen::VectorXd(const std::vector<Line>&)>;

/// Derivatives of numbers that depend on lines by the lines' parameters, by central differences: a row a number, four
/// columns a line in the order of MeasuredLine (shift_u, shift_v by m, tilt_u, tilt_v by rad). Meant for numbers that
/// are smooth over micrometres.
Eigen::MatrixXd derivativesByLines(const std::vector<MeasuredLine>& lines, const LineNumbers& numbers);

using LinePairNumber = std::function<double(const Line&, const Line&)>;

/// The distance of two lines with a sign, along their common normal as it stands now: near these two lines it is
/// their distance, and unlike that it is smooth where they meet. Not for parallel lines.
LinePairNumber signedDistance(const Line& first, const Line& second);

/// The angle between two lines as the tilt about `normal`: the angle has no derivative where it is 0, the tilt has.
/// Near `first` and `second`, whose directions may run either way: at a right angle their tilt goes on beyond it.
LinePairNumber tiltAbout(const Eigen::Vector3d& normal, const Line& first, const Line& second);

/// The common normal about which the angle of two lines is their tilt; exactly parallel lines have none: empty.
std::optional<Eigen::Vector3d> commonNormal(const Line& first, const Line& second);

}  // namespace stiffscope::metrology
