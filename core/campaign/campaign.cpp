#include "core/campaign/campaign.h"
#include "metrology/rigid_motion.h"

namespace stiffscope::campaign {

CampaignTexts::CampaignTexts() = default;
CampaignTexts::CampaignTexts(const CampaignTexts&) = default;
CampaignTexts::CampaignTexts(CampaignTexts&&) noexcept = default;
CampaignTexts& CampaignTexts::operator=(const CampaignTexts&) = default;
CampaignTexts& CampaignTexts::operator=(CampaignTexts&&) noexcept = default;
CampaignTexts::~CampaignTexts() = default;

const StateExtras& State::extras() const {
  static const std::vector<StateExtras> none = [] {
    std::vector<StateExtras> by_joints;
    for (int joints = 0; joints <= kMostJoints; ++joints) by_joints.emplace_back(joints);
    return by_joints;
  }();
  return extras_.empty() ? none[static_cast<std::size_t>(q.size())] : extras_.front();
}

StateExtras& State::extras() {
  if (extras_.empty()) extras_.emplace_back(static_cast<int>(q.size()));
  return extras_.front();
}

Eigen::Matrix3d StationPlace::covarianceAt(const Eigen::Vector3d& point_in_first) const {
  Eigen::Matrix<double, 3, 6> by_motion;
  by_motion << -metrology::crossMatrix(point_in_first - centre), Eigen::Matrix3d::Identity();
  return by_motion * covariance * by_motion.transpose();
}

}  // namespace stiffscope::campaign
