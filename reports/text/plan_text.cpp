#include "core/planning/plan.h"
#include "reports/text/text.h"

#include <fmt/format.h>
#include <cmath>
#include <iterator>

#include "core/campaign/joint_reading.h"
#include "core/io/units.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

using Out = std::back_insert_iterator<std::string>;

/// Uncertainties of the joints that would be seen, in 1e-9 rad/Nm, or per cent of k where k is known.
void writeUncertainties(const planning::Plan& plan, const std::string& name, const JointVector& sd, Out out) {
  fmt::format_to(out, "  {:<28}", name);
  for (std::size_t j = 0; j < plan.unknown.size(); ++j) {
    const auto joint = static_cast<Eigen::Index>(j);
    if (!plan.unknown[j]) {
      fmt::format_to(out, "{:>10}", "-");
    } else if (plan.compliance && (*plan.compliance)[joint] != 0.0) {
      fmt::format_to(out, "{:>10.3f}", 100.0 * sd[joint] / std::abs((*plan.compliance)[joint]));
    } else {
      fmt::format_to(out, "{:>10.4f}", 1e9 * sd[joint]);
    }
  }
  fmt::format_to(out, "\n");
}

void writePostures(const campaign::Campaign& campaign, const planning::Plan& plan, Out out) {
  const campaign::JointConvention convention(campaign.joint_readings, campaign.robot.joints());
  fmt::format_to(out, "\n  {:<8}", "pose");
  const int joints = plan.arm.geometry.arm.joints();
  for (int joint = 1; joint <= joints; ++joint) fmt::format_to(out, "{:>9}", fmt::format("q{} (deg)", joint));
  fmt::format_to(out, "{:>11}{}\n", "log det +", plan.arm.pull ? "   pull in base_link" : "");
  for (const planning::PlannedPosture& posture : plan.postures) {
    fmt::format_to(out, "  {:<8}", posture.id);
    for (const double figure : convention.figures(posture.candidate.q))
      fmt::format_to(out, "{:>9.2f}", unsignedZero(figure / io::kDegree, 2));
    fmt::format_to(out, "{:>11}",
                   std::isfinite(posture.log_det_gain) ? fmt::format("{:.2f}", posture.log_det_gain) : "-");
    if (plan.arm.pull) {
      const Eigen::Vector3d& pull = posture.pull_in_base;
      fmt::format_to(out, "   {:>5.2f} {:>5.2f} {:>5.2f}", unsignedZero(pull.x(), 2), unsignedZero(pull.y(), 2),
                     unsignedZero(pull.z(), 2));
    }
    fmt::format_to(out, "\n");
  }
  if (!campaign.joint_readings.empty()) fmt::format_to(out, "  {}\n", kAsControllerStates);
}

void writeGain(const planning::Plan& plan, Out out) {
  fmt::format_to(out, "\nExpected standard uncertainty, {}\n  {:<28}",
                 plan.compliance ? "per cent of the identified k" : "of 1/k, 1e-9 rad/Nm", "");
  for (std::size_t joint = 1; joint <= plan.unknown.size(); ++joint)
    fmt::format_to(out, "{:>10}", fmt::format("k{}", joint));
  fmt::format_to(out, "\n");
  if (plan.measured > 0)
    writeUncertainties(plan, fmt::format("measured, {} postures", plan.measured), plan.sd_measured, out);
  writeUncertainties(plan, fmt::format("{}{} planned", plan.measured > 0 ? "and " : "", plan.postures.size()),
                     plan.postures.back().sd, out);
  for (const planning::RandomPostures* random : {&plan.random_same, &plan.random_double}) {
    writeUncertainties(plan, fmt::format("{}{} random (median)", plan.measured > 0 ? "and " : "", random->postures),
                       random->sd, out);
  }
  fmt::format_to(out, "  {}\n", wrapped(words(Remark(planning::RemarkId::sd_of_weighted_fit)), 2));
  if (plan.measured == 0) {
    fmt::format_to(out, "  by the determinant, one planned posture tells as much as {:.1f} random ones\n",
                   plan.random_same.efficiency);
  }
}

std::string joined(const Eigen::Ref<const Eigen::VectorXd>& values, int decimals, const char* between,
                   double factor = 1.0) {
  std::string text;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    text += fmt::format("{}{:.{}f}", i > 0 ? between : "", values[i] * factor, decimals);
  }
  return text;
}

}  // namespace

std::string planText(const campaign::Campaign& campaign, const planning::Plan& plan) {
  std::string text;
  Out out(text);
  fmt::format_to(out, "{}: {} postures {}, {:.0f} N {}; chosen from {} of {} drawn\n", campaign.name, plan.asked,
                 plan.measured > 0 ? "to add" : "to measure", plan.arm.load, plan.arm.pull ? "of pull" : "hanging",
                 plan.candidates, plan.drawn);
  for (const std::string& assumed : words(plan.arm.assumed))
    fmt::format_to(out, "  {}\n", wrapped("taken: " + assumed, 4));
  if (!plan.usable) {
    fmt::format_to(out, "  no plan: {}\n", words(plan.reason));
    return text;
  }
  for (std::size_t j = 0; j < plan.unknown.size(); ++j) {
    if (!plan.unknown[j]) {
      fmt::format_to(out, "  {}\n",
                     wrapped(fmt::format("k{} will not be seen: {}", j + 1, words(plan.not_seen[j])), 4));
    }
  }
  if (static_cast<int>(plan.postures.size()) < plan.asked) {
    fmt::format_to(out, "  only {} postures keep apart from each other within the limits\n", plan.postures.size());
  }
  if (plan.postures.empty()) return text;
  writePostures(campaign, plan, out);
  writeGain(plan, out);
  return text;
}

std::string planCsv(const campaign::Campaign& campaign, const planning::Plan& plan) {
  const campaign::JointConvention convention(campaign.joint_readings, campaign.robot.joints());
  std::string text = "pose";
  for (int joint = 1; joint <= plan.arm.geometry.arm.joints(); ++joint) text += fmt::format(",q{}_deg", joint);
  text += ",fx_n,fy_n,fz_n,mx_nm,my_nm,mz_nm,pull_x,pull_y,pull_z\n";
  for (const planning::PlannedPosture& posture : plan.postures) {
    text += fmt::format("{},{},{},{}\n", posture.id,
                        joined(convention.figures(posture.candidate.q), 5, ",", 1.0 / io::kDegree),
                        joined(posture.reading, 3, ","), joined(posture.pull_in_base, 6, ","));
  }
  return text;
}

std::string planXml(const planning::Plan& plan) {
  std::string text = "<postures>\n";
  for (const planning::PlannedPosture& posture : plan.postures) {
    text += fmt::format("  <posture q_deg=\"{}\"", joined(posture.candidate.q, 5, " ", 1.0 / io::kDegree));
    if (plan.arm.pull) text += fmt::format(" pull=\"{}\"", joined(posture.pull_in_base, 6, " "));
    text += "/>\n";
  }
  return text + "</postures>\n";
}

}  // namespace stiffscope::reports
