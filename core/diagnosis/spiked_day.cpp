#include "core/diagnosis/spike_study.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/campaign/row_names.h"
#include "core/effects/gravity_equilibrium.h"
#include "core/preparation/rail.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::diagnosis {

namespace {

constexpr int kFirstLink = 1;

/// Joints 2 to n - 1: those whose zeros and lengths positions can see.
int linksOf(int joints) { return joints - 2; }

SystemInput spikeInput(const preparation::PreparedCampaign& prepared, DiagnosisInput& start) {
  SystemInput input{start.campaign,
                    start.noise.noise,
                    prepared.campaign.load_cell->force_sigma,
                    prepared.campaign.load_cell->moment_sigma,
                    effects::effectModelsOf(prepared.campaign),
                    start.absolute,
                    start.sweeps,
                    complianceExpected(start.state.at.compliance)};
  if (start.reason.empty()) boundDriftByNests(start, input);  // and says when the sweeps were
  return input;
}

/// The day as read, row by row, with its points where the preparation has them: in the first station's frame, the
/// carriage at zero. A drift that the preparation takes off stays in: its millimetre changes levers of metres, and its
/// turn directions, by less than what an effect of first order leaves out.
campaign::Campaign placedAsPrepared(campaign::Campaign day, const preparation::PreparedCampaign& prepared) {
  if (prepared.preparation.stations) {
    const std::vector<campaign::StationPlace>& stations = prepared.campaign.stations;
    campaign::forEachPointTable(day, [&](auto& table) {
      // Rows in base_link are of the first station, which stays where it is.
      for (auto& row : table.rows)
        row.point = stations[static_cast<std::size_t>(row.station)].first_from_station * row.point;
    });
  }
  preparation::referToCarriageAtZero(prepared.rail, day);
  return day;
}

}  // namespace

SpikedDay::SpikedDay(campaign::Campaign campaign)
    : campaign_(std::move(campaign)),
      prepared_(preparation::prepareCampaign(campaign_)),
      placed_(placedAsPrepared(campaign_, prepared_)),
      start_(diagnosisInput(prepared_)),
      input_(spikeInput(prepared_, start_)) {
  if (!start_.reason.empty()) return;
  data_ = linearSystem(input_, start_.state, {});
  const Eigen::MatrixXd normal = sumOf(data_, std::vector<double>(data_.postures.size(), 1.0));
  const Eigen::Index first = data_.layout.effects, count = data_.layout.end - first;
  normal_ = normal.block(first, first, count, count);
  projection_ = project(normal, data_.layout);
}

std::vector<SpikedDay::Part> SpikedDay::seenParts(effects::Effect effect) const {
  constexpr double kKept = 1e-4;  // as SelectionRules::kept_share: less is not tried by the diagnosis either
  std::vector<Part> parts;
  for (std::size_t m = 0; m < input_.models.size(); ++m) {
    const effects::EffectModel& model = input_.models[m];
    if (model.effect != effect) continue;
    Eigen::Index at = data_.layout.model_at[m] - data_.layout.effects;
    for (std::size_t p = 0; p < model.parts.size(); ++p) {
      const auto size = static_cast<Eigen::Index>(model.parts[p].most.size());
      const Eigen::ArrayXd before = projection_.before.segment(at, size).array();
      const Eigen::ArrayXd kept = projection_.matrix.diagonal().segment(at, size).array();
      if (!model.parts[p].is_shape && ((before > 0.0) && (kept > kKept * before)).any()) parts.push_back({m, p, at});
      at += size;
    }
  }
  return parts;
}

