#pragma once

#include "core/identification/held_out_loads.h"
#include "core/identification/identify.h"
#include "core/identification/load_dependence.h"
#include "reports/json/campaign_json.h"
#include "reports/json/json_document.h"

namespace stiffscope::reports {

/// The result of `identify`, which has to live as long, as the campaign has: rows of the postures are made as they are
/// written. `methods` may leave some out: those asked for.
JsonDocument identificationJson(const campaign::Campaign& campaign, const identification::Identification& result,
                                const std::vector<identification::Method>& methods);

/// `method`, `judged_at` ("reflectors", "P_wrist", null where held-out shares did not decide) and `reason` in words.
Json shownFirstJson(const std::optional<identification::ShownFirst>& first);

/// [low, high], null where open.
Json intervalJson(const identification::CoverageInterval& interval);

/// `transmission` of a result that has one: `joints`, a row a joint: the gear's compliance and stiffness by its two
/// encoders with sd, 95 % interval and `contributions`; `points`, `postures`, `left_out`; `held` (link_side,
/// motor_side, unknown) and how far the link side turned; the encoders' `offset_rad`, the gear's `lost_motion_rad`;
/// and, by method, `structure`: what the tracker sees besides the gear, with its interval, and `agreement` (apart,
/// structure_seen, gear_alone, contradicts).
Json transmissionJson(const identification::Identification& result, const std::vector<identification::Method>& methods);

/// Adds to a method's object: `coverage`, `interval_nm_per_rad` and `interval_compliance_rad_per_nm` ([low, high], null
/// where open), `dof`, `sd_compliance_rad_per_nm`, `correlation` (6x6, null rows of joints that are not
/// identifiable), `contributions` (standard deviation of the compliance by each part), `bootstrap` where there is one.
void addUncertainty(const identification::MethodResult& method, Json& json);

/// `json` with `by_step`: per method its stiffness by load step, and whether it depends on the load; null where there
/// are no two steps.
Json withSteps(Json json, const identification::StepStudy& study, const identification::Identification& result,
               const std::vector<identification::Method>& methods);

/// `json` with `held_out_loads`: shares compensated under load steps (`levels`) and directions that took no part, by
/// method, and the states of each direction.
Json withHeldOutLoads(Json json, const identification::HeldOutLoads& loads,
                      const std::vector<identification::Method>& methods);

}  // namespace stiffscope::reports
