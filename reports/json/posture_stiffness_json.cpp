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

Json postureStiffnessJson(const PostureStiffness& posture) {
  Json rigid = Json::array();
  for (const int joint : posture.rigid_joints) rigid.push_back(joint + 1);
  return {{"pose", posture.pose},
          {"kappa", number(posture.conditioning.kappa)},
          {"kappa_2_norm", number(posture.conditioning.kappa_two)},
          {"k_x", principalJson(posture.with_kc)},
          {"k_x_without_kc", principalJson(posture.without_kc)},
          {"anisotropy", number(posture.with_kc.anisotropy())},
          {"kc_share", number(posture.kc_share)},
          {"joints_taken_as_rigid", rigid}};
}

}  // namespace stiffscope