std::optional<Spike> SpikedDay::draw(effects::Effect effect, double largest, numerics::RandomStream& random) const {
  if (effect == effects::Effect::kinematic_error) return drawGeometry(random);
  const std::vector<Part> seen = seenParts(effect);
  if (seen.empty()) return std::nullopt;
  const auto pick = [&](std::size_t count) {
    return std::min(count - 1, static_cast<std::size_t>(random.uniform() * static_cast<double>(count)));
  };
  Spike spike;
  constexpr int kTries = 40;
  for (int attempt = 0; attempt < kTries; ++attempt) {
    std::vector<Part> chosen{seen[pick(seen.size())]};
    const effects::EffectModel& model = input_.models[chosen.front().model];
    const Part other = seen[pick(seen.size())];
    constexpr double kTwoParts = 1.0 / 3.0;
    const bool two = random.uniform() < kTwoParts && model.most_parts > 1;
    if (two && other.model == chosen.front().model && other.part != chosen.front().part) chosen.push_back(other);
    spike = {effect,
             chosen.front().model,
             {},
             Eigen::VectorXd::Zero(static_cast<Eigen::Index>(model.parameters())),
             std::numeric_limits<double>::infinity()};
    const Eigen::Index first = data_.layout.model_at[spike.model] - data_.layout.effects;
    for (const Part& one : chosen) {
      const effects::EffectPart& part = model.parts[one.part];
      if (!part.detail.empty()) spike.parts.push_back(part.detail);
      for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(part.most.size()); ++k) {
        const double own = normal_(one.first + k, one.first + k), number = random.normal();
        if (own > 0.0)
          spike.parameters[one.first - first + k] = (part.positive ? std::abs(number) : number) / std::sqrt(own);
      }
    }
    const auto block = normal_.block(first, first, spike.parameters.size(), spike.parameters.size());
    const double now = data_.state_noise * std::sqrt(spike.parameters.dot(block * spike.parameters) /
                                                     static_cast<double>(data_.loading_rows));
    if (!(now > 0.0)) continue;
    spike.parameters /= now;
    for (const Part& one : chosen) {
      const effects::EffectPart& part = model.parts[one.part];
      for (std::size_t k = 0; k < part.most.size(); ++k) {
        const double value = std::abs(spike.parameters[one.first - first + static_cast<Eigen::Index>(k)]);
        if (value > 0.0) spike.largest = std::min(spike.largest, part.most[k] / value);
      }
    }
    if (spike.largest >= largest) break;
  }
  return spike;
}

/// One zero or one length, or two of them.
std::optional<Spike> SpikedDay::drawGeometry(numerics::RandomStream& random) const {
  if (!input_.absolute) return std::nullopt;
  const int links = linksOf(campaign_.robot.joints());
  Spike spike{effects::Effect::kinematic_error,
              0,
              {},
              Eigen::VectorXd::Zero(2 * links),
              std::numeric_limits<double>::infinity()};
  const Eigen::Index kind = random.uniform() < 0.5 ? 0 : links;
  for (int drawn = 0; drawn < 2; ++drawn) {
    const auto which = std::min<Eigen::Index>(links - 1, static_cast<Eigen::Index>(random.uniform() * links));
    spike.parameters[kind + which] += random.normal();
  }
  const double left = geometryLeft(spike.parameters);
  if (!(left > 0.0)) return std::nullopt;
  spike.parameters /= left;
  return spike;
}

Eigen::VectorXd SpikedDay::byGeometry(const Eigen::VectorXd& errors, const effects::ArmState& state) const {
  JointVector zeros = JointVector::Zero(state.joints());
  const int links = linksOf(state.joints());
  zeros.segment(kFirstLink, links) = errors.head(links);
  Eigen::VectorXd moved = effects::byJoints(state, zeros);
  for (int i = 0; i < links; ++i) {
    const std::size_t joint = static_cast<std::size_t>(kFirstLink + i);
    Eigen::Vector3d link = state.axes[joint].point - state.axes[joint - 1].point;
    constexpr double kNoLink = 1e-3;  // m: axes that meet are moved along the flange's x instead
    link = link.norm() > kNoLink ? Eigen::Vector3d(link.normalized()) : Eigen::Vector3d(state.flange.linear().col(0));
    moved += effects::byMotion(state, state.axes[joint].point, Eigen::Vector3d::Zero(), errors[links + i] * link);
  }
  return moved;
}

