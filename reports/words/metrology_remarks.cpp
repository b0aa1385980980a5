#include <fmt/format.h>

#include "metrology/remarks.h"
#include "reports/words/remarks.h"

namespace stiffscope::reports {

std::string metrologyWords(metrology::RemarkId id, const RemarkValues& values) {
  using metrology::RemarkId;
  switch (id) {
    case RemarkId::no_readings:
      return "no readings";
    case RemarkId::too_few_readings:
      return fmt::format("{} readings or more are needed, {} {} given", values.count(0), values.count(1),
                         values.count(1) == 1 ? "is" : "are");
    case RemarkId::reading_not_finite:
      return "a reading is not a finite number";
    case RemarkId::covariances_not_one_a_reading:
      return "the covariances are not one a reading";
    case RemarkId::covariance_not_positive_definite:
      return "a reading's covariance is not positive definite";
    case RemarkId::readings_in_one_place:
      return "the readings all lie in one place";
    case RemarkId::squares_beyond_double:
      return "the readings are too large or too small for squares in double precision";
    case RemarkId::readings_too_far_out:
      return "the readings lie so far from the origin that double precision does not hold their spread";
    case RemarkId::readings_on_one_line:
      return "the readings lie on one line";
    case RemarkId::readings_contradict:
      return "more than a third of the readings contradict the others: it cannot be told which are wrong";
    case RemarkId::parameter_free:
      return "the readings leave a parameter of the shape free";
    case RemarkId::does_not_settle:
      return "no shape of this kind is nearest to the readings: the fit does not settle";
    case RemarkId::direction_spread_alike:
      return "the direction is undetermined: the readings spread alike in two directions, within their scatter";
    case RemarkId::direction_scatter_as_spread:
      return "the direction is undetermined: the readings scatter across as they spread along";
    case RemarkId::normal_on_one_line:
      return "the normal is undetermined: the readings lie on one line";
    case RemarkId::normal_on_line_in_scatter:
      return "the normal is undetermined: the readings lie on one line within their scatter";
    case RemarkId::normal_spread_alike:
      return "the normal is undetermined: the readings spread alike in two directions, within their scatter";
    case RemarkId::radius_of_straight_line:
      return "the radius is undetermined: against their scatter the readings could lie on a straight line";
    case RemarkId::radius_of_plane:
      return "the radius is undetermined: against their scatter the readings could lie in a plane";
    case RemarkId::centre_in_one_plane:
      return "the centre is undetermined: the readings lie in one plane";
    case RemarkId::axis_in_one_plane:
      return "the axis is undetermined: the readings lie in one plane";
    case RemarkId::axis_on_one_line:
      return "the axis is undetermined: the readings lie on one line";
    case RemarkId::axis_direction_in_scatter:
      return "the direction of the axis is undetermined against the scatter of the readings";
    case RemarkId::no_nearest_cylinder:
      return "no cylinder is nearest to the readings: the fit does not settle";
    case RemarkId::two_cylinders_alike:
      return "two different cylinders fit the readings alike";
    case RemarkId::no_reflector_with_three:
      return "no reflector has three readings or more";
    case RemarkId::reflector_without_readings:
      return "a reflector has no readings";
    case RemarkId::too_few_for_axis:
      return "too few readings for an axis with its uncertainty";
    case RemarkId::axis_not_determined:
      return "the readings do not determine the axis";
    case RemarkId::reflector_under_four:
      return "fewer than four readings of a reflector";
    case RemarkId::reflector_in_one_plane:
      return "the readings of a reflector lie in one plane";
    case RemarkId::too_few_for_centre:
      return "too few readings for a centre with its uncertainty";
    case RemarkId::centre_not_determined:
      return "the readings do not determine the centre";
    case RemarkId::too_few_common_points:
      return "fewer than three common points";
    case RemarkId::points_on_one_line:
      return "the points lie on one line";
    case RemarkId::covariances_not_one_a_pair:
      return "the covariances are not one a pair";
    case RemarkId::motion_not_determined:
      return "the points do not determine the motion";
    case RemarkId::line_orthogonal:
      return "orthogonal distances, Gauss-Newton from the first principal axis";
    case RemarkId::plane_orthogonal:
      return "orthogonal distances, Gauss-Newton from the last principal axis";
    case RemarkId::circle_in_space:
      return "full: orthogonal distances in space, Gauss-Newton from Taubin's circle";
    case RemarkId::circle_plane_first:
      return "plane-first: a plane by orthogonal distances, then a circle in it by radial ones";
    case RemarkId::sphere_radial:
      return "orthogonal distances, Gauss-Newton from Taubin's sphere";
    case RemarkId::cylinder_least_sum:
      return "orthogonal distances, Gauss-Newton from each algebraic minimum, the least sum";
  }
  return {};
}

}  // namespace stiffscope::reports
