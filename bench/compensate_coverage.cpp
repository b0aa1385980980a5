// How often the intervals that `compensate` states hold the true deflection, on simulated machines, by direction of
// load.
//
// compensate_coverage FAMILY COUNT SEED [ROWS.csv]: a table. FAMILY as in machine_families.h. Each machine is
// identified from a day of hanging weights; then, at postures that the day did not have, a load of the day's largest
// size pulls down, up, radially away from axis 1, sideways, and towards axis 1 at the height of axis 2, and the
// deflection that the simulator's nonlinear equilibrium gives each reflector is held against what is predicted,
// coordinate by coordinate. Sideways loads turn axis 1, which hanging weights do not show: once as the day is, once
// with k1 known from elsewhere to 3 %.

#include <fmt/format.h>
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iostream>
#include <map>
#include <mutex>
#include <numeric>
#include <string>
#include <vector>

#include "bench/machine_families.h"
#include "core/compensation/compensate.h"
#include "core/extended_model/effect_deflection.h"
#include "core/extended_model/extend_model.h"
#include "core/identification/known_stiffness.h"
#include "core/numerics/random.h"
#include "core/preparation/prepare.h"
#include "core/simulation/instruments.h"
#include "core/simulation/measure.h"
#include "core/simulation/postures.h"
#include "reports/words/compensation_words.h"

namespace {

using namespace stiffscope;

constexpr std::array kDirections{"down", "up", "radial", "lateral", "lateral, k1 known", "through axis 1"};
constexpr std::size_t kLateralKnown = 4;
constexpr double kKnownTo = 0.03;
constexpr double kLeastSinQ5 = 0.3;  // no singular wrists, which are refused whatever the load

/// Unit directions of the load on the hook at `hook` (base_link), in the order of kDirections.
std::array<Eigen::Vector3d, kDirections.size()> directionsAt(const robot::Robot& arm, const Eigen::Vector3d& hook) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const metrology::Line& axis = arm.axes_in_base_at_zero[0];
  Eigen::Vector3d radial = hook - axis.point;
  radial.z() = 0.0;
  radial.normalize();
  Eigen::Vector3d towards = axis.point;
  towards.z() = arm.axes_in_base_at_zero[1].point.z();
  const Eigen::Vector3d lateral = up.cross(radial);
  return {-up, up, radial, lateral, lateral, (towards - hook).normalized()};
}

/// A load on the machine, as asked for and as it comes out.
struct TrueCase {
  std::size_t direction = 0;
  compensation::PostureToCompensate asked;
  std::vector<Eigen::Vector3d> moves;  ///< of the reflectors, base_link, m
};

std::vector<TrueCase> trueCases(const simulation::SimulationSpec& spec, double force,
                                const std::vector<JointVector>& postures) {
  const simulation::ElasticMachine machine = simulation::buildMachine(spec);
  const auto parent = std::find_if(spec.nominal.links.begin(), spec.nominal.links.end(),
                                   [&](const auto& link) { return link.name == spec.load_cell->declared.parent; });
  std::vector<TrueCase> cases;
  for (const JointVector& q : postures) {
    const simulation::MachineState unloaded = simulation::equilibrium(machine, q);
    const Eigen::VectorXd anchors = simulation::arrivedAnchors(machine, unloaded);
    const Eigen::Vector3d hook = unloaded.base_from_flange * spec.loading->hook_in_flange;
    const auto directions = directionsAt(spec.nominal, hook);
    for (std::size_t d = 0; d < directions.size(); ++d) {
      const Eigen::Vector3d pull = force * directions[d];
      const simulation::MachineState loaded = simulation::equilibrium(
          machine, q, simulation::DeadForce{spec.loading->hook_in_flange, pull, Eigen::Vector3d::Zero()}, &anchors);
      if (!unloaded.converged || !loaded.converged) continue;
      // What a load cell without faults would read, in the axes of the unloaded arm, as a plan has it.
      simulation::MachineState planned = unloaded;
      planned.load_point_in_base = hook;
      planned.load_force_in_base = pull;
      TrueCase one{d, {std::to_string(cases.size()), q, {}}, {}};
      one.asked.wrench_in_cell = simulation::loadWrenchInCell(machine, planned, *parent, spec.load_cell->declared,
                                                              spec.load_cell->place_error);
      for (std::size_t t = 0; t < loaded.targets_in_base.size(); ++t)
        one.moves.push_back(loaded.targets_in_base[t] - unloaded.targets_in_base[t]);
      cases.push_back(std::move(one));
    }
  }
  return cases;
}

struct Row {
  int machine = 0;
  std::size_t direction = 0;
  std::string model, effects, reason;
  bool solved = false;
  int coordinates = 0, held = 0;
  double size = 0.0, expanded = 0.0, error = 0.0;  ///< of the reflectors, rms, m
};

void addRows(const campaign::Campaign& campaign, const identification::Identification& result,
             const effects::EffectDeflection* with, const compensation::Certainty& certainty,
             const std::vector<TrueCase>& cases, bool known, const Row& like, std::vector<Row>& rows) {
  const identification::MethodResult& method = result.of(identification::bestMethod(result));
  const Eigen::Matrix3d& r0_from_base = method.geometry.r0_from_base_link.linear();
  for (const TrueCase& one : cases) {
    if ((one.direction == kLateralKnown) != known) continue;
    const compensation::CompensatedPosture found =
        compensation::compensate(campaign, method.geometry, method.estimate, result.frames.tcp_in_flange, {one.asked},
                                 {}, with, &certainty)
            .front();
    Row row = like;
    row.direction = one.direction;
    row.solved = found.solved;
    if (!found.solved) row.reason = reports::refusalWords(found.reason);
    double size = 0.0, expanded = 0.0, error = 0.0;
    for (std::size_t t = 0; t < found.targets.size(); ++t) {
      const Eigen::Vector3d truth = r0_from_base * one.moves[t];
      const compensation::PointDeflection& point = found.targets[t];
      for (std::size_t k = 0; k < 3; ++k)
        row.held += point.interval[k].holds(truth[static_cast<Eigen::Index>(k)]), ++row.coordinates;
      size += truth.squaredNorm();
      expanded += point.expanded * point.expanded;
      error += (truth - point.deflection).squaredNorm();
    }
    const auto count = static_cast<double>(std::max<std::size_t>(1, found.targets.size()));
    row.size = std::sqrt(size / count), row.expanded = std::sqrt(expanded / count),
    row.error = std::sqrt(error / count);
    rows.push_back(row);
  }
}

