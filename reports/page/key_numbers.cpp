#include "reports/page/key_numbers.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>

#include "reports/page/facts.h"
#include "reports/page/sections.h"
#include "reports/words/accuracy_words.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"
#include "reports/words/verdict.h"

namespace stiffscope::page {

namespace {

/// The campaign the first numbers are of: a loaded one before others, and of these the one with active double encoders
/// where there are several, as in the paper.
const reports::ReportCampaign& leading(const reports::ReportContent& content) {
  const auto& campaigns = content.campaigns;
  const bool loaded = reports::anyOfKind(campaigns, reports::DayKind::loaded);
  const auto first = std::find_if(campaigns.begin(), campaigns.end(),
                                  [loaded](const reports::ReportCampaign& one) { return !loaded || isLoaded(one); });
  const auto active = std::find_if(first, campaigns.end(), [loaded](const reports::ReportCampaign& one) {
    return (!loaded || isLoaded(one)) && one.campaign.double_encoder == campaign::DoubleEncoder::active;
  });
  return active == campaigns.end() ? *first : *active;
}

/// What tells the day from the report's others: the state of its double encoders, else its name.
std::string dayOf(const reports::ReportContent& content, const reports::ReportCampaign& one) {
  const auto at = static_cast<std::size_t>(&one - content.campaigns.data());
  const std::string name = columnNames(content)[at];
  const std::string state = reports::encoderWords(one.campaign.double_encoder);
  return name == reports::capitalised(state) ? state : name;
}

/// ", double encoders active", where that is declared; of several days which of them.
std::string stateOf(const reports::ReportContent& content, const reports::ReportCampaign& one) {
  const std::string words =
      content.campaigns.size() > 1 ? dayOf(content, one) : reports::encoderWords(one.campaign.double_encoder);
  return words.empty() ? words : ", " + words;
}

std::string meanDeflection(const reports::ReportCampaign& one, const reports::JudgedPoint& point) {
  const auto& displacement = reports::displacementAt(one.identification, point.at_wrist);
  return reports::fixed(reports::kMmPerM * reports::mean(displacement), 2);
}

/// "mean deflection at P_{wrist} under 1.50 kN, 19 postures".
std::string deflectionWords(const reports::ReportCampaign& one, const reports::JudgedPoint& point) {
  return fmt::format("mean deflection at {} under {}, {} postures", point.name,
                     reports::forceWords(reports::meanForce(one.identification)),
                     reports::displacementAt(one.identification, point.at_wrist).size());
}

KeyNumber deflection(const reports::ReportContent& content, const reports::ReportCampaign& one) {
  const reports::JudgedPoint point = reports::judgedPoint(one);
  if (reports::displacementAt(one.identification, point.at_wrist).empty())
    return {"–", "deflection: no posture could be used"};
  // Of two days under the same load both are told: one alone would be taken for the report's.
  std::vector<const reports::ReportCampaign*> loaded;
  for (const reports::ReportCampaign& day : content.campaigns)
    if (isLoaded(day)) loaded.push_back(&day);
  const std::string words = deflectionWords(one, point);
  const bool alike = loaded.size() == 2 && std::all_of(loaded.begin(), loaded.end(), [&](const auto* day) {
                       const reports::JudgedPoint own = reports::judgedPoint(*day);
                       return !reports::displacementAt(day->identification, own.at_wrist).empty() &&
                              deflectionWords(*day, own) == words;
                     });
  if (!alike) return {fmt::format("{}\u00a0mm", meanDeflection(one, point)), words + stateOf(content, one)};
  return {fmt::format("{} and {}\u00a0mm", meanDeflection(*loaded[0], reports::judgedPoint(*loaded[0])),
                      meanDeflection(*loaded[1], reports::judgedPoint(*loaded[1]))),
          fmt::format("{}: {}, and {}", words, dayOf(content, *loaded[0]), dayOf(content, *loaded[1]))};
}

/// At the reflectors, by which the method was chosen, and at P_wrist; beside the paper in the paper's order.
KeyNumber compensated(const reports::ReportContent& content, const reports::ReportCampaign& one) {
  const bool paper = content.compare_with_paper;
  const auto shown = reports::shownMethod(one.identification);
  if (!shown) return {"–", "compensated: no method is available, see @{Stiffness}"};
  if (const std::string negative = reports::negativeFitWords(one.identification); !negative.empty())
    return {"–", "compensated: " + negative + stateOf(content, one)};
  const identification::MethodResult& method = one.identification.of(*shown);
  const bool wrist = reports::compensationAt(method, true).has_value(), first_at_wrist = wrist && paper;
  const auto share = [&](bool at_wrist) {
    const auto held_out = reports::heldOut(method, at_wrist);
    const auto& all = reports::compensationAt(method, at_wrist);
    return reports::percent(held_out ? *held_out : all ? all->all_postures : std::nan(""), 0);
  };
  const auto point = [](bool at_wrist) { return at_wrist ? "P_{wrist}" : "the reflectors"; };
  std::string words =
      fmt::format("of the deflection at {} compensated by {} in postures {}", point(first_at_wrist),
                  reports::shortName(*shown), reports::heldOut(method, first_at_wrist) ? "held out" : "used");
  if (wrist) words += fmt::format("; {} at {}", share(!first_at_wrist), point(!first_at_wrist));
  words += stateOf(content, one);
  return {share(first_at_wrist), words};
}

/// The joints that the verdict does not doubt.
KeyNumber trusted(const reports::ReportContent& content, const reports::ReportCampaign& one) {
  const identification::Identification& identification = one.identification;
  const std::string state = stateOf(content, one);
  const auto shown = reports::shownMethod(identification);
  if (!shown)
    return {fmt::format("0 of {}", identification.identifiability.joints.size()),
            "joint stiffnesses: no method is available, see @{Stiffness}"};
  const identification::StiffnessEstimate& estimate = identification.of(*shown).estimate;
  int count = 0;
  std::vector<std::string> doubtful;
  for (int joint = 0; joint < estimate.joints(); ++joint) {
    if (!estimate.identifiable[static_cast<std::size_t>(joint)]) continue;
    if (estimate.mark(joint).empty()) {
      ++count;
    } else {
      doubtful.push_back(reports::jointName(joint));
    }
  }
  std::string words = fmt::format("joint stiffnesses found by {}{}", reports::shortName(*shown), state);
  if (!doubtful.empty()) {
    words += fmt::format("; {} {} not to be trusted and not counted", fmt::join(doubtful, ", "),
                         doubtful.size() == 1 ? "is" : "are");
  }
  return {fmt::format("{} of {}", count, estimate.joints()), words};
}

KeyNumber third(const reports::ReportContent& content, const reports::ReportCampaign& one) {
  if (content.avoided && content.avoided->available) {
    std::string words = fmt::format("of the deflection at {} with double encoders inactive is avoided by active ones",
                                    reports::pointOf(*content.avoided));
    const std::vector<reports::ReportCampaign> loaded = reports::ofKind(content.campaigns, reports::DayKind::loaded);
    if (const std::string others = reports::changedWithoutEncoder(loaded, *content.avoided); !others.empty())
      words +=
          fmt::format("; joints without a double encoder differ as well ({}): not only the encoders changed", others);
    return {reports::percent(content.avoided->share, 0), words};
  }
  return trusted(content, one);
}

/// What a day of sweeps alone gives: axes and the lengths between them.
std::vector<KeyNumber> sweepNumbers(const frames::Frames& frames) {
  const auto measured =
      std::count_if(frames.axes.begin(), frames.axes.end(), [](const auto& axis) { return axis.measured; });
  double rms = 0.0;
  for (const frames::MeasuredAxis& axis : frames.axes) rms = std::max(rms, axis.measured ? axis.fit.rms : 0.0);
  const double off = reports::largestLinkDifference(frames);
  return {{fmt::format("{} of {}", measured, frames.axes.size()), "joint axes found from their sweeps"},
          {fmt::format("{}\u00a0mm", reports::significant(reports::kMmPerM * off, 2)),
           "largest difference of a distance between axes from the nominal one"},
          {reports::shownLength(rms, 2), "rms by which readings leave their circles, of the worst axis"}};
}

/// What a day without a load gives: position errors by model.
std::vector<KeyNumber> accuracyNumbers(const reports::ReportCampaign& one) {
  using calibration::CalibratedModel;
  std::vector<KeyNumber> numbers;
  for (const calibration::ModelResult& model : one.accuracy->calibration.models) {
    if (model.model == CalibratedModel::gravity) continue;
    if (model.model == CalibratedModel::effects && model.fit.parts.empty()) continue;
    const bool held_out = model.held_out.readings > 0;
    const calibration::PositionErrors& errors = held_out ? model.held_out : model.fitted;
    numbers.push_back({reports::millimetres(errors.rms),
                       fmt::format("rms position error, {}, {}; largest {}", reports::modelWords(model.model),
                                   held_out ? "held out" : "fitted", reports::millimetres(errors.largest))});
  }
  return numbers;
}

}  // namespace

std::vector<KeyNumber> keyNumbers(const reports::ReportContent& content) {
  const reports::ReportCampaign& one = leading(content);
  const auto ofDay = [&](std::vector<KeyNumber> numbers) {
    for (KeyNumber& number : numbers)
      if (content.campaigns.size() > 1) number.words += stateOf(content, one);
    return numbers;
  };
  if (one.accuracy != nullptr) return ofDay(accuracyNumbers(one));
  const frames::MeasuredAxes& axes = one.identification.frames.axes;
  const bool sweeps_alone = one.identification.cases.empty() && !axes.empty() && axes.front().measured;
  if (sweeps_alone) return ofDay(sweepNumbers(one.identification.frames));
  return {deflection(content, one), compensated(content, one), third(content, one)};
}

}  // namespace stiffscope::page
