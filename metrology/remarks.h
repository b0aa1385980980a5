#pragma once

namespace stiffscope::metrology {

/// What the fits and registrations say of their results: why there is none, and how one was found. Without values
/// where none are named.
enum class RemarkId {
  // of readings, whatever is fitted to them
  no_readings,       ///< none given
  too_few_readings,  ///< readings needed, readings given
  reading_not_finite,
  covariances_not_one_a_reading,
  covariance_not_positive_definite,
  readings_in_one_place,
  squares_beyond_double,  ///< readings too large or too small
  readings_too_far_out,   ///< their spread is lost in double precision
  readings_on_one_line,
  readings_contradict,  ///< more than a third of them
  // of an estimate
  parameter_free,
  does_not_settle,
  // of a shape
  direction_spread_alike,       ///< of a line
  direction_scatter_as_spread,  ///< of a line
  normal_on_one_line,           ///< exactly
  normal_on_line_in_scatter,    ///< within the scatter
  normal_spread_alike,          ///< of a plane
  radius_of_straight_line,      ///< an arc too short for its scatter
  radius_of_plane,              ///< a cap or strip too narrow for its scatter
  centre_in_one_plane,          ///< of a sphere
  axis_in_one_plane,            ///< of a cylinder
  axis_on_one_line,             ///< of a cylinder
  axis_direction_in_scatter,    ///< of a cylinder
  no_nearest_cylinder,
  two_cylinders_alike,
  // of circles about one axis, and spheres about one centre, of several reflectors
  no_reflector_with_three,     ///< of circles
  reflector_without_readings,  ///< of circles
  too_few_for_axis,
  axis_not_determined,
  reflector_under_four,    ///< of spheres
  reflector_in_one_plane,  ///< of spheres
  too_few_for_centre,
  centre_not_determined,
  // of a registration
  too_few_common_points,
  points_on_one_line,
  covariances_not_one_a_pair,
  motion_not_determined,
  // how a shape was found: which distances are least, from which start
  line_orthogonal,
  plane_orthogonal,
  circle_in_space,
  circle_plane_first,
  sphere_radial,
  cylinder_least_sum
};

}  // namespace stiffscope::metrology