void judge(const simulation::SimulationSpec& spec, const std::vector<TrueCase>& cases, std::uint64_t seed,
           const Row& like, std::vector<Row>& rows) {
  const preparation::PreparedCampaign prepared = preparation::prepareCampaign(simulation::simulate(spec));
  const identification::IdentifyOptions options = identification::valuesOnly();
  extended_model::ExtendedModel model = extended_model::supportedModel(prepared, prepared.campaign, options);
  const identification::Method method = identification::bestMethod(model.with);
  const double load_sd = model.campaign.load_cell->gain_sigma;
  numerics::RandomStream random(seed, "known elsewhere");
  const double k1 = *spec.machine.joints[0].torsion;
  const std::vector<campaign::KnownStiffness> known{
      {0, k1 * (1.0 + kKnownTo * random.normal()), k1 * kKnownTo, "simulated"}};
  for (const bool with_known : {false, true}) {
    if (with_known) {
      for (identification::Identification* result : {&model.with, &model.without})
        identification::completeByKnown(known, result->methods[static_cast<std::size_t>(method)].estimate);
    }
    Row row = like;
    row.model = "springs";
    addRows(prepared.campaign, model.without, nullptr, compensation::certaintyOf(model.without, method, load_sd), cases,
            with_known, row, rows);
    row.model = "default";
    std::optional<effects::EffectDeflection> with;
    if (extended_model::deflectsByEffects(model.effects)) with = extended_model::effectDeflection(model, method);
    addRows(model.campaign, model.with, with ? &*with : nullptr, compensation::certaintyOf(model, method, load_sd),
            cases, with_known, row, rows);
  }
}

void print(const std::string& family, const std::string& model, std::size_t direction, const std::vector<Row>& rows) {
  std::size_t all = 0, solved = 0;
  int coordinates = 0, held = 0, refused_coordinates = 0, refused_held = 0;
  std::vector<double> sizes, widths, errors;
  std::map<std::string, int> reasons;
  for (const Row& row : rows) {
    if (row.model != model || row.direction != direction) continue;
    ++all;
    if (!row.solved) {
      ++reasons[row.reason];
      refused_coordinates += row.coordinates, refused_held += row.held;
      continue;
    }
    ++solved;
    coordinates += row.coordinates, held += row.held;
    sizes.push_back(row.size * 1e3), widths.push_back(row.expanded / row.size), errors.push_back(row.error / row.size);
  }
  fmt::print(
      "{:<15}{:<9}{:<18} {:>4} of {:>4} compensated, hold {:5.1f} %, median deflection {:.3f} mm, U {:5.1f} %, "
      "error {:5.1f} %; refused hold {:5.1f} %",
      family, model, kDirections[direction], solved, all, 100.0 * held / std::max(1, coordinates), bench::median(sizes),
      100.0 * bench::median(widths), 100.0 * bench::median(errors),
      100.0 * refused_held / std::max(1, refused_coordinates));
  for (const auto& [reason, count] : reasons) fmt::print("; {} because {}", count, reason);
  fmt::print("\n");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::cerr << "compensate_coverage FAMILY COUNT SEED [ROWS.csv]; FAMILY is one of " << bench::kFamilies << "\n";
    return 2;
  }
  const std::string family = argv[1];
  const int count = std::stoi(argv[2]);
  const std::uint64_t base = std::stoull(argv[3]);
  std::vector<Row> rows;
  std::mutex mutex;
  bench::onMachines("compensate_coverage", family, count, base,
                    [&](int i, std::uint64_t seed, validation::BlindCase& one) {
                      const double force = bench::hangWeights(*one.spec.loading);
                      constexpr int kPostures = 6;
                      const std::vector<TrueCase> cases =
                          trueCases(one.spec, force, bench::heldOutPostures(one.spec, kPostures, kLeastSinQ5));
                      Row like;
                      like.machine = i;
                      like.effects = bench::effectsOf(one);
                      std::vector<Row> own;
                      judge(one.spec, cases, seed, like, own);
                      const std::lock_guard<std::mutex> lock(mutex);
                      rows.insert(rows.end(), own.begin(), own.end());
                    });
  for (const char* model : {"springs", "default"}) {
    for (std::size_t d = 0; d < kDirections.size(); ++d) print(family, model, d, rows);
  }
  if (argc > 4) {
    std::ofstream csv(argv[4]);
    csv << "machine,effects,model,direction,solved,reason,coordinates,held,deflection_m,u_m,error_m\n";
    for (const Row& row : rows)
      csv << fmt::format("{},{},{},\"{}\",{},{},{},{},{:.6g},{:.6g},{:.6g}\n", row.machine, row.effects, row.model,
                         kDirections[row.direction], row.solved ? 1 : 0, row.reason, row.coordinates, row.held,
                         row.size, row.expanded, row.error);
  }
}
