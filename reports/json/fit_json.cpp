#include "reports/json/fit_json.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

void addShape(const metrology::FittedLine& fit, Json& json) {
  json["point"] = array(fit.line.point);
  json["axis"] = array(fit.line.direction);
}

void addShape(const metrology::FittedPlane& fit, Json& json) {
  json["point"] = array(fit.plane.point);
  json["normal"] = array(fit.plane.normal);
}

void addShape(const metrology::FittedCircle& fit, Json& json) {
  json["center"] = array(fit.circle.centre);
  json["normal"] = array(fit.circle.normal);
  json["radius"] = number(fit.circle.radius);
}

void addShape(const metrology::FittedSphere& fit, Json& json) {
  json["center"] = array(fit.sphere.centre);
  json["radius"] = number(fit.sphere.radius);
}

void addShape(const metrology::FittedCylinder& fit, Json& json) {
  json["point"] = array(fit.cylinder.axis.point);
  json["axis"] = array(fit.cylinder.axis.direction);
  json["radius"] = number(fit.cylinder.radius);
}

template <class Fit>
void addFit(const Fit& fit, Json& json) {
  json["determined"] = fit.determined;
  if (!fit.determined) {
    json["reason"] = words(fit.reason);
    return;
  }
  addShape(fit, json);
  json["rms"] = number(fit.rms);
  json["residual_sd"] = fit.degrees_of_freedom > 0 ? number(fit.residual_sd) : Json(nullptr);
  json["degrees_of_freedom"] = fit.degrees_of_freedom;
  json["parameters"] = fit.kParameters;
  if (fit.covariance) {
    Json rows = Json::array();
    for (Eigen::Index row = 0; row < fit.covariance->rows(); ++row) rows.push_back(array(fit.covariance->row(row)));
    json["covariance"] = rows;
  } else {
    json["covariance"] = nullptr;
    json["covariance_reason"] = "the shape is exact through the points: no residuals tell its uncertainty";
  }
}

Json snoopingJson(const Snooping& snooping) {
  Json json{{"family_level", snooping.family_level}, {"critical_w", number(snooping.critical_w)}};
  json["rejected"] = Json::array();
  for (const metrology::RejectedReading& one : snooping.rejected) {
    json["rejected"].push_back(
        {{"point", one.index + 1}, {"w", number(one.w)}, {"critical_w", number(one.critical_w)}});
  }
  return json;
}

}  // namespace

const metrology::FitQuality& ShapeFit::quality() const {
  return std::visit([](const auto& one) -> const metrology::FitQuality& { return one; }, fit);
}

Json fitJson(const ShapeFit& fitted) {
  Json json{{"shape", fitted.shape}, {"points", fitted.points}, {"method", words(fitted.quality().method)}};
  std::visit([&json](const auto& one) { addFit(one, json); }, fitted.fit);
  if (fitted.snooping) json["snooping"] = snoopingJson(*fitted.snooping);
  return json;
}

}  // namespace stiffscope::reports
