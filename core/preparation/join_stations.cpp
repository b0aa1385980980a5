#include "core/preparation/join_stations.h"

#include <fmt/format.h>
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/campaign/row_names.h"
#include "core/io/input_error.h"
#include "core/preparation/nest_network.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::preparation {

campaign::Campaign ofStation(campaign::Campaign campaign, int station) {
  const auto keep = [&](auto& table) {
    if (!table) return;
    std::erase_if(table->rows, [&](const auto& row) { return row.station != station; });
    if (table->rows.empty()) table.reset();
  };
  keep(campaign.circle_sweeps);
  keep(campaign.wrist_sweep);
  keep(campaign.rail_sweep);
  keep(campaign.loading);
  keep(campaign.nests);
  campaign.stations.clear();
  return campaign;
}

std::string shownStation(const campaign::StationPlace& place) {
  return place.id.empty() ? std::string("the station of the rows that name none")
                          : fmt::format("station '{}'", place.id);
}

PoseUncertainty poseUncertainty(const campaign::StationPlace& place) {
  const auto largest = [](const Eigen::Matrix3d& covariance) {
    return std::sqrt(std::max(0.0, symmetricEigenvalues(covariance)[2]));
  };
  return {largest(place.covariance.bottomRightCorner<3, 3>()), largest(place.covariance.topLeftCorner<3, 3>())};
}

namespace {

/// The first row that was read from a station: of the nests, else of the table that has one.
struct StationRow {
  std::string file;
  std::size_t line = 0;
};

StationRow firstRowOf(const campaign::Campaign& campaign, int station) {
  StationRow found;
  campaign::forEachPointTable(campaign, [&](const auto& table) {
    for (const auto& row : table.rows) {
      if (row.station != station) continue;
      found = {table.file, row.line};  // the nests come last
      return;
    }
  });
  return found;
}

void requireJoined(const campaign::Campaign& campaign, const StationNetwork& network) {
  for (std::size_t s = 0; s < network.stations.size(); ++s) {
    const StationPose& pose = network.stations[s];
    if (pose.joined == StationPose::Joined::yes) continue;
    const StationRow row = firstRowOf(campaign, static_cast<int>(s));
    std::string expected = fmt::format(
        "expected at least three nests, not on one line, that {} shares with {}", shownStation(campaign.stations[s]),
        network.stations.size() == 2 ? shownStation(campaign.stations[0]) : std::string("the others"));
    expected += pose.joined == StationPose::Joined::common_nests_on_one_line
                    ? fmt::format("; its {} stand on one line", pose.common_nests)
                    : fmt::format("; it shares {}", pose.common_nests);
    throw io::InputError({(campaign.folder / row.file).string(), row.line, "station"}, campaign.stations[s].id,
                         expected);
  }
}

/// Where the instrument stood at each station, in the frame of its readings: as they say, else where the tracker is
/// said to stand.
std::vector<Eigen::Vector3d> standpoints(const campaign::Campaign& campaign, const metrology::TrackerNoise& noise) {
  std::vector<Eigen::Vector3d> points(campaign.stations.size(), noise.station);
  campaign::forEachPointTable(campaign, [&](const auto& table) {
    for (const auto& row : table.rows) {
      if (row.from.allFinite()) points[static_cast<std::size_t>(row.station)] = row.from;
    }
  });
  return points;
}

std::vector<NestsOfStation> nestsByStation(const campaign::Campaign& campaign, const metrology::TrackerNoise& noise,
                                           const std::vector<Eigen::Vector3d>& from) {
  std::vector<NestsOfStation> stations;
  for (const Eigen::Vector3d& point : from) stations.push_back({{}, noise.seenFrom(point)});
  if (!campaign.nests) return stations;
  for (const campaign::NestReading& row : campaign.nests->rows)
    stations[static_cast<std::size_t>(row.station)].readings.push_back(row);
  return stations;
}

/// Each station's readings by its own motion, in its own frame; the nests without one's own time stay, too.
void takeOff(const std::vector<DriftModel>& courses, campaign::Campaign& campaign) {
  std::vector<StationMotion> motions;
  for (const DriftModel& course : courses) motions.push_back(course.moved() ? course.motion : StationMotion{});
  applyDriftCorrection(motions, campaign);
  if (!campaign.nests) return;
  for (campaign::NestReading& row : campaign.nests->rows)
    row.point = motions[static_cast<std::size_t>(row.station)].firstFrom(row.time_s) * row.point;
}

template <class Move>
void forEachReading(campaign::Campaign& campaign, const Move& move) {
  campaign::forEachPointTable(campaign, [&](auto& table) {
    if (table.frame != campaign::PointFrame::tracker) return;
    for (auto& row : table.rows) move(row);
  });
}

/// Mean of the arm's readings in the first station's frame.
Eigen::Vector3d armInFirst(const campaign::Campaign& campaign, const StationNetwork& network) {
  campaign::Campaign joined = campaign;
  forEachReading(joined, [&](auto& row) {
    row.point = network.stations[static_cast<std::size_t>(row.station)].first_from_station * row.point;
  });
  return whereTheArmWasRead(joined);
}

std::vector<std::size_t> armReadings(const campaign::Campaign& campaign) {
  std::vector<std::size_t> readings(campaign.stations.size(), 0);
  forEachDriftingTable(campaign, [&](const auto& table) {
    for (const auto& row : table.rows) ++readings[static_cast<std::size_t>(row.station)];
  });
  return readings;
}

}  // namespace

JoinedStations joinStations(const metrology::TrackerNoise& noise, bool as_drifted, campaign::Campaign& campaign) {
  JoinedStations joined;
  const std::vector<Eigen::Vector3d> from = standpoints(campaign, noise);
  for (std::size_t s = 0; s < from.size(); ++s) {
    if (as_drifted) {
      joined.courses.emplace_back();
    } else {
      joined.courses.push_back(stationCourse(ofStation(campaign, static_cast<int>(s)), noise.seenFrom(from[s])));
    }
  }
  takeOff(joined.courses, campaign);
  const std::vector<NestsOfStation> nests = nestsByStation(campaign, noise, from);
  // Where the arm is in the first one's frame is known once they are joined.
  joined.network = fitStationNetwork(nests, Eigen::Vector3d::Zero());
  requireJoined(campaign, joined.network);
  joined.network = fitStationNetwork(nests, armInFirst(campaign, joined.network));
  requireJoined(campaign, joined.network);
  joined.readings = armReadings(campaign);
  for (std::size_t s = 0; s < from.size(); ++s) {
    StationPose& pose = joined.network.stations[s];
    pose.id = campaign.stations[s].id;
    DriftModel& course = joined.courses[s];
    course.motion = inFrame(course.motion, pose.first_from_station);
    course.rounds = inFrame(course.rounds, pose.first_from_station);
    campaign.stations[s] = pose;
  }
  forEachReading(campaign, [&](auto& row) {
    const auto s = static_cast<std::size_t>(row.station);
    const Eigen::Isometry3d& pose = joined.network.stations[s].first_from_station;
    row.point = pose * row.point;
    row.from = pose * from[s];
  });
  return joined;
}

}  // namespace stiffscope::preparation
