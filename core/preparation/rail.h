#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "core/campaign/campaign.h"
#include "metrology/measured_points.h"

namespace stiffscope::preparation {

/// How the carriage of a rail goes through the frame of the points, by the day's rail sweep: a straight line.
struct RailCourse {
  Eigen::Vector3d per_metre = Eigen::Vector3d::Zero();   ///< displacement for a metre that the controller reports, m/m
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of per_metre, with what the rail is not straight
  /// Of where one stop of the carriage stands off the line, beyond what noise does, m^2: common to all reflectors.
  Eigen::Matrix3d of_stop = Eigen::Matrix3d::Zero();
  double lowest = 0.0, highest = 0.0;        ///< reported positions of the sweep, m
  double along_rms = 0.0, across_rms = 0.0;  ///< of what is left, along the line and across it, m
  double farthest = 0.0;                     ///< of one reading from its place, m
  std::string farthest_file;
  std::size_t farthest_line = 0;
  int readings = 0;

  /// True travel over what is reported.
  double scale() const { return per_metre.norm(); }
  double scaleSd() const;
};

/// Least squares of p = a_t + r d over the rail sweep's readings: a_t the place of reflector t with the carriage at
/// zero, r the reported position, d what is asked for. Weighted by the noise where it is known; the covariance is
/// scaled by the residual variance where that is larger. Assumes joints that stand still and a carriage that does not
/// turn: a turn by phi of an arm that reaches L moves a reflector by phi L, which is in what is left. What the stops'
/// means scatter beyond their noise, along the line and in two directions across it alike, is `of_stop`. Empty without
/// a rail sweep of two positions at least.
std::optional<RailCourse> fitRailCourse(const campaign::Campaign& campaign,
                                        const std::optional<metrology::TrackerNoise>& noise);

/// Refers the arm's readings to the carriage at zero: p - r d, in the tracker's frame by the course that was measured,
/// in base_link's by the URDF's direction. Without a course (checkCampaign has then seen that the carriage stood still)
/// readings in the tracker's frame stay as they are. Where the instrument stood (`from`) goes with the point,
/// so that its noise stays that of the sight. The rows' `rail` is 0 afterwards, `carriage` what it was, and poses that
/// the controller states are dropped where the carriage went from one posture to another: nothing says whether they
/// count it in. Nests and the rail sweep itself are left. For a robot without a rail nothing happens.
void referToCarriageAtZero(const std::optional<RailCourse>& course, campaign::Campaign& campaign);

/// Takes that back, by the same course: readings are where they were read, `rail` what was reported.
void referToWhereItStood(const std::optional<RailCourse>& course, campaign::Campaign& campaign);

}  // namespace stiffscope::preparation
