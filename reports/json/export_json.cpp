#include "reports/json/export_json.h"

#include "reports/json/campaign_json.h"
#include "reports/words/names.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

const char* kindOf(elastic_model::ChainJoint::Kind kind) {
  using enum elastic_model::ChainJoint::Kind;
  return kind == drive ? "drive" : kind == turn_spring ? "turn_spring" : "shift_spring";
}

Json chainJointJson(const elastic_model::ChainBody& body, const elastic_model::ChainJoint& joint) {
  using enum elastic_model::ChainJoint::Kind;
  Json json{{"name", joint.name}, {"body", body.name}, {"kind", kindOf(joint.kind)}};
  if (joint.kind == drive) return json;
  json["stiffness"] = number(joint.stiffness);
  json["unit"] = joint.kind == turn_spring ? "N m/rad" : "N/m";
  return json;
}

Json siteJson(const elastic_model::ElasticChain& chain, const elastic_model::ChainSite& site) {
  return {{"name", site.name},
          {"body", site.body < 0 ? chain.base : chain.bodies[static_cast<std::size_t>(site.body)].name},
          {"xyz_m", array(Eigen::Vector3d(site.base_from_site.translation()))}};
}

}  // namespace

Json exportJson(const campaign::Campaign& campaign, const ExportedModel& exported) {
  const elastic_model::ElasticChain& chain = exported.model.chain;
  Json joints = Json::array(), sites = Json::array();
  for (const elastic_model::ChainBody& body : chain.bodies) {
    for (const elastic_model::ChainJoint& joint : body.joints) joints.push_back(chainJointJson(body, joint));
  }
  for (const elastic_model::ChainSite& site : chain.sites) sites.push_back(siteJson(chain, site));
  return {{"campaign", campaignJson(campaign)},
          {"method", namesOf(exported.method).key},
          {"format", exported.format},
          {"file", exported.file},
          {"frame", "base_link"},
          {"gravity_m_s2", array(chain.gravity)},
          {"joints", joints},
          {"sites", sites},
          {"remarks", words(exported.model.remarks)}};
}

Json urdfExportJson(const campaign::Campaign& campaign, const std::string& file, bool by_postures) {
  return {{"campaign", campaignJson(campaign)},
          {"format", "urdf"},
          {"file", file},
          {"geometry", by_postures ? "unloaded_postures" : "sweeps"}};
}

}  // namespace stiffscope::reports
