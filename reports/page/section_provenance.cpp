#include "reports/page/html_table.h"
#include "reports/page/sections.h"

namespace stiffscope::page {

namespace {

Table namedTable(const char* id, const char* caption, const char* name, const char* value,
                 const std::vector<NamedText>& lines) {
  Table table{caption, {name, value}, {{}}, true, id};
  for (const NamedText& line : lines) table.groups.front().rows.push_back({line.name, line.text});
  return table;
}

}  // namespace

void writeProvenance(Html& html, const ReportContent& content) {
  writeForEach(html, content, "provenance", "Inputs", [&](const ReportCampaign& one) {
    if (one.campaign.inputs.empty()) html.paragraph("No file was read: the campaign comes from memory.");
    Table table{"Files read", {"File", "SHA-256 of its bytes"}, {{}}, true, "inputs"};
    for (const InputFile& file : one.campaign.inputs)
      table.groups.front().rows.push_back({asIs(file.name), "`" + file.sha256 + "`"});
    writeTable(html, table);
  });
  if (content.versions.empty() && content.settings.empty() && content.command_line.empty()) return;
  const auto section = html.element("section", {{"id", "versions"}});
  html.leaf("h2", "How this page was made");
  if (!content.command_line.empty()) {
    const auto line = html.element("p");
    html.text("Command: ");
    // Not rich: a command is shown to the letter.
    const auto code = html.element("code");
    html.text(content.command_line);
  }
  writeTable(html, namedTable("versions", "Versions", "Program or library", "Version", content.versions));
  writeTable(html, namedTable("settings", "Settings", "Setting", "Value", content.settings));
}

}  // namespace stiffscope::page
