#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace stiffscope::reports {

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

/// A list whose rows are made as they are written: of a long day they would be most of the memory.
struct JsonRows {
  std::size_t count = 0;
  std::function<Json(std::size_t)> row;  ///< by its index; called on several threads at once
};

/// A JSON value with lists in it that are not made yet. What their rows are made from must live as long.
class JsonDocument {
 public:
  JsonDocument(Json values = nullptr) : json(std::move(values)) {}

  Json json;  ///< null where a list will stand

  /// Makes `key` of this object a list of those rows.
  void setRows(const std::string& key, JsonRows rows) {
    json[key] = nullptr;
    rows_.emplace_back(Json::json_pointer() / key, std::move(rows));
  }

  /// Makes the value at `place`, which the parts before its end have to have, that document.
  void set(const Json::json_pointer& place, JsonDocument part) {
    json[place] = std::move(part.json);
    for (auto& [inner, rows] : part.rows_) rows_.emplace_back(place / inner, std::move(rows));
  }

  /// The list that is to stand there; null where the value itself does.
  const JsonRows* rowsAt(const Json::json_pointer& place) const {
    for (const auto& [at, rows] : rows_) {
      if (at == place) return &rows;
    }
    return nullptr;
  }

 private:
  std::vector<std::pair<Json::json_pointer, JsonRows>> rows_;
};

}  // namespace stiffscope::reports
