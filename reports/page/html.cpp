#include "reports/page/html.h"

#include <tinyxml2.h>

#include <limits>
#include <string_view>

#include "core/input/one_line.h"

namespace stiffscope::page {

namespace {

std::string clean(const std::string& text) { return oneLine(text, std::numeric_limits<std::size_t>::max()); }

/// Calls `normal` and `subscript` with the stretches of a rich text, in order.
template <class Normal, class Subscript>
void eachStretch(std::string_view text, const Normal& normal, const Subscript& subscript) {
  while (!text.empty()) {
    const std::size_t open = text.find("_{");
    const std::size_t close = open == std::string_view::npos ? open : text.find('}', open);
    if (close == std::string_view::npos) {
      normal(std::string(text));
      return;
    }
    if (open > 0) normal(std::string(text.substr(0, open)));
    subscript(std::string(text.substr(open + 2, close - open - 2)));
    text.remove_prefix(close + 1);
  }
}

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
  eachStretch(
      text, [this](const std::string& normal) { this->text(normal); },
      [this](const std::string& subscript) {
        open("sub", {});
        this->text(subscript);
        printer_->CloseElement(true);
      });
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

std::string plain(const std::string& rich_text) {
  std::string text;
  const auto append = [&text](const std::string& part) { text += part; };
  eachStretch(rich_text, append, append);
  return text;
}

}  // namespace stiffscope::page
