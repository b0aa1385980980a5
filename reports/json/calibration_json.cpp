#include <cmath>

#include "core/calibration/calibrate.h"
#include "core/calibration/denavit_hartenberg.h"
#include "core/calibration/growth_from.h"
#include "core/io/units.h"
#include "reports/json/campaign_json.h"
#include "reports/json/json.h"
#include "reports/words/calibration_words.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

using calibration::ArmFit;
using frames::ArmParameters;

Json partsJson(const calibration::UnloadedDay& day, const ArmFit& fit) {
  Json parts = Json::array();
  Eigen::Index k = 0;
  for (const calibration::EffectPart& part : fit.parts) {
    Json json{{"effect", std::string(idOf(part.effect))}, {"detail", part.detail}};
    if (part.order) json["order"] = *part.order;
    if (part.from)
      json["from_s"] = day.times_known ? number(day.first_time_s + *part.from * day.time_span_s) : Json(nullptr);
    if (part.chance) json["false_alarm_probability"] = *part.chance;
    Json terms = Json::array();
    for (const calibration::EffectTerm& term : part.terms) {
      terms.push_back({{"name", term.name},
                       {"unit", term.unit},
                       {"value", number(fit.sizes[k])},
                       {"sd", number(fit.sd(static_cast<int>(fit.steps.size() + k)))},
                       {"refused", static_cast<bool>(fit.refused[static_cast<std::size_t>(k)])}});
      ++k;
    }
    json["terms"] = std::move(terms);
    parts.push_back(std::move(json));
  }
  return parts;
}

Json modelJson(const calibration::UnloadedDay& day, const calibration::ModelResult& model) {
  Json effects = Json::array();
  for (const std::string& id : effectIdsOf(model.fit)) effects.push_back(id);
  return {{"model", nameOf(model.model)},
          {"effects", effects},
          {"fitted_mm", number(model.fitted.rms / io::kMillimetre)},
          {"held_out_mm", number(model.held_out.rms / io::kMillimetre)},
          {"held_out_max_mm", number(model.held_out.largest / io::kMillimetre)},
          {"parameters", model.fit.parameters},
          {"residual_sd_beyond_tracker_mm", number(model.fit.model_sd / io::kMillimetre)},
          {"parts", partsJson(day, model.fit)},
          {"notes", words(model.notes)}};
}

/// The name of the joint whose own axis it is; of one that follows joints its own in the URDF.
const std::string& jointOfAxis(const robot::Robot& arm, std::size_t axis) {
  const int joint = arm.axes_in_base_at_zero.jointOf(static_cast<int>(axis));
  return joint >= 0 ? arm.joint_names[static_cast<std::size_t>(joint)] : arm.axis_names[axis];
}

Json axisJson(const calibration::UnloadedDay& day, const ArmFit& fit, const robot::Robot& arm, std::size_t j) {
  const metrology::Line &axis = arm.axes_in_base_at_zero[j], &nominal = day.arm.axes_in_base_at_zero[j];
  Json across = Json::array(), shift = Json::array(), tilt = Json::array(), shift_sd = Json::array(),
       tilt_sd = Json::array(), known = Json::array();
  across.push_back(array(fit.start[j].across_u));
  across.push_back(array(fit.start[j].across_v));
  for (int k = 0; k < 4; ++k) {
    const int at = static_cast<int>(4 * j) + k;
    const bool held = std::find(fit.held.begin(), fit.held.end(), at) != fit.held.end();
    (k < 2 ? shift : tilt).push_back(number(fit.steps[at] / (k < 2 ? io::kMillimetre : io::kDegree)));
    (k < 2 ? shift_sd : tilt_sd)
        .push_back(held ? Json(nullptr) : number(fit.sd(at) / (k < 2 ? io::kMillimetre : io::kDegree)));
    known.push_back(!held);
  }
  return {{"axis", j + 1},
          {"joint", jointOfAxis(day.arm, j)},
          {"point_m", array(axis.point)},
          {"direction", array(axis.direction)},
          {"nominal_point_m", array(nominal.point)},
          {"nominal_direction", array(nominal.direction)},
          {"across_u_v", across},
          {"shift_u_v_mm", shift},
          {"sd_shift_u_v_mm", shift_sd},
          {"tilt_u_v_deg", tilt},
          {"sd_tilt_u_v_deg", tilt_sd},
          {"identified_shift_u_v_tilt_u_v", known}};
}

Json linkJson(const calibration::LinkParameters& link) {
  return {{"convention", link.hayati ? "hayati" : "denavit_hartenberg"},
          {"theta_deg", link.theta / io::kDegree},
          {"d_mm", link.d / io::kMillimetre},
          {"a_mm", link.a / io::kMillimetre},
          {"alpha_deg", link.alpha / io::kDegree},
          {"beta_deg", link.beta / io::kDegree}};
}

