#include "reports/page/html.h"

#include <fmt/format.h>
#include <tinyxml2.h>
#include <algorithm>
#include <limits>
#include <stdexcept>

#include "core/io/input_error.h"
#include "reports/csv/csv_table.h"

namespace stiffscope::page {

std::string base64(const std::vector<std::uint8_t>& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t triple = 0;
    for (std::size_t k = 0; k < 3; ++k) triple = triple << 8 | (k < count ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kDigits[triple >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

namespace {

void writeCell(Html& html, const char* name, const reports::Cell& cell, const Attributes& attributes = {}) {
  const auto element = html.element(name, attributes);
  html.rich(cell.text);
  if (!cell.remark.empty()) {
    html.text(" ");
    html.leaf("small", cell.remark);
  }
}

void writeGroup(Html& html, const reports::RowGroup& group, std::size_t columns) {
  const auto body = html.element("tbody");
  bool first = true;
  for (const reports::Row& row : group.rows) {
    if (row.size() + (group.header.empty() ? 0 : 1) != columns) {
      throw std::invalid_argument(fmt::format("a table row of {} cells under {} columns", row.size(), columns));
    }
    const auto line = html.element("tr");
    if (first && !group.header.empty()) {
      html.leaf("th", group.header, {{"scope", "rowgroup"}, {"rowspan", std::to_string(group.rows.size())}});
    }
    first = false;
    writeCell(html, "th", row.front(), {{"scope", "row"}});
    for (std::size_t i = 1; i < row.size(); ++i) writeCell(html, "td", row[i]);
  }
}

}  // namespace

void writeTable(Html& html, const reports::Table& table) {
  const bool empty = std::all_of(table.groups.begin(), table.groups.end(),
                                 [](const reports::RowGroup& group) { return group.rows.empty(); });
  if (empty) return;
  const std::string name = reports::plain(table.caption);
  // A wide table is scrolled by keyboard too.
  const auto scroll =
      html.element("div", {{"class", "scroll"}, {"role", "region"}, {"aria-label", name}, {"tabindex", "0"}});
  const bool grouped = std::any_of(table.groups.begin(), table.groups.end(),
                                   [](const reports::RowGroup& group) { return !group.header.empty(); });
  std::size_t rows = 0;
  for (const reports::RowGroup& group : table.groups) rows += group.rows.size();
  // A quarter of a printed page with its heading and its notes; a longer table is broken between rows, its head
  // repeated: kept together it would leave up to a third of a page empty.
  constexpr std::size_t kMostOnAPage = 11;
  std::string kind = table.words ? "words" : grouped ? "grouped" : "numeric";
  if (rows > kMostOnAPage || table.words) kind += " long";     // rows of words are high
  if (!grouped && !table.words && rows > 2) kind += " sorts";  // a group's header spans its rows in their order
  if (!table.on_page_alone) html.keepTable(table.id, reports::csvTable(table));
  const auto element = html.element("table", {{"class", kind}});
  html.leaf("caption", table.caption);
  {
    const auto head = html.element("thead");
    const auto line = html.element("tr");
    for (const std::string& column : table.columns) html.leaf("th", column, {{"scope", "col"}});
  }
  for (const reports::RowGroup& group : table.groups) {
    if (!group.rows.empty()) writeGroup(html, group, table.columns.size());
  }
}

std::string Notes::mark(const std::string& text) {
  const auto found = std::find(texts_.begin(), texts_.end(), text);
  const auto at = found - texts_.begin();
  if (found == texts_.end()) texts_.push_back(text);
  return std::string(1, static_cast<char>('a' + at % 26));
}

void Notes::write(Html& html) const {
  if (texts_.empty()) return;
  const auto list = html.element("ol", {{"class", "notes"}, {"type", "a"}});
  for (const std::string& text : texts_) html.leaf("li", text);
}

namespace {

std::string clean(const std::string& text) { return io::oneLine(text, std::numeric_limits<std::size_t>::max()); }

}  // namespace

// Compact: indentation would put blanks between inline elements. Lines end after block elements instead.
Html::Html() : printer_(std::make_unique<tinyxml2::XMLPrinter>(nullptr, true)) {
  printer_->PushUnknown("DOCTYPE html");
}

Html::~Html() = default;

Html::Element::~Element() {
  html_.printer_->PushText("");  // seals the start tag, so that an empty element gets an end tag
  html_.printer_->CloseElement(true);
  html_.printer_->PushText("\n");
}

void Html::open(const char* name, const Attributes& attributes) {
  printer_->OpenElement(name, true);
  for (const Attribute& one : attributes) printer_->PushAttribute(one.name, clean(one.value).c_str());
}

Html::Element Html::element(const char* name, const Attributes& attributes) {
  open(name, attributes);
  return Element(*this);
}

void Html::voidElement(const char* name, const Attributes& attributes) {
  open(name, attributes);
  printer_->CloseElement(true);
}

void Html::text(const std::string& text) { printer_->PushText(clean(text).c_str()); }

namespace {

/// No line ends between a number and its per cent.
std::string withUnbrokenPercent(std::string text) {
  for (std::size_t at = text.find(" %"); at != std::string::npos; at = text.find(" %", at + 1)) {
    if (at > 0 && text[at - 1] >= '0' && text[at - 1] <= '9') text.replace(at, 1, "\u00a0");
  }
  return text;
}

}  // namespace

void Html::refer(const std::string& section) {
  const auto found =
      std::find_if(sections_.begin(), sections_.end(), [&](const Section& one) { return one.name == section; });
  if (found == sections_.end()) return text(section);
  open("a", {{"href", "#" + found->id}});
  // On paper the number is what a reader finds it by.
  text(fmt::format("section\u00a0{}, {}", found - sections_.begin() + 1, section));
  printer_->CloseElement(true);
}

void Html::rich(const std::string& text) {
  for (const reports::RichStretch& stretch : reports::richStretches(text)) {
    if (stretch.kind == reports::RichStretch::reference) {
      refer(stretch.text);
      continue;
    }
    const bool marked = stretch.kind == reports::RichStretch::subscript || stretch.kind == reports::RichStretch::code;
    if (marked) open(stretch.kind == reports::RichStretch::subscript ? "sub" : "code", {});
    this->text(stretch.kind == reports::RichStretch::code ? stretch.text : withUnbrokenPercent(stretch.text));
    if (marked) printer_->CloseElement(true);
  }
}

void Html::leaf(const char* name, const std::string& rich_text, const Attributes& attributes) {
  open(name, attributes);
  printer_->PushText("");
  rich(rich_text);
  printer_->CloseElement(true);
}

void Html::paragraph(const std::string& rich_text, const char* css_class) {
  leaf("p", rich_text, *css_class ? Attributes{{"class", css_class}} : Attributes{});
}

void Html::list(const std::vector<std::string>& rich_items) {
  if (rich_items.empty()) return;
  const Element list = element("ul");
  for (const std::string& item : rich_items) leaf("li", item);
}

void Html::script(std::string_view code, const Attributes& attributes) {
  if (code.find("</script") != std::string_view::npos || code.find("]]>") != std::string_view::npos)
    throw std::invalid_argument("a script that would end its element");
  const Element script = element("script", attributes);
  // Without what XML would take for markup it stands as it is; else in CDATA, whose marks are comments to a script.
  if (code.find_first_of("<>&") == std::string_view::npos) return printer_->PushText(std::string(code).c_str());
  printer_->PushText("//");
  printer_->PushText(fmt::format("\n{}\n//", code).c_str(), true);
}

void Html::style(std::string_view rules) {
  if (rules.find("</style") != std::string_view::npos || rules.find("]]>") != std::string_view::npos)
    throw std::invalid_argument("a style that would end its element");
  const Element style = element("style");
  // HTML reads no entities here, so that a child selector must stand as it is; the marks of CDATA are in comments.
  printer_->PushText("/*");
  printer_->PushText(fmt::format("*/{}/*", rules).c_str(), true);
  printer_->PushText("*/");
}

std::string Html::bytes() const { return printer_->CStr(); }

void Html::keepTable(const std::string& id, std::string csv) {
  const std::string name = id.empty() ? "table-" + std::to_string(tables_.size() + 1) : id + table_suffix_;
  tables_.push_back({name, std::move(csv)});
}

}  // namespace stiffscope::page
