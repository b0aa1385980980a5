#include <CLI/CLI.hpp>
#include <memory>
#include <utility>

#include "app/command_line.h"
#include "app/output.h"
#include "app/prepared.h"
#include "core/campaign/campaign.h"
#include "core/diagnosis/diagnose.h"
#include "core/diagnosis/diagnosis.h"
#include "reports/json/campaign_json.h"
#include "reports/json/json.h"
#include "reports/json/json_document.h"
#include "reports/text/text.h"

namespace stiffscope::app {

void addDiagnose(CLI::App& app, Run& run) {
  struct DiagnoseArguments {
    std::string campaign, json;
  };
  const auto arguments = std::make_shared<DiagnoseArguments>();
  CLI::App* command =
      app.add_subcommand("diagnose", "What the stiffness model misses: where, which effect, how far it shrinks");
  command->add_option("CAMPAIGN", arguments->campaign, "campaign folder or its campaign.xml")->required();
  command->add_option("--json", arguments->json, "write the result to this file, - for standard output");
  command->callback([arguments, &run] {
    run = [arguments] {
      campaign::Campaign campaign = openCampaign(arguments->campaign);
      const campaign::Campaign words = described(campaign);
      const diagnosis::Diagnosis diagnosis = diagnosis::diagnose(std::move(campaign));
      deliver([&] { return reports::diagnosisJson(words, diagnosis); },
              [&] { return reports::diagnosisText(words, diagnosis); }, arguments->json);
      return diagnosis.usable ? kDone : kNotUsable;
    };
  });
}

}  // namespace stiffscope::app
