#include "app/figures/deflection_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "app/figures/arm_pose.h"
#include "render/ticks.h"
#include "reports/page/html.h"
#include "reports/page/names.h"
#include "reports/page/numbers.h"

namespace stiffscope {

namespace {

constexpr double kMmPerM = 1e3;

void nameVectors(ArmScene& scene, std::optional<Method> method) {
  if (!method) return;
  scene.predicted_name = fmt::format("predicted by {}", page::shortName(*method));
  scene.residual_name = fmt::format("residual of {}", page::shortName(*method));
}

std::string kilonewtons(double newtons) { return fmt::format("{}\u00a0kN", page::fixed(1e-3 * newtons, 2)); }

/// R0 in the scene, whose floor is at the foot of axis 1.
Eigen::Vector3d placeOfR0(const ReportCampaign& one) { return {0.0, 0.0, heightOfR0(one.identification.frames)}; }

std::string framesWords(const ReportCampaign& one) {
  return fmt::format("The axes drawn are R_{{0}}, {} mm above base_link.",
                     page::fixed(kMmPerM * heightOfR0(one.identification.frames), 0));
}

/// "The same load moves", or the range of loads where they differ by more than a fiftieth.
std::string loadWords(const Identification& identification) {
  std::vector<double> forces;
  for (const LoadCase& load_case : identification.cases) forces.push_back(load_case.wrench.force.norm());
  const auto [least, most] = std::minmax_element(forces.begin(), forces.end());
  if (*most <= 1.02 * *least) return "The same load moves";
  return fmt::format("Loads of {} to {} move", kilonewtons(*least), kilonewtons(*most));
}

/// The point whose vectors the scene of all postures shows.
std::string vectorPoint(const ReportCampaign& one) {
  if (page::judgedPoint(one).at_wrist) return "P_{wrist}";
  return page::pointName(one.campaign.targets.front().id);
}

}  // namespace

std::size_t medianCase(const ReportCampaign& one) {
  const auto& values = page::displacementAt(one.identification, page::judgedPoint(one).at_wrist);
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto middle = order.begin() + static_cast<std::ptrdiff_t>((order.size() - 1) / 2);
  std::nth_element(order.begin(), middle, order.end(), [&](std::size_t a, std::size_t b) {
    return values[a] != values[b] ? values[a] < values[b] : a < b;
  });
  return *middle;
}

ArmScene postureScene(const ReportCampaign& one, std::size_t index, std::optional<Method> method) {
  const double force = one.identification.cases[index].wrench.force.norm();
  ArmScene scene;
  scene.title = fmt::format("Deflection in posture {} under {}", page::postureName(one, index), kilonewtons(force));
  scene.subtitle = page::asIs(one.campaign.name);
  scene.poses = {armPose(one, index, method)};
  nameVectors(scene, method);
  scene.residual_factor = automaticResidualFactor(scene);
  scene.frame_origin = placeOfR0(one);
  return scene;
}

ArmScene deflectionScene(const ReportCampaign& one) {
  return postureScene(one, medianCase(one), page::shownMethod(one.identification));
}

ArmScene allPosturesScene(const ReportCampaign& one) {
  ArmScene scene;
  scene.title =
      fmt::format("Deflection of {} in all {} postures", vectorPoint(one), one.identification.cases.size());
  scene.subtitle = page::asIs(one.campaign.name);
  const auto method = page::shownMethod(one.identification);
  nameVectors(scene, method);
  scene.frame_origin = placeOfR0(one);
  for (std::size_t i = 0; i < one.identification.cases.size(); ++i) {
    ArmPose pose = armPose(one, i, method);
    pose.ghost = true;
    const std::string shown = vectorPoint(one);  // P_wrist is not among the targets: none of them stays
    std::erase_if(pose.targets, [&](const ScenePoint& target) { return target.label != shown; });
    // What is left is too small beside so many arrows.
    for (ScenePoint& target : pose.targets) target.residual.reset();
    if (pose.wrist) pose.wrist->residual.reset();
    scene.poses.push_back(std::move(pose));
  }
  return scene;
}

Figure describeDeflectionScene(const ReportCampaign& one, double magnification) {
  const std::size_t index = medianCase(one);
  const page::JudgedPoint point = page::judgedPoint(one);
  const double displacement = kMmPerM * page::displacementAt(one.identification, point.at_wrist)[index];
  Figure figure;
  figure.id = "deflection";
  figure.title = fmt::format("Deflection in posture {}", page::postureName(one, index));
  figure.caption =
      fmt::format("The posture with the median displacement of {}, {}\u00a0mm, magnified {} times.",
                  point.name, page::fixed(displacement, 2), factorText(magnification));
  if (const auto shown = page::shownMethod(one.identification)) {
    const double left = kMmPerM * page::residualAt(one.identification.of(*shown), point.at_wrist)[index];
    figure.caption += fmt::format(" Where the arrows part is what {} leaves: {}\u00a0mm at {}",
                                  page::shortName(*shown), page::significant(left, 2), point.name);
    const double factor = deflectionScene(one).residual_factor;
    figure.caption += factor > 1 ? fmt::format(", drawn {} times longer than the others.", page::fixed(factor, 0)) : ".";
  }
  figure.caption += fmt::format(" {}", framesWords(one));
  figure.alt = fmt::format(
      "The arm in posture {} with arrows for the measured, predicted and residual displacement of its reflectors{}, "
      "magnified {} times.",
      page::plain(page::postureName(one, index)), point.at_wrist ? " and wrist centre" : "", factorText(magnification));
  return figure;
}

Figure describeAllPostures(const ReportCampaign& one, double magnification) {
  const page::JudgedPoint point = page::judgedPoint(one);
  const auto& values = page::displacementAt(one.identification, point.at_wrist);
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  Figure figure;
  figure.id = "all-postures";
  figure.title = fmt::format("Deflection of {} in all postures", vectorPoint(one));
  figure.caption = fmt::format(
      "{} {} by {} to {}\u00a0mm, depending on the posture; vectors magnified {} "
      "times. {}",
      loadWords(one.identification), point.name, page::fixed(kMmPerM * *least, 2),
      page::fixed(kMmPerM * *most, 2), factorText(magnification), framesWords(one));
  figure.alt =
      fmt::format("All {} postures of the arm, pale, with an arrow for the displacement of {} in each.",
                  values.size(), page::plain(vectorPoint(one)));
  return figure;
}

}  // namespace stiffscope
