// How often stated intervals hold the true stiffness, on simulated machines of several families.
//
// interval_coverage FAMILY COUNT SEED [ROWS.csv]: one line of text by model, and one of the link lengths. FAMILY: clean
// (joint springs alone), none (and bearings of a thousandth), single (each effect of the vocabulary in turn), double,
// bearings_links, as_they_are (bearings, links, base and friction at half their usual sizes), outside (something that
// no effect of the vocabulary is); and of springs alone with a fault that is declared as uncertain as it is: gain (of
// the load cell, 1 %), cell_angles (0.5 deg about each axis), cell_point (3 mm along each), masses (all by 5 %), scale
// (of the tracker, 50 ppm). ROWS.csv: every joint and method.

#include <fmt/format.h>
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iostream>
#include <limits>
#include <mutex>
#include <string>
#include <vector>

#include "bench/machine_families.h"
#include "core/extended_model/extend_model.h"
#include "core/frames/frames.h"
#include "core/identification/estimate.h"
#include "core/identification/identify.h"
#include "core/preparation/prepare.h"
#include "core/simulation/machine.h"

namespace {

using namespace stiffscope;

/// How often the 95 % intervals of measured link lengths hold the truth, and how wide they are.
struct Lengths {
  int holds = 0;
  std::vector<double> half_widths, errors;  ///< m
  std::vector<std::array<int, 2>> by_link;

  void add(const frames::Frames& found, const simulation::SimulationSpec& spec) {
    frames::ArmInR0 truth;
    truth.arm = simulation::rigidGeometry(simulation::buildMachine(spec));
    const frames::Links links = frames::linkGeometry(spec.nominal, truth);
    by_link.resize(std::max(by_link.size(), links.size()));
    for (std::size_t i = 0; i < links.size(); ++i) {
      if (!found.links[i].distance_sd) continue;
      constexpr double kNormal = 1.96;  // of 95 %
      half_widths.push_back(kNormal * *found.links[i].distance_sd);
      errors.push_back(std::abs(found.links[i].distance - links[i].distance));
      const bool held = errors.back() <= half_widths.back();
      holds += held;
      by_link[i][0] += held, ++by_link[i][1];
    }
  }
};

/// What each joint gives when it alone is loaded: springs that two joints share are part of it, and of joint 1 what the
/// base gives about the same axis, which no reading tells from it.
JointVector trueCompliance(const simulation::MachineSpec& machine) {
  const auto joints = static_cast<Eigen::Index>(machine.joints.size());
  JointMatrix stiffness = JointMatrix::Zero(joints, joints);
  for (Eigen::Index j = 0; j < joints; ++j) stiffness(j, j) = *machine.joints[static_cast<std::size_t>(j)].torsion;
  for (const simulation::SharedSpring& spring : machine.shared_springs) {
    JointVector arms = JointVector::Zero(joints);
    for (std::size_t k = 0; k < 2; ++k) arms[spring.joints[k]] += spring.arms[k];
    stiffness += spring.rate * arms * arms.transpose();
  }
  JointVector compliance = stiffness.inverse().diagonal();
  if (machine.base_rotation) compliance[0] += 1.0 / machine.base_rotation->z();
  return compliance;
}

struct Row {
  int machine = 0, joint = 0;
  std::string effects, method, model;
  double error = 0.0, half_width = 0.0;  ///< shares of k
  bool holds = false;
};

void addRows(const identification::Identification& result, const char* model, const JointVector& truth, const Row& like,
             std::vector<Row>& rows) {
  for (const identification::Method which : identification::kMethods) {
    if (!result.of(which).available) continue;
    const identification::StiffnessEstimate& estimate = result.of(which).estimate;
    for (int j = 0; j < estimate.joints(); ++j) {
      if (!estimate.identifiable[static_cast<std::size_t>(j)]) continue;
      const identification::CoverageInterval k = identification::stiffnessInterval(estimate, j);
      Row row = like;
      row.joint = j + 1;
      row.method = std::array{"cp", "pp", "dpp"}[static_cast<std::size_t>(which)];
      row.model = model;
      row.error = estimate.stiffness(j) * truth[j] - 1.0;
      row.half_width = 0.5 * (k.high - k.low) * truth[j];
      row.holds = identification::complianceInterval(estimate, j).holds(truth[j]);
      rows.push_back(row);
    }
  }
}

double quantile(std::vector<double> values, double p) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(p * static_cast<double>(values.size() - 1))];
}