double SpikedDay::geometryLeft(const Eigen::VectorXd& errors) const {
  Eigen::Index rows = 0;
  for (const GapPosture& posture : data_.postures) rows += posture.states.front().rows();
  const Eigen::Index targets = static_cast<Eigen::Index>(campaign_.targets.size());
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(rows, 6 + 3 * targets);
  Eigen::VectorXd moved(rows);
  Eigen::Index row = 0;
  for (const GapPosture& posture : data_.postures) {
    const effects::ArmState& state = posture.states.front();
    moved.segment(row, state.rows()) = byGeometry(errors, state);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d none = Eigen::Vector3d::Zero(), unit = Eigen::Vector3d::Unit(k);
      columns.col(k).segment(row, state.rows()) = effects::byMotion(state, none, unit, none);
      columns.col(3 + k).segment(row, state.rows()) = effects::byMotion(state, none, none, unit);
    }
    for (std::size_t t = 0; t < state.targets.size(); ++t)
      columns.block<3, 3>(row + 3 * static_cast<Eigen::Index>(t), 6 + 3 * state.targets[t]) = state.flange.linear();
    row += state.rows();
  }
  return rows == 0
             ? 0.0
             : (moved - columns * leastSquaresSolution(columns, moved)).norm() / std::sqrt(static_cast<double>(rows));
}

SpikedDay::Field SpikedDay::fieldOf(const Spike& spike, double size) const {
  const Eigen::VectorXd parameters = size * spike.parameters;
  if (spike.effect == effects::Effect::kinematic_error) {
    return [this, parameters](const effects::PostureStates& posture, std::size_t s) {
      return byGeometry(parameters, posture[s]);
    };
  }
  const effects::EffectModel& model = input_.models[spike.model];
  effects::LinearizationPoint at = start_.state.at;
  Eigen::VectorXd own = parameters;
  constexpr int kRounds = 50;  // a stiffness that drops settles in steps
  for (int round = 0; round < kRounds && model.settle != nullptr; ++round) model.settle(at, own);
  return [&model, at, own](const effects::PostureStates& posture, std::size_t s) -> Eigen::VectorXd {
    return model.columns(at, posture, s) * own;
  };
}

effects::ArmState SpikedDay::atRest(int target, const JointVector& q, const Eigen::Vector3d& point, double time_s,
                                    double carriage) const {
  effects::ArmState state = effects::gravityEquilibrium(start_.state.geometry, start_.state.at, q, carriage);
  state.time_s = time_s;
  state.targets = {target};
  state.points = {point};
  return state;
}

namespace {

/// The reflector's three rows of a state's field; empty where the state does not have it.
std::optional<Eigen::Vector3d> ofTarget(const effects::ArmState& state, int target, const Eigen::VectorXd& field) {
  for (std::size_t t = 0; t < state.targets.size(); ++t) {
    if (state.targets[t] == target) return field.segment<3>(3 * static_cast<Eigen::Index>(t));
  }
  return std::nullopt;
}

/// The posture's field state by state, found once.
class FieldsByState {
 public:
  FieldsByState(const LinearSystem& data, const auto& field) {
    for (const GapPosture& posture : data.postures) {
      for (std::size_t s = 0; s < posture.states.size(); ++s)
        states_[{posture.pose, posture.states[s].step}] = {&posture.states[s], field(posture.states, s)};
    }
  }

  std::optional<Eigen::Vector3d> of(int pose, int step, int target) const {
    const auto found = states_.find({pose, step});
    if (found == states_.end()) return std::nullopt;
    return ofTarget(*found->second.first, target, found->second.second);
  }

 private:
  std::map<std::pair<int, int>, std::pair<const effects::ArmState*, Eigen::VectorXd>> states_;
};

}  // namespace

