#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "metrology/circle_fit.h"
#include "metrology/cylinder_fit.h"
#include "metrology/line_fit.h"
#include "metrology/plane_fit.h"
#include "metrology/robust_fit.h"
#include "metrology/sphere_fit.h"
#include "reports/json/json_document.h"

namespace stiffscope::reports {

/// What data snooping left out (see metrology/robust_fit.h).
struct Snooping {
  double family_level = 0.0, critical_w = 0.0;
  std::vector<metrology::RejectedReading> rejected;
};

/// A shape fitted to the points of a file, all in the file's own length unit.
struct ShapeFit {
  std::string shape;       ///< line, plane, circle, sphere or cylinder
  std::size_t points = 0;  ///< that were fitted
  std::variant<metrology::FittedLine, metrology::FittedPlane, metrology::FittedCircle, metrology::FittedSphere,
               metrology::FittedCylinder>
      fit;
  std::optional<Snooping> snooping;  ///< where it was asked for

  const metrology::FitQuality& quality() const;
};

/// Keys of the shape (center or point, normal or axis, radius), rms, points, covariance with its order in
/// parameters, method. Undetermined: determined false and reason, and no number of the shape. `covariance` is
/// null, with covariance_reason, where an exact fit leaves nothing to tell it by.
Json fitJson(const ShapeFit& fitted);

}  // namespace stiffscope::reports
