#pragma once

namespace stiffscope::elastic_model {

/// What the exported model lacks, or has instead.
enum class RemarkId {
  rigid_not_identifiable,   ///< joint number
  rigid_negative,           ///< joint number, its stiffness Nm/rad
  effect_of_no_spring,      ///< id of an effect of the machine that no spring in series is
  effect_of_measurement,    ///< id of an effect that the machine does not do
  effect_in_load_point,     ///< id of the effect that the load's place was corrected for
  no_masses,                ///< the URDF states none: the links have no weight
  no_balancers,             ///< number of balancers that no spring of the chain is
  no_inertia,               ///< names of the bodies whose inertia is a stand-in
  load_axes_turn_with_link  ///< name of the link that directs the load cell's axes and does not carry it
};

}  // namespace stiffscope::elastic_model
