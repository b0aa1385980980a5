#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/diagnosis/diagnosis.h"
#include "core/diagnosis/diagnosis_input.h"
#include "core/diagnosis/fit.h"
#include "core/diagnosis/held_out.h"
#include "core/preparation/prepare.h"

namespace stiffscope::diagnosis {

struct GapOptions {
  double noise_share = 0.5;                            ///< see FitRules
  double deflection_share = 0.002;                     ///< the same
  std::optional<effects::Effect> only = std::nullopt;  ///< the one effect that may be chosen
};

/// How the fit does in postures that it has not seen, the selection repeated in each sample (heldOutShrinks), and what
/// that depends on beside the study.
struct StudyHeldOut {
  double detect = 0.0;  ///< SelectionRules
  int resamples = 0;
  std::uint64_t seed = 0;
  HeldOutShrink shrink;
};

/// The joint fit that a diagnosis stands on: every effect that the campaign can show in the equations, and of them the
/// set that the data support (fitGap). The diagnosis judges it; the model that identification uses by default is made
/// of it, so that both speak of the same machine.
struct GapStudy {
  std::unique_ptr<const DiagnosisInput> start;  ///< what `input` refers to
  std::unique_ptr<const SystemInput> input;     ///< with every effect's models
  std::vector<bool> allowed;                    ///< of those models: what the campaign can show
  std::vector<std::size_t> given;               ///< models that the nests put in
  std::vector<NotTestable> not_testable;        ///< effects, and what is missing to show them
  GapFit fit;                                   ///< empty where `start->reason` says why there is no gap
  std::optional<GapFit> alone;                  ///< withoutEffects beside it, where that was asked for already
  std::optional<StudyHeldOut> held_out;         ///< the same: it takes as long as the fit

  bool usable() const { return start->reason.empty(); }

  /// Lets go the equations, which are most of its size, where no diagnosis will be made of it. Where the postures stood
  /// stays.
  void keepStates();
  bool hasEquations() const { return fit.data->sweeps.size() > 0; }
};

/// `prepared` must have been thinned where the day is long (spreadForDiagnosis).
GapStudy studyGap(const preparation::PreparedCampaign& prepared, const GapOptions& options = {});

/// Whether a day has more postures, more reflectors or longer sweeps than a diagnosis looks at.
bool isLong(const campaign::Campaign& campaign);

/// Everything of the campaign but the readings, and the reflectors, that take no part in the diagnosis of a long day.
campaign::Campaign spreadForDiagnosis(const campaign::Campaign& campaign);

/// Everything of `prepared` but the readings that take no part in the diagnosis of a long day.
preparation::PreparedCampaign spreadForDiagnosis(const preparation::PreparedCampaign& prepared);

}  // namespace stiffscope::diagnosis
