#include "core/simulation/session.h"

#include <fmt/format.h>

#include <cmath>

#include "core/input/input_error.h"
#include "core/input/units.h"

namespace stiffscope::simulation {

namespace {

constexpr double kLargest =
    0.1;  ///< m and rad: what gives more has collapsed, and linear springs no longer hold

}  // namespace

MachineState Session::rest(const Vector6d& q, const AppliedLoad& load, const Eigen::VectorXd* anchors) const {
  MachineState state = machine.changes() ? equilibrium(machineAt(machine, q, now_s), q, load, anchors)
                                         : equilibrium(machine, q, load, anchors);
  const bool small = state.deformation.size() == 0 || state.deformation.cwiseAbs().maxCoeff() < kLargest;
  if (!state.converged || !small) {
    const Vector6d deg = q / kDegree;
    throw InputError({spec.file.string(), 0, "q_deg"},
                     fmt::format("{:.3f} {:.3f} {:.3f} {:.3f} {:.3f} {:.3f}", deg[0], deg[1], deg[2], deg[3],
                                 deg[4], deg[5]),
                     "expected a posture where the machine rests stably, giving less than 0.1 rad; stiffness "
                     "is too low or the "
                     "load too large");
  }
  return state;
}

Vector6d Session::reported(const Vector6d& q) const {
  const double step = spec.read_back_resolution;
  if (step <= 0.0) return q;
  return (q / step).array().round().matrix() * step;
}

double Session::takeReading() {
  now_s += spec.timing.reading_s;
  return now_s;
}

void measureNests(Session& session) {
  if (session.spec.nests.empty()) return;
  if (!session.campaign.nests) session.campaign.nests = Nests{"nests.csv", PointFrame::tracker, {}};
  for (std::size_t n = 0; n < session.spec.nests.size(); ++n) {
    NestReading reading;
    reading.time_s = session.takeReading();
    reading.nest = static_cast<int>(n);
    reading.point = session.station.readFloor(session.spec.nests[n].position_in_base, session.now_s);
    session.campaign.nests->rows.push_back(reading);
  }
  session.last_nests_s = session.now_s;
}

void measureNestsIfDue(Session& session) {
  if (session.now_s - session.last_nests_s >= session.spec.timing.nest_interval_s) measureNests(session);
}

}  // namespace stiffscope::simulation
