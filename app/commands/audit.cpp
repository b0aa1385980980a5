#include <CLI/CLI.hpp>
#include <memory>

#include "app/command_line.h"
#include "app/computations.h"
#include "app/output.h"
#include "core/audit/audit.h"
#include "core/audit/check_design.h"
#include "core/diagnosis/diagnose.h"
#include "core/identification/load_case.h"
#include "core/preparation/prepare.h"
#include "reports/json/json.h"
#include "reports/json/json_document.h"
#include "reports/text/text.h"

namespace stiffscope::app {

namespace {

/// What could be told apart by these loads is asked, not what is there.
diagnosis::Diagnosis designOf(const preparation::PreparedCampaign& prepared) {
  diagnosis::DiagnoseOptions design;
  design.chance_draws = 0;
  design.design_only = true;
  return diagnosis::diagnose(prepared, design);
}

}  // namespace

int auditCampaign(const CampaignSource& source, const Outlet& outlet) {
  const auto opened = source.open();
  const preparation::PreparedCampaign& prepared = *opened;
  audit::AuditReport report = audit::audit(prepared);
  const bool loaded = identification::whatLoadsLack(prepared.campaign).empty();
  // With a unit wrong nothing could be told apart, and the search would not settle for a minute.
  if (loaded && !audit::findsTheImpossible(report))
    audit::addSeparableEffects(designOf(prepared), prepared.campaign.robot.rail.has_value(), report);
  outlet.deliver([&] { return reports::auditJson(prepared.campaign, report); },
                 [&] { return reports::auditText(prepared.campaign, report); });
  const bool usable =
      report.verdict == preparation::AuditVerdict::pass || report.verdict == preparation::AuditVerdict::warn;
  return usable ? kDone : kNotUsable;
}

void addAudit(CLI::App& app, Run& run) {
  struct AuditArguments {
    std::string campaign, json;
  };
  const auto arguments = std::make_shared<AuditArguments>();
  CLI::App* command = app.add_subcommand("audit", "Is this data fit to identify or calibrate from?");
  command->footer(
      "Verdict: fail where a check fails; not_testable where too few could be made to tell: a pass needs to know that\n"
      "postures and loads identify joints, that force and displacement are those of an arm, what a reading under load "
      "is\n"
      "worth, and that the load cell shows the load; of a day without a load that the readings are of the URDF's arm "
      "and\n"
      "what one is worth; else warn or pass. Status 0 for pass and warn, else 1.");
  command->add_option("CAMPAIGN", arguments->campaign, "campaign folder or its campaign.xml")->required();
  command->add_option("--json", arguments->json, "write the result to this file, - for standard output");
  command->callback([arguments, &run] {
    run = [arguments] {
      return auditCampaign(sourceOf(arguments->campaign, false, hashesFor(arguments->json)),
                           commandLineOutlet(arguments->json));
    };
  });
}

}  // namespace stiffscope::app
