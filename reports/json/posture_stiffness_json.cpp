#include "reports/json/posture_stiffness_json.h"

namespace stiffscope {

namespace {

Json principalJson(const CartesianStiffness& stiffness) {
  Json principal = Json::array();
  for (const PrincipalStiffness& one : stiffness.principal) {
    principal.push_back({{"stiffness_n_per_m", number(one.stiffness)}, {"direction", array(one.direction)}});
  }
  return principal;
}

}  // namespace

Json postureStiffnessJson(const std::vector<PostureStiffness>& postures) {
  Json rows = Json::array();
  for (const PostureStiffness& one : postures) {
    Json rigid = Json::array();
    for (const int joint : one.rigid_joints) rigid.push_back(joint + 1);
    rows.push_back({{"pose", one.pose},
                    {"kappa", number(one.conditioning.kappa)},
                    {"kappa_2_norm", number(one.conditioning.kappa_two)},
                    {"k_x", principalJson(one.with_kc)},
                    {"k_x_without_kc", principalJson(one.without_kc)},
                    {"anisotropy", number(one.with_kc.anisotropy())},
                    {"kc_share", number(one.kc_share)},
                    {"joints_taken_as_rigid", rigid}});
  }
  return rows;
}

}  // namespace stiffscope
