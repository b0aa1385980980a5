#include "core/simulation/random.h"
#include "core/simulation/session.h"

namespace stiffscope::simulation {

namespace {

/// One target at a true state, read now.
template <class Row>
Row reading(Session& session, const MachineState& state, int index, int target) {
  Row row;
  row.index = std::to_string(index);
  row.target = target;
  row.q = session.reported(state.q);
  row.time_s = session.takeReading();
  row.point =
      session.station.readRobot(state.targets_in_base[static_cast<std::size_t>(target)], session.now_s);
  return row;
}

}  // namespace

void measureCircleSweeps(Session& session) {
  const SimulationSpec& spec = session.spec;
  if (spec.circle_sweeps.empty()) return;
  CircleSweeps table{"circle_sweeps.csv", PointFrame::tracker, {}};
  for (const CircleSweepSpec& sweep : spec.circle_sweeps) {
    for (int stop = 0; stop < sweep.count; ++stop) {
      Vector6d q = sweep.others;
      q[sweep.axis] = sweep.start + (sweep.stop - sweep.start) * stop / (sweep.count - 1);
      session.now_s += spec.timing.move_s;
      const MachineState state = session.rest(q);
      for (std::size_t t = 0; t < spec.targets.size(); ++t) {
        table.rows.push_back(reading<CircleReading>(session, state, stop, static_cast<int>(t)));
        table.rows.back().axis = sweep.axis;
      }
      measureNestsIfDue(session);
    }
  }
  session.campaign.circle_sweeps = std::move(table);
}

void measureWristSweep(Session& session) {
  const SimulationSpec& spec = session.spec;
  if (!spec.wrist_sweep) return;
  const WristSweepSpec& sweep = *spec.wrist_sweep;
  const int targets = static_cast<int>(spec.targets.size());
  const bool one = sweep.scheme == WristScheme::one_target;
  const int stops = one ? sweep.readings : sweep.readings / targets;
  RandomStream random(spec.seed, "wrist sweep");
  WristSweep table{"wrist_sweep.csv", PointFrame::tracker, {}};
  for (int stop = 0; stop < stops; ++stop) {
    Vector6d q;
    q.head<3>() = sweep.arm;
    for (int k = 0; k < 3; ++k) q[3 + k] = random.uniform(sweep.low[k], sweep.high[k]);
    session.now_s += spec.timing.move_s;
    const MachineState state = session.rest(q);
    // One target after the other: the first `readings % targets` of them get one reading more.
    const int share = sweep.readings / targets, longer = sweep.readings % targets;
    const int first = !one                          ? 0
                      : stop < longer * (share + 1) ? stop / (share + 1)
                                                    : longer + (stop - longer * (share + 1)) / share;
    for (int t = first; t < (one ? first + 1 : targets); ++t) {
      table.rows.push_back(reading<WristReading>(session, state, stop, t));
    }
    measureNestsIfDue(session);
  }
  session.campaign.wrist_sweep = std::move(table);
}

}  // namespace stiffscope::simulation
