#include "reports/page/html.h"

#include <tinyxml2.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>

#include "core/input/one_line.h"

namespace stiffscope::page {

namespace {

std::string clean(const std::string& text) { return oneLine(text, std::numeric_limits<std::size_t>::max()); }

constexpr char kAsIs = '\x1b';  // a campaign's own texts have no control characters left once they stand in a rich text

/// Where a stretch of another kind begins in `text`, and how it is marked.
struct Mark {
  const char* open;
  const char* close;
};
constexpr std::array<Mark, 3> kMarks{{{"_{", "}"}, {"`", "`"}, {"\x1b", "\x1b"}}};
enum Stretch { kSubscript = 0, kCode = 1, kVerbatim = 2, kNormal = 3 };

/// Calls `write` with the stretches of a rich text and their kind, in order. A mark without its end is text.
template <class Write>
void eachStretch(std::string_view text, const Write& write) {
  std::size_t from = 0;  // marks before it are text
  while (!text.empty()) {
    std::size_t open = std::string_view::npos, kind = kNormal;
    for (std::size_t i = 0; i < kMarks.size(); ++i) {
      const std::size_t at = text.find(kMarks[i].open, from);
      if (at < open) open = at, kind = i;
    }
    if (kind == kNormal) break;
    const std::size_t begin = open + std::string_view(kMarks[kind].open).size();
    const std::size_t close = text.find(kMarks[kind].close, begin);
    if (close == std::string_view::npos) {
      from = begin;
      continue;
    }
    if (open > 0) write(std::string(text.substr(0, open)), kNormal);
    write(std::string(text.substr(begin, close - begin)), static_cast<Stretch>(kind));
    text.remove_prefix(close + 1);
    from = 0;
  }
  if (!text.empty()) write(std::string(text), kNormal);
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
  eachStretch(text, [this](const std::string& part, Stretch kind) {
    const bool marked = kind == kSubscript || kind == kCode;
    if (marked) open(kind == kSubscript ? "sub" : "code", {});
    this->text(part);
    if (marked) printer_->CloseElement(true);
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
  eachStretch(rich_text, [&text](const std::string& part, Stretch) { text += part; });
  return text;
}

std::string asIs(const std::string& text) {
  std::string inside = text;
  std::erase(inside, kAsIs);
  const bool marks = inside.find("_{") != std::string::npos || inside.find('`') != std::string::npos || inside.ends_with('_');
  return marks ? kAsIs + inside + kAsIs : inside;
}

void Html::keepTable(const std::string& id, std::string csv) {
  const std::string name = id.empty() ? "table-" + std::to_string(tables_.size() + 1) : id + table_suffix_;
  tables_.push_back({name, std::move(csv)});
}

}  // namespace stiffscope::page
