#include "core/audit/station_motion.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/audit/chance.h"
#include "core/audit/finding.h"
#include "core/audit/nest_network.h"
#include "metrology/rigid_motion.h"

namespace stiffscope {

namespace {

Eigen::Vector3d whereTheArmWasRead(const Campaign& campaign) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0.0;
  const auto add = [&](const auto& table) {
    for (const auto& row : table.rows) sum += row.point, count += 1.0;
  };
  if (campaign.loading) {
    add(*campaign.loading);
  } else if (campaign.circle_sweeps) {
    add(*campaign.circle_sweeps);
  } else {
    add(*campaign.nests);
  }
  return count > 0.0 ? Eigen::Vector3d(sum / count) : sum;
}

/// How far a nest went against the others, and its first reading that noise does not explain.
void describeMovedNest(const std::vector<NestRound>& rounds, const NestNetwork& others,
                       const TrackerNoise& noise, int nest, StationMotion& result) {
  StationMotion course;
  course.centre = result.centre;
  course.epochs = others.epochs;
  std::optional<Eigen::Vector3d> first;
  const double limit = chiSquareLimit(kLevel / static_cast<double>(rounds.size()), 3.0);
  for (const NestRound& round : rounds) {
    const auto found = round.readings.find(nest);
    if (found == round.readings.end()) continue;
    const Eigen::Vector3d place = course.firstFrom(round.time_s) * found->second->point;
    if (!first) first = place;
    const Eigen::Vector3d off = place - *first;
    result.moved_nest_by = std::max(result.moved_nest_by, off.norm());
    const double significance = off.dot((2.0 * noise.covarianceAt(found->second->point)).ldlt().solve(off));
    if (significance > limit && result.moved_nest_line == 0) result.moved_nest_line = found->second->line;
  }
}

/// The nest without which the others are rigid, if there is one; needs three others.
void findMovedNest(const std::vector<NestRound>& rounds, const TrackerNoise& noise, std::size_t nests,
                   NestNetwork& network, StationMotion& result) {
  NestNetwork best = network;
  for (std::size_t nest = 0; nest < nests; ++nest) {
    const NestNetwork others = fitNestNetwork(rounds, noise, result.centre, static_cast<int>(nest));
    if (!others.determined || others.chi2 >= best.chi2) continue;
    best = others;
    result.moved_nest = static_cast<int>(nest);
  }
  if (!result.moved_nest) return;
  if (best.chi2 > chiSquareLimit(kLevel, best.dof)) {
    result.moved_nest.reset();  // more than one moved: none can be told apart
    return;
  }
  network = best;
  describeMovedNest(rounds, network, noise, *result.moved_nest, result);
}

}  // namespace

double StationMotion::significance(const StationEpoch& epoch) const {
  const Eigen::Vector3d displacement = epoch.motion.tail<3>();
  const Eigen::Matrix3d covariance = epoch.covariance.bottomRightCorner<3, 3>();
  if (covariance.isZero(0.0)) return 0.0;
  return displacement.dot(covariance.ldlt().solve(displacement));
}

Eigen::Isometry3d StationMotion::firstFrom(double time_s) const {
  if (epochs.empty() || time_s <= epochs.front().time_s) return Eigen::Isometry3d::Identity();
  if (time_s >= epochs.back().time_s) return motionAbout(centre, epochs.back().motion);
  const auto after = std::upper_bound(epochs.begin(), epochs.end(), time_s,
                                      [](double time, const StationEpoch& epoch) { return time < epoch.time_s; });
  const auto before = std::prev(after);
  if (after->jumped_at)
    return motionAbout(centre, time_s < *after->jumped_at ? before->motion : after->motion);
  const double share = (time_s - before->time_s) / (after->time_s - before->time_s);
  return motionAbout(centre, (1.0 - share) * before->motion + share * after->motion);
}

StationMotion stationMotion(const Campaign& campaign, const std::optional<TrackerNoise>& noise) {
  StationMotion result;
  if (!campaign.nests) {
    result.reason = "no floor nests: measure three or more before, during and after the day (`nests`)";
    return result;
  }
  if (!noise) {
    result.reason = "the tracker's noise is not declared: state `tracker` in campaign.xml";
    return result;
  }
  result.centre = whereTheArmWasRead(campaign);
  const std::vector<NestRound> rounds = nestRounds(*campaign.nests);
  constexpr int kNone = -1;
  NestNetwork network = fitNestNetwork(rounds, *noise, result.centre, kNone);
  if (!network.determined) {
    result.reason = "three nests that do not stand in one line, in two rounds or more, are needed";
    return result;
  }
  result.tested = true;
  result.deformation_chi2 = network.chi2;
  result.deformation_dof = network.dof;
  result.deformation_limit = network.dof > 0 ? chiSquareLimit(kLevel, network.dof) : 0.0;
  if (network.dof > 0 && network.chi2 > result.deformation_limit) {
    findMovedNest(rounds, *noise, campaign.nest_ids.size(), network, result);
  }
  result.epochs = network.epochs;
  result.moved_limit = chiSquareLimit(kLevel / static_cast<double>(result.epochs.size()), 3.0);
  for (const StationEpoch& epoch : result.epochs)
    result.moved |= result.significance(epoch) > result.moved_limit;
  return result;
}

void takeOffDrift(const StationMotion& station, Campaign& campaign) {
  forEachDriftingTable(campaign, [&](auto& table) {
    for (auto& row : table.rows) {
      if (std::isfinite(row.time_s)) row.point = station.firstFrom(row.time_s) * row.point;
    }
  });
}

}  // namespace stiffscope