Json parametersJson(const calibration::DenavitHartenberg& of) {
  Json links = Json::array();
  for (const calibration::LinkParameters& link : of.links) links.push_back(linkJson(link));
  return {{"base_from_first", matrix(of.base_from_first)},
          {"links", links},
          {"last_from_flange", matrix(of.last_from_flange)}};
}

/// 1/c of the joints whose compliance is in a fit, by masses of the URDF; null where it is not.
Json stiffnessJson(const ArmFit& fit) {
  Json joints = Json::array();
  for (const JointStiffness& joint : stiffnessOf(fit)) {
    joints.push_back(joint.value > 0.0 ? Json{{"nm_per_rad", joint.value}, {"sd_nm_per_rad", joint.sd}}
                                       : Json(nullptr));
  }
  return joints;
}

Json errorsJson(const calibration::PositionErrors& errors) {
  return {{"held_out_mm", number(errors.rms / io::kMillimetre)},
          {"held_out_max_mm", number(errors.largest / io::kMillimetre)}};
}

}  // namespace

Json anglesJson(const calibration::Calibration& calibration) {
  Json json{{"used", nameOf(calibration.day.angles)}};
  if (!calibration.angles) return json;
  const calibration::AngleComparison& angles = *calibration.angles;
  Json joints = Json::array();
  for (std::size_t j = 0; j < angles.joints.size(); ++j) {
    if (angles.joints[j]) joints.push_back(j + 1);
  }
  json["commanded_joints"] = std::move(joints);
  json["largest_difference_deg"] = number(angles.largest / io::kDegree);
  json["reported"] = errorsJson(angles.reported);
  json["commanded"] = errorsJson(angles.commanded);
  json["significance"] = number(angles.significance);
  json["better"] = angles.better ? Json(nameOf(*angles.better)) : Json(nullptr);
  return json;
}

Json calibrationJson(const campaign::Campaign& campaign, const calibration::Calibration& calibration,
                     const calibration::CalibrationOptions& options) {
  Json json{{"campaign", campaignJson(campaign)}, {"folds", options.folds}, {"fold_size", options.fold_size}};
  if (!calibration.reason.empty()) {
    json["unavailable"] = words(calibration.reason);
    return json;
  }
  const calibration::UnloadedDay& day = calibration.day;
  const ArmFit& fit = calibration.geometry().fit;
  const robot::Robot arm = fit.arm(day.arm);
  json["postures"] = day.postures.size();
  json["readings"] = day.readings();
  Json models = Json::array();
  for (const calibration::ModelResult& model : calibration.models) models.push_back(modelJson(day, model));
  json["models"] = models;
  json["rejected"] = rejectedJson(calibration.rejected);
  Json axes = Json::array();
  for (std::size_t j = 0; j < fit.start.size(); ++j) axes.push_back(axisJson(day, fit, arm, j));
  json["axes"] = axes;
  const ArmFit& best = calibration.best().fit;
  const robot::Robot arm_with_effects = best.arm(day.arm);
  Json with_effects = Json::array();
  for (std::size_t j = 0; j < best.start.size(); ++j) with_effects.push_back(axisJson(day, best, arm_with_effects, j));
  json["axes_with_effects"] = with_effects;
  const calibration::GrowthFrom growth = calibration::growthFrom(campaign, calibration);
  if (growth.temperature_c) json["axes_with_effects_at_temperature_c"] = number(*growth.temperature_c);
  if (growth.first_posture) json["axes_with_effects_at_s"] = day.times_known ? number(day.first_time_s) : Json(nullptr);
  json["not_identifiable"] = words(calibration.not_identifiable);
  json["base_link_from_tracker"] = matrix(fit.basePointsMotion());
  json["base_link_from_flange_at_zero"] = matrix(arm.base_from_flange_at_zero);
  Json targets = Json::object();
  const std::vector<Eigen::Vector3d> at_zero = fit.targetsAtZero();
  for (std::size_t t = 0; t < at_zero.size(); ++t) {
    targets[day.targets[t]] =
        array(Eigen::Vector3d(arm.base_from_flange_at_zero.inverse() * at_zero[t]), 1.0 / io::kMillimetre);
  }
  json["targets_in_flange_mm"] = targets;
  json["link_parameters"] = {{"calibrated", parametersJson(calibration::denavitHartenberg(arm, day.arm))},
                             {"nominal", parametersJson(calibration::denavitHartenberg(day.arm, day.arm))}};
  json["masses_known"] = day.masses_known;
  json["stiffness_by_own_weight"] = day.masses_known ? stiffnessJson(best) : Json(nullptr);
  json["joint_angles"] = anglesJson(calibration);
  std::vector<std::string> notes = words(calibration.notes);
  if (std::string from = growthFromWords(growth); !from.empty()) notes.insert(notes.begin(), std::move(from));
  if (std::string caution = geometryCaution(calibration); !caution.empty())
    notes.insert(notes.begin(), std::move(caution));
  json["notes"] = std::move(notes);
  return json;
}

}  // namespace stiffscope::reports
