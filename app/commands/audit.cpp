#include "core/audit/audit.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <utility>

#include "app/command.h"
#include "app/described.h"
#include "app/large_heap.h"
#include "app/output.h"
#include "core/diagnosis/diagnose.h"
#include "core/diagnosis/evenly_spread.h"
#include "core/diagnosis/separable_effects.h"
#include "core/identification/load_step.h"
#include "reports/json/audit_json.h"
#include "reports/text/audit_text.h"

namespace stiffscope {

namespace {

/// What could be told apart by these loads is asked, not what is there.
Diagnosis designOf(const Campaign& campaign) {
  DiagnoseOptions design;
  design.resamples = design.chance_draws = 0;
  return diagnose(campaign, design);
}

int auditCampaign(const std::string& folder, const std::string& json_file) {
  useLargeHeapPages();
  Campaign campaign = openCampaign(folder, hashesFor(json_file));
  const Campaign words = described(campaign);
  // The audit takes the only copy of the readings; what the design is asked about is a hundred postures.
  std::optional<Campaign> asked;
  if (whatLoadsLack(campaign).empty()) asked = evenlySpread(campaign, kMostDiagnosed);
  AuditReport report = audit(std::move(campaign));
  // With a unit wrong nothing could be told apart, and the search would not settle for a minute.
  if (asked && !findsTheImpossible(report)) addSeparableEffects(designOf(*asked), report);
  deliver([&] { return auditJson(words, report); }, [&] { return auditText(words, report); }, json_file);
  return report.verdict == AuditVerdict::fail ? kNotUsable : kDone;
}

}  // namespace

void addAudit(CLI::App& app, Run& run) {
  struct Arguments {
    std::string campaign, json;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("audit", "Is this data fit to identify from?");
  command->add_option("CAMPAIGN", arguments->campaign, "campaign folder or its campaign.xml")->required();
  command->add_option("--json", arguments->json, "write the result to this file, - for standard output");
  command->callback([arguments, &run] {
    run = [arguments] { return auditCampaign(arguments->campaign, arguments->json); };
  });
}

}  // namespace stiffscope
