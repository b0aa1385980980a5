#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/campaign/joint_reading.h"
#include "core/io/units.h"
#include "core/planning/unloaded_plan.h"
#include "reports/text/text.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

using Out = std::back_insert_iterator<std::string>;

std::string angles(const JointVector& q, const char* between) {
  std::string text;
  for (Eigen::Index j = 0; j < q.size(); ++j)
    text += fmt::format("{}{:.5f}", j > 0 ? between : "", unsignedZero(q[j] / io::kDegree, 5));
  return text;
}

void writePostures(const campaign::Campaign& campaign, const planning::UnloadedPlan& plan, Out out) {
  const campaign::JointConvention convention(campaign.joint_readings, campaign.robot.joints());
  fmt::format_to(out, "\n  {:<8}", "pose");
  const int joints = plan.arm.geometry.arm.joints();
  for (int joint = 1; joint <= joints; ++joint) fmt::format_to(out, "{:>9}", fmt::format("q{} (deg)", joint));
  fmt::format_to(out, "{:>15}{:>10}\n", "predicted, mm", "gain, %");
  for (const planning::UnloadedPosture& posture : plan.postures) {
    fmt::format_to(out, "  {:<8}", posture.id);
    for (const double figure : convention.figures(posture.q))
      fmt::format_to(out, "{:>9.2f}", unsignedZero(figure / io::kDegree, 2));
    fmt::format_to(out, "{:>15.4f}{:>10.1f}\n", posture.predicted / io::kMillimetre, 100.0 * posture.gain);
  }
  if (!campaign.joint_readings.empty()) fmt::format_to(out, "  {}\n", kAsControllerStates);
  fmt::format_to(out, "  {}\n",
                 wrapped("In the order of the day: it tells effects of the order (backlash, read-back, drift) apart. "
                         "predicted: rms uncertainty of a position over the workspace with it and all before, effects "
                         "unknown; gain: by how much its variance grows without this one.",
                         2));
}

void writeGain(const planning::UnloadedPlan& plan, Out out) {
  fmt::format_to(out, "\nPredicted rms uncertainty of a 3-D position over the workspace, mm\n  {:<28}{:>18}{:>18}\n",
                 "", "effects unknown", "geometry alone");
  const auto row = [&](const std::string& name, double predicted, double geometry) {
    fmt::format_to(out, "  {:<28}{:>18.4f}{:>18.4f}\n", name, predicted / io::kMillimetre, geometry / io::kMillimetre);
  };
  row(fmt::format("{} planned", plan.postures.size()), plan.sight.predicted, plan.sight.predicted_geometry);
  for (const planning::RandomSight* random : {&plan.random_same, &plan.random_double})
    row(fmt::format("{} random (median)", random->postures), random->predicted, random->predicted_geometry);
}

void writeEffects(const planning::UnloadedPlan& plan, Out out) {
  fmt::format_to(out,
                 "\nEffects told apart, planned and random: what one has to move the reflectors to be seen by three "
                 "sigma, mm\n  {:<36}{:>12}{:>12}{:>14}{:>14}\n",
                 "", "planned", "random", "inflation", "of random");
  const auto figure = [](double value, double unit, int decimals) {
    return std::isfinite(value) && value / unit < 1e4 ? fmt::format("{:.{}f}", value / unit, decimals)
                                                      : std::string("not seen");
  };
  for (std::size_t e = 0; e < plan.sight.effects.size(); ++e) {
    const planning::EffectSight &own = plan.sight.effects[e], &random = plan.random_same.effects[e];
    std::string name = own.effect;
    std::replace(name.begin(), name.end(), '_', ' ');
    if (!own.detail.empty()) name += ", " + own.detail;
    fmt::format_to(out, "  {:<36}{:>12}{:>12}{:>14}{:>14}\n", name, figure(own.detectable, io::kMillimetre, 3),
                   figure(random.detectable, io::kMillimetre, 3), figure(own.inflation, 1.0, 2),
                   figure(random.inflation, 1.0, 2));
  }
  fmt::format_to(out, "  {}\n",
                 wrapped("inflation: of its standard uncertainty by the other effects; 1 is told apart from all.", 2));
}

}  // namespace

std::string unloadedPlanText(const campaign::Campaign& campaign, const planning::UnloadedPlan& plan) {
  std::string text;
  const Out out(text);
  fmt::format_to(out, "{}: {} postures to measure without a load; chosen from {} of {} drawn\n", campaign.name,
                 plan.asked, plan.candidates, plan.drawn);
  for (const std::string& assumed : words(plan.arm.assumed))
    fmt::format_to(out, "  {}\n", wrapped("taken: " + assumed, 4));
  if (static_cast<int>(plan.postures.size()) < plan.asked)
    fmt::format_to(out, "  only {} postures keep apart from each other within the limits\n", plan.postures.size());
  if (plan.postures.empty()) return text;
  writePostures(campaign, plan, out);
  writeGain(plan, out);
  writeEffects(plan, out);
  return text;
}

std::string unloadedPlanCsv(const campaign::Campaign& campaign, const planning::UnloadedPlan& plan) {
  const campaign::JointConvention convention(campaign.joint_readings, campaign.robot.joints());
  std::string text = "pose";
  for (int joint = 1; joint <= plan.arm.geometry.arm.joints(); ++joint) text += fmt::format(",q{}_deg", joint);
  text += "\n";
  for (const planning::UnloadedPosture& posture : plan.postures)
    text += fmt::format("{},{}\n", posture.id, angles(convention.figures(posture.q), ","));
  return text;
}

std::string unloadedPlanXml(const planning::UnloadedPlan& plan) {
  std::string text = "<postures>\n";
  for (const planning::UnloadedPosture& posture : plan.postures)
    text += fmt::format("  <posture q_deg=\"{}\"/>\n", angles(posture.q, " "));
  return text + "</postures>\n";
}

}  // namespace stiffscope::reports
