#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "app/command_line.h"
#include "app/computations.h"
#include "app/options.h"
#include "app/output.h"
#include "core/campaign/write_campaign.h"
#include "core/io/read_file.h"
#include "core/simulation/measure.h"
#include "core/simulation/read_spec.h"
#include "reports/json/json.h"
#include "reports/json/json_document.h"

namespace stiffscope::app {

int simulateDay(const SimulateRequest& request, const Outlet& outlet) {
  const simulation::SimulationSpec spec = simulation::readSimulationSpec(request.spec);
  const std::string expectation = request.replace ? "" : kOrReplace;
  if (!request.replace) requireNoCampaign(request.out, expectation);
  // A description that stands where the campaign goes would be lost.
  for (const char* const file : {"campaign.xml", "truth.json"})
    io::requireNotRead(std::filesystem::path(request.out) / file);
  const std::vector<int> rigid = simulation::rigidJoints(spec);
  // On a day without a load rigid joints are what most have.
  if (!rigid.empty() && spec.loading) {
    outlet.warn(fmt::format("{}: joints: no stiffness_nm_per_rad for joint{} {}: taken as rigid", request.spec,
                            rigid.size() == 1 ? "" : "s", fmt::join(rigid, ", ")));
  }
  const campaign::Tracker& declared = spec.tracker.declared;
  if (declared.range_fixed + declared.range_per_m <= 0.0 || declared.angle_fixed + declared.angle_per_m <= 0.0) {
    outlet.warn(request.spec +
                ": tracker: no noise declared in range or in angle: no command reads such a "
                "campaign; for readings without noise declare some and set true_noise_factor=\"0\"");
  }
  const reports::Json truth = reports::truthJson(spec);
  campaign::Campaign simulated = simulation::simulate(spec);
  // Whoever is handed the folder, or a report of it, is not to take it for a machine that was measured.
  simulated.texts.note = "simulated by stiffscope; no machine was measured.";
  campaign::writeCampaign(simulated, spec.urdf_file, request.out, {{"truth.json", textOf(truth) + '\n'}},
                          campaign::WrittenDigits::of_the_format, expectation);
  outlet.deliver([&] { return truth; }, [&] { return request.out + ": campaign written\n"; });
  return kDone;
}

void addSimulate(CLI::App& app, Run& run) {
  const auto arguments = std::make_shared<SimulateRequest>();
  CLI::App* command = app.add_subcommand("simulate", "A campaign measured on a described machine");
  command->add_option("SPEC", arguments->spec, "description of the machine and the day (XML)")->required();
  command->add_option("--out", arguments->out, "campaign folder to write, with truth.json: what the machine truly is")
      ->required();
  command->add_flag("--replace", arguments->replace, "write over a campaign that is there");
  command->callback(
      [arguments, &run] { run = [arguments] { return simulateDay(*arguments, commandLineOutlet("")); }; });
}

}  // namespace stiffscope::app
