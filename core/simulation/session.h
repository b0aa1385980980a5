#pragma once

#include "core/campaign/campaign.h"
#include "core/simulation/elastic_equilibrium.h"
#include "core/simulation/machine.h"
#include "core/simulation/spec.h"
#include "core/simulation/station.h"

namespace stiffscope::simulation {

/// The day in progress: what has been measured, and the clock. Only the truth; errors are added afterwards.
struct Session {
  const SimulationSpec& spec;
  const ElasticMachine& machine;
  Campaign campaign;
  Station station;
  double now_s = 0.0;
  double last_nests_s = 0.0;

  /// The machine at rest at reported angles q, now. Throws InputError where it is not stable or collapses.
  MachineState rest(const Vector6d& q, const AppliedLoad& load = {},
                    const Eigen::VectorXd* anchors = nullptr) const;
  Vector6d reported(const Vector6d& q) const;  ///< rounded to the read-back resolution
  /// The time a reading is finished; the clock moves on to it.
  double takeReading();
};

void measureNests(Session& session);       ///< one reading of every nest, now
void measureNestsIfDue(Session& session);  ///< if their interval has passed
void measureCircleSweeps(Session& session);
void measureWristSweep(Session& session);
void measureLoading(Session& session);

}  // namespace stiffscope::simulation
