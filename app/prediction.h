#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/computations.h"
#include "app/identified.h"
#include "app/output.h"
#include "core/compensation/compensate.h"
#include "core/preparation/prepare.h"
#include "reports/json/json.h"

namespace stiffscope::app {

/// A loaded day, identified, and the arm that deflections are predicted by.
class Prediction {
 public:
  /// Throws InputError as identifiedBy does.
  Prediction(const CampaignSource& source, const PredictionRequest& request);

  const campaign::Campaign& campaign() const { return found_.campaign(*prepared_); }
  identification::Method method() const { return found_.method; }
  int step() { return found_.result().step; }
  const compensation::DeflectingArm& arm() const { return predicted_->arm(); }
  const std::vector<campaign::KnownStiffness>& known() const { return known_; }
  /// Whether U has what could hide besides the model: not by springs alone, nor by effects that were asked for.
  bool weighsWhatHides() const { return found_.improved && found_.improved->hidden; }

  std::vector<compensation::CompensatedPosture> compensate(
      const std::vector<compensation::PostureToCompensate>& postures) const;

  /// Hands on what the prediction came to, with the cautions of it, the model and the preparation; returns the exit
  /// status. No prediction can be made after it: tables of stiffnesses are of the day.
  int deliver(const std::vector<compensation::CompensatedPosture>& rows,
              const std::function<reports::Json(const std::vector<std::string>& cautions)>& json,
              const std::function<std::string(const std::vector<std::string>& cautions)>& text, const Outlet& outlet);

 private:
  std::shared_ptr<const preparation::PreparedCampaign> prepared_;
  Identified found_;
  std::optional<PredictedArm> predicted_;
  std::vector<campaign::KnownStiffness> known_;
};

}  // namespace stiffscope::app
