#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "app/command.h"
#include "app/output.h"
#include "core/campaign/write_campaign.h"
#include "core/simulation/read_spec.h"
#include "core/simulation/simulate.h"

namespace stiffscope {

void addSimulate(CLI::App& app, Run& run) {
  struct Arguments {
    std::string spec, out;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("simulate", "A campaign measured on a described machine");
  command->add_option("SPEC", arguments->spec, "description of the machine and the day (XML)")->required();
  command->add_option("--out", arguments->out, "campaign folder to write")->required();
  command->callback([arguments, &run] {
    run = [arguments] {
      const SimulationSpec spec = readSimulationSpec(arguments->spec);
      const std::vector<int> rigid = rigidJoints(spec);
      if (!rigid.empty()) {
        printWarnings({fmt::format("{}: joints: no stiffness_nm_per_rad for joint{} {}: taken as rigid", arguments->spec,
                                   rigid.size() == 1 ? "" : "s", fmt::join(rigid, ", "))});
      }
      writeCampaign(simulate(spec), spec.urdf_file, arguments->out);
      std::printf("%s: campaign written\n", arguments->out.c_str());
      return kDone;
    };
  });
}

}  // namespace stiffscope
