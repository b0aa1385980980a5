#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <nlohmann/json.hpp>

namespace stiffscope {

/// Keys stay in the order in which they are written: the same result gives the same bytes.
using Json = nlohmann::ordered_json;

/// A number, or null where it is not finite: JSON has no NaN.
inline Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

/// A vector or the rows of a matrix as (nested) arrays, each entry times `factor`.
template <class Derived>
Json array(const Eigen::MatrixBase<Derived>& values, double factor = 1.0) {
  Json list = Json::array();
  for (Eigen::Index i = 0; i < values.size(); ++i) list.push_back(number(values.derived().coeff(i) * factor));
  return list;
}

/// A rigid motion as a 4x4 matrix, rows in order, lengths in m.
inline Json matrix(const Eigen::Isometry3d& motion) {
  Json rows = Json::array();
  for (int row = 0; row < 4; ++row) rows.push_back(array(Eigen::Vector4d(motion.matrix().row(row))));
  return rows;
}

}  // namespace stiffscope
