#include "reports/page/html.h"

#include <tinyxml2.h>

#include <algorithm>
#include <limits>

#include "core/input/one_line.h"

namespace stiffscope::page {

namespace {

std::string clean(const std::string& text) { return oneLine(text, std::numeric_limits<std::size_t>::max()); }

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

void Html::rich(const std::string& text) {
  for (const RichStretch& stretch : richStretches(text)) {
    const bool marked = stretch.kind == RichStretch::subscript || stretch.kind == RichStretch::code;
    if (marked) open(stretch.kind == RichStretch::subscript ? "sub" : "code", {});
    this->text(stretch.text);
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

std::string Html::bytes() const { return printer_->CStr(); }

void Html::keepTable(const std::string& id, std::string csv) {
  const std::string name = id.empty() ? "table-" + std::to_string(tables_.size() + 1) : id + table_suffix_;
  tables_.push_back({name, std::move(csv)});
}

}  // namespace stiffscope::page
