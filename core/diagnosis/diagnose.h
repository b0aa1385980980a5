#pragma once

#include <cstdint>
#include <optional>

#include "core/campaign/campaign.h"
#include "core/diagnosis/diagnosis.h"
#include "core/diagnosis/gap_study.h"
#include "core/preparation/prepare.h"

namespace stiffscope::diagnosis {

struct DiagnoseOptions {
  int resamples = 120;        ///< bootstrap samples of postures for the intervals; 0: no shrink is judged
  int chance_draws = 200;     ///< draws of pure noise for the limit of significance
  double false_alarm = 0.01;  ///< chance that noise alone passes that limit
  std::uint64_t seed = 1;     ///< of both; the same input gives the same answer
  double noise_share = 0.5;   ///< see FitRules
  double deflection_share = 0.002;
  /// What chance reaches, of the same postures and loads with other readings (Diagnosis::significance_limit); empty:
  /// drawn.
  std::optional<double> chance_limit;
  bool verdict_only =
      false;  ///< gap and verdict alone: not where the gap lies, what could be told apart, what comes next
  bool design_only =
      false;  ///< what could be told apart, and what could not be tested, alone: nothing of what is there
  std::optional<effects::Effect> only;  ///< the one effect that may be chosen; what it leaves is then left as it is
};

/// Where the gap between the joint-stiffness model and the machine lies, which effects cause it, and how far
/// it shrinks. Never throws for what the data lacks: effects that cannot be tested say what is missing.
/// Throws InputError where the campaign has no loads at all, as identify does.
Diagnosis diagnose(const campaign::Campaign& campaign, const DiagnoseOptions& options = {});
/// Takes the campaign over: a long day's readings that take no part are freed before the equations are made.
Diagnosis diagnose(campaign::Campaign&& campaign, const DiagnoseOptions& options = {});
/// Diagnoses a day that is prepared already, as identification and audit see it.
Diagnosis diagnose(const preparation::PreparedCampaign& prepared, const DiagnoseOptions& options = {});
/// Diagnoses by an existing study: studyGap of this day, thinned where it is long, with these options' GapOptions.
/// Throws std::logic_error where that has let its equations go.
Diagnosis diagnose(const preparation::PreparedCampaign& prepared, const GapStudy& study,
                   const DiagnoseOptions& options = {});

}  // namespace stiffscope::diagnosis