Eigen::Vector3d SpikedDay::asRead(int station, const Eigen::Isometry3d& r0_from_points,
                                  const Eigen::Vector3d& in_r0) const {
  const Eigen::Vector3d in_points = r0_from_points.linear().transpose() * in_r0;
  if (!prepared_.preparation.stations) return in_points;
  const campaign::StationPlace& place = prepared_.campaign.stations[static_cast<std::size_t>(station)];
  return place.first_from_station.linear().transpose() * in_points;
}

void SpikedDay::moveLoading(const Field& field, campaign::Campaign& campaign) const {
  if (!campaign.loading || !start_.state.geometry.r0_from_loading) return;
  const FieldsByState fields(data_, field);
  for (campaign::LoadingReading& row : campaign.loading->rows) {
    if (const auto moved = fields.of(row.pose, row.step, row.target))
      row.point += asRead(row.station, *start_.state.geometry.r0_from_loading, *moved);
  }
}

void SpikedDay::moveDisplacements(const Field& field, campaign::Campaign& campaign) const {
  if (!campaign.displacements) return;
  const Eigen::Matrix3d table_from_r0 =
      start_.state.geometry.displacements_in_r0.value_or(Eigen::Matrix3d::Identity()).transpose();
  const FieldsByState fields(data_, field);
  for (campaign::Displacement& row : campaign.displacements->rows) {
    const auto loaded = fields.of(row.pose, row.step, row.target), unloaded = fields.of(row.pose, 0, row.target);
    if (loaded && unloaded) row.displacement += table_from_r0 * (*loaded - *unloaded);
  }
}

template <class Row>
void SpikedDay::moveSweep(const Field& field, const std::vector<Row>& placed, std::vector<Row>& rows) const {
  const Eigen::Isometry3d& r0_from_sweeps = start_.state.r0_from_sweeps;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& at = placed[i];
    const effects::PostureStates state{atRest(at.target, at.q, r0_from_sweeps * at.point, at.time_s, at.carriage)};
    rows[i].point += asRead(at.station, r0_from_sweeps, field(state, 0));
  }
}

template <class Row>
void SpikedDay::moveWithInstrument(const Field& field, const std::vector<Row>& placed, std::vector<Row>& rows) const {
  const Eigen::Isometry3d& r0_from_tracker = *start_.state.geometry.r0_from_loading;
  effects::PostureStates state(1);
  state.front().targets = {0};
  // These points stand where they were read, those of the arm where it is with the carriage at zero.
  if (prepared_.rail) state.front().carriage = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    state.front().time_s = placed[i].time_s;
    state.front().points = {r0_from_tracker * placed[i].point};
    rows[i].point += asRead(placed[i].station, r0_from_tracker, field(state, 0));
  }
}

campaign::Campaign SpikedDay::with(const Spike& spike, double size) const {
  campaign::Campaign spiked = campaign_;
  const Field field = fieldOf(spike, size);
  moveLoading(field, spiked);
  moveDisplacements(field, spiked);
  if (spike.effect == effects::Effect::tracker_drift && start_.state.geometry.r0_from_loading) {
    if (spiked.nests) moveWithInstrument(field, placed_.nests->rows, spiked.nests->rows);
    // Its points are the loading's where both tables are in one frame.
    if (spiked.rail_sweep && spiked.loading && spiked.rail_sweep->frame == spiked.loading->frame)
      moveWithInstrument(field, placed_.rail_sweep->rows, spiked.rail_sweep->rows);
  }
  if (!input_.sweeps) return spiked;
  if (spiked.circle_sweeps) moveSweep(field, placed_.circle_sweeps->rows, spiked.circle_sweeps->rows);
  if (spiked.wrist_sweep) moveSweep(field, placed_.wrist_sweep->rows, spiked.wrist_sweep->rows);
  return spiked;
}

}  // namespace stiffscope::diagnosis
