#pragma once

#include <optional>
#include <string>

#include "metrology/axis_models.h"

namespace stiffscope {

/// The start of a fit of circles about one axis: across the axis the plane in which the points spread most
/// about their groups' means, in it Taubin's common centre. Groups of fewer than three points take no part.
/// Empty, with the reason, where the points lie on one line.
std::optional<CirclesModel> circlesStart(const LocalPoints& local, std::string& reason);

/// Mean radius and height of each group about the axis.
Eigen::Matrix2Xd firstOwn(const CirclesModel& model, const LocalPoints& local);

}  // namespace stiffscope
