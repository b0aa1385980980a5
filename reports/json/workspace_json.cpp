#include "core/workspace/workspace_stiffness.h"
#include "reports/json/json.h"

#include <cmath>
#include <utility>

#include "core/io/units.h"
#include "reports/json/campaign_json.h"
#include "reports/words/names.h"
#include "reports/words/workspace_words.h"

namespace stiffscope::reports {

namespace {

Json principalsJson(const std::vector<workspace::DirectionalCompliance>& found) {
  Json list = Json::array();
  for (const workspace::DirectionalCompliance& one : found) {
    const identification::CoverageInterval interval = one.stiffnessInterval();
    list.push_back({{"stiffness_n_per_m", number(one.stiffness())},
                    {"interval_n_per_m", Json::array({number(interval.low), number(interval.high)})},
                    {"direction", array(one.direction)}});
  }
  return list;
}

Json complianceJson(const Eigen::Matrix3d& compliance) {
  Json rows = Json::array();
  for (int row = 0; row < 3; ++row) rows.push_back(array(Eigen::Vector3d(compliance.row(row))));
  return rows;
}

Json pointJson(Json json, const workspace::PointStiffness& place) {
  json["q_deg"] = array(place.q, 1.0 / io::kDegree);
  json["tcp_m"] = array(place.tcp);
  json["conditioning"] = number(place.conditioning);
  json["unknown_joints"] = jointNumbers(place.unknown);
  json["k_x"] = principalsJson(place.of_springs);
  json["model"] = principalsJson(place.of_model);
  json["k_x_compliance_m_per_n"] = complianceJson(place.springs);
  json["model_compliance_m_per_n"] = complianceJson(place.model);
  return json;
}

Json sliceJson(const workspace::StiffnessSlice& slice, SlicePlaces kept) {
  Json json{{"pose", slice.pose},
            {"azimuth_deg", slice.azimuth / io::kDegree},
            {"spacing_mm", slice.spacing / io::kMillimetre}};
  if (kept == SlicePlaces::left_out) return json;
  Json places = Json::array();
  for (const workspace::SlicePlace& one : slice.places)
    places.push_back(
        pointJson({{"radius_mm", one.radius / io::kMillimetre}, {"height_mm", one.height / io::kMillimetre}}, one.at));
  json["places"] = std::move(places);
  return json;
}

Json placementJson(const workspace::PlacementStudy& study) {
  Json offsets = Json::array();
  for (const workspace::Placement& one : study.placements) {
    Json offset{{"offset", one.offset.id},
                {"by_mm", array(one.offset.by, 1.0 / io::kMillimetre)},
                {"postures_reached", one.reached},
                {"judged", one.judged()}};
    if (one.judged()) {
      offset["deflection_mm"] = number(one.deflection() / io::kMillimetre);
      offset["u_deflection_mm"] = number(one.prediction.tcp.expanded / io::kMillimetre);
      offset["deflection_vector_mm"] = array(one.prediction.tcp.deflection, 1.0 / io::kMillimetre);
      offset["worst_pose"] = one.worst;
    } else {
      offset["reason"] = notJudgedWords(one, study.postures.size());
    }
    offsets.push_back(std::move(offset));
  }
  Json poses = Json::array();
  for (const workspace::NamedPosture& one : study.postures) poses.push_back(one.pose);
  return {{"force_n", array(study.force)},
          {"workpiece", poses},
          {"best", study.best ? Json(study.placements[*study.best].offset.id) : Json(nullptr)},
          {"now", study.now ? Json(study.placements[*study.now].offset.id) : Json(nullptr)},
          {"text", placementWords(study)},
          {"offsets", offsets}};
}

}  // namespace

Json workspaceJson(const workspace::WorkspaceStiffness& found, SlicePlaces places) {
  Json held = Json::array();
  for (const effects::Effect effect : found.held) held.push_back(std::string(effects::idOf(effect)));
  Json postures = Json::array();
  for (const workspace::PointStiffness& one : found.postures) postures.push_back(pointJson({{"pose", one.pose}}, one));
  Json json{{"method", namesOf(found.method).key},    {"frame", "r0"},
            {"model_holds_besides_joints", held},     {"unknown_joints", jointNumbers(found.unknown)},
            {"notes", workspaceNotes(found)},         {"postures", postures},
            {"slice", sliceJson(found.slice, places)}};
  if (found.placement) json["placement"] = placementJson(*found.placement);
  return json;
}

}  // namespace stiffscope::reports