void print(const std::string& family, const std::string& model, const Lengths& lengths) {
  fmt::print(
      "{:<15}{:<8} {:>5} link lengths, hold {:5.1f} %, median half width {:.1f} um, median error {:.1f} um (90 %: "
      "{:.1f}), by link",
      family, model, lengths.errors.size(),
      100.0 * lengths.holds / std::max<double>(1.0, static_cast<double>(lengths.errors.size())),
      1e6 * quantile(lengths.half_widths, 0.5), 1e6 * quantile(lengths.errors, 0.5),
      1e6 * quantile(lengths.errors, 0.9));
  for (const auto& own : lengths.by_link) fmt::print(" {:.0f}", 100.0 * own[0] / std::max(1, own[1]));
  fmt::print("\n");
}

void print(const std::string& family, const std::string& model, const std::vector<Row>& rows) {
  std::vector<double> errors, widths;
  std::vector<std::array<int, 2>> by_joint;
  int holds = 0;
  for (const Row& row : rows) {
    if (row.model != model) continue;
    errors.push_back(std::abs(row.error));
    widths.push_back(row.half_width);
    holds += row.holds;
    by_joint.resize(std::max(by_joint.size(), static_cast<std::size_t>(row.joint)));
    auto& own = by_joint[static_cast<std::size_t>(row.joint - 1)];
    own[0] += row.holds, ++own[1];
  }
  fmt::print(
      "{:<15}{:<8} {:>5} intervals, hold {:5.1f} %, median half width {:6.2f} %, median error {:6.2f} % (90 %: {:.1f} "
      "%), by joint",
      family, model, errors.size(), 100.0 * holds / std::max<double>(1.0, static_cast<double>(errors.size())),
      100.0 * quantile(widths, 0.5), 100.0 * quantile(errors, 0.5), 100.0 * quantile(errors, 0.9));
  for (const auto& own : by_joint) fmt::print(" {:.0f}", 100.0 * own[0] / std::max(1, own[1]));
  fmt::print("\n");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::cerr << "interval_coverage FAMILY COUNT SEED [ROWS.csv]; FAMILY is one of " << bench::kFamilies << "\n";
    return 2;
  }
  const std::string family = argv[1];
  const int count = std::stoi(argv[2]);
  const std::uint64_t base = std::stoull(argv[3]);
  std::vector<Row> rows;
  Lengths springs_lengths, default_lengths;
  std::mutex mutex;
  bench::onMachines(
      "interval_coverage", family, count, base, [&](int i, std::uint64_t seed, validation::BlindCase& one) {
        const preparation::PreparedCampaign prepared = preparation::prepareCampaign(bench::dayOf(family, one, seed));
        const identification::IdentifyOptions options = identification::valuesOnly();
        const extended_model::ExtendedModel model =
            extended_model::supportedModel(prepared, prepared.campaign, options);
        Row like;
        like.machine = i;
        like.effects = bench::effectsOf(one);
        const JointVector truth = trueCompliance(one.spec.machine);
        const std::lock_guard<std::mutex> lock(mutex);
        addRows(model.without, "springs", truth, like, rows);
        addRows(model.with, "default", truth, like, rows);
        springs_lengths.add(model.without.frames, one.spec);
        default_lengths.add(model.with.frames, one.spec);
      });
  print(family, "springs", rows);
  print(family, "default", rows);
  print(family, "springs", springs_lengths);
  print(family, "default", default_lengths);
  if (argc > 4) {
    std::ofstream csv(argv[4]);
    csv << "machine,effects,joint,method,model,error,half_width,holds\n";
    for (const Row& row : rows)
      csv << fmt::format("{},{},{},{},{},{:.6g},{:.6g},{}\n", row.machine, row.effects, row.joint, row.method,
                         row.model, row.error, row.half_width, row.holds ? 1 : 0);
  }
}
