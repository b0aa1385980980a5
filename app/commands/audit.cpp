#include "core/audit/audit.h"

#include <CLI/CLI.hpp>
#include <memory>

#include "app/command.h"
#include "app/output.h"
#include "core/diagnosis/diagnose.h"
#include "core/diagnosis/separable_effects.h"
#include "core/identification/load_step.h"
#include "reports/json/audit_json.h"
#include "reports/text/audit_text.h"

namespace stiffscope {

void addAudit(CLI::App& app, Run& run) {
  struct Arguments {
    std::string campaign, json;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("audit", "Is this data fit to identify from?");
  command->add_option("CAMPAIGN", arguments->campaign, "campaign folder or its campaign.xml")->required();
  command->add_option("--json", arguments->json, "write the result to this file, - for standard output");
  command->callback([arguments, &run] {
    run = [arguments] {
      const Campaign campaign = openCampaign(arguments->campaign);
      AuditReport report = audit(campaign);
      DiagnoseOptions design;  // what could be told apart is asked, not what is there
      design.resamples = design.chance_draws = 0;
      // With a unit wrong nothing could be told apart, and the search would not settle for a minute.
      const bool worth_asking = whatLoadsLack(campaign).empty() && !findsTheImpossible(report);
      if (worth_asking) addSeparableEffects(diagnose(campaign, design), report);
      deliver([&] { return auditJson(campaign, report); }, [&] { return auditText(campaign, report); },
              arguments->json);
      return report.verdict == AuditVerdict::fail ? kNotUsable : kDone;
    };
  });
}

}  // namespace stiffscope
