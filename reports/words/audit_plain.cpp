#include "reports/words/audit_plain.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>

#include "core/preparation/finding.h"

namespace stiffscope::reports {

namespace {

struct PlainCheck {
  std::string_view id, amiss;
};

/// In the order of kAuditCheckIds.
constexpr std::array kPlain{
    PlainCheck{"lost_beam", "the tracker lost its beam in some readings"},
    PlainCheck{"duplicate_readings", "some readings repeat others to the last digit"},
    PlainCheck{"repeat_outliers", "some readings stand apart from their repeats"},
    PlainCheck{"nest_outliers", "some readings of the floor nests stand apart"},
    PlainCheck{"time_order", "load steps do not follow each other in time"},
    PlainCheck{"completeness", "readings or postures are missing"},
    PlainCheck{"repeatability_along", "readings scatter along the tracker's beam otherwise than declared"},
    PlainCheck{"repeatability_across", "readings scatter across the tracker's beam otherwise than declared"},
    PlainCheck{"noise_declared", "the declared noise is not that of the readings"},
    PlainCheck{"rigid_tool", "distances between the reflectors change, as if one had moved or the tool bent"},
    PlainCheck{"station_drift", "tracker or robot moved against the floor during the day"},
    PlainCheck{"nest_moved", "a floor nest moved against the others"},
    PlainCheck{"circle_arc", "a joint was swept over a short arc only"},
    PlainCheck{"circle_count", "circles have few readings"},
    PlainCheck{"sweep_angles", "a swept joint turned otherwise than reported"},
    PlainCheck{"circle_residual", "reflectors leave their circles by more than noise"},
    PlainCheck{"axis_agreement", "reflectors place a joint's axis differently"},
    PlainCheck{"reflector_on_axis", "a reflector is so near a joint's axis that it shows little of it"},
    PlainCheck{"link_lengths", "distances between axes are not those of the URDF"},
    PlainCheck{"wrist_sphere", "reflectors leave their spheres about the wrist by more than noise"},
    PlainCheck{"wrist_axes_meet", "the wrist's axes do not meet in one point"},
    PlainCheck{"rail_straight", "the rail is not straight"},
    PlainCheck{"rail_scale", "the rail travels otherwise than reported"},
    PlainCheck{"rail_direction", "the rail does not run as the URDF has it"},
    PlainCheck{"frame_moved", "tracker, robot or tool moved between the sweeps and the last posture"},
    PlainCheck{"unloaded_positions", "reflectors without load are not where the URDF's arm would put them"},
    PlainCheck{"joint_read_back", "reported joint angles jump"},
    PlainCheck{"servo_change", "reported joint angles change under load"},
    PlainCheck{"return_to_zero", "reflectors do not come back when the load is taken off"},
    PlainCheck{"tare", "the load cell does not read zero without a load"},
    PlainCheck{"gravity_direction", "the load does not pull straight down"},
    PlainCheck{"moment_lever", "the measured moments do not belong to the measured forces"},
    PlainCheck{"load_size", "force and deflection do not go together in size"},
    PlainCheck{"posture_set", "the postures hardly tell the joints apart"},
    PlainCheck{"arm_model", "the arm that was measured is not that of the URDF"},
    PlainCheck{"load_model", "joint springs do not explain the displacements, of all postures or of some"},
    PlainCheck{"controller_poses", "the poses that the controller states are not those of the URDF's arm"},
};

constexpr PlainCheck kPlainOfStations{preparation::kStationsAgree, "the tracker's stations do not agree"};

consteval bool tellsAllChecks() {
  return std::equal(kPlain.begin(), kPlain.end(), preparation::kAuditCheckIds.begin(),
                    preparation::kAuditCheckIds.end(),
                    [](const PlainCheck& plain, const preparation::AuditCheckId& check) {
                      return plain.id == check.id && !plain.amiss.empty();
                    });
}
static_assert(tellsAllChecks(), "every check needs plain words, in the order of preparation::kAuditCheckIds");

}  // namespace

std::string amissWords(const std::string& check_id) {
  if (check_id == kPlainOfStations.id) return std::string(kPlainOfStations.amiss);
  const auto found =
      std::find_if(kPlain.begin(), kPlain.end(), [&check_id](const PlainCheck& one) { return one.id == check_id; });
  if (found == kPlain.end()) throw std::logic_error("no plain words for the check " + check_id);
  return std::string(found->amiss);
}

}  // namespace stiffscope::reports
