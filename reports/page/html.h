#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "reports/csv/csv_table.h"
#include "reports/words/rich_text.h"
#include "reports/words/table.h"

namespace tinyxml2 {
class XMLPrinter;
}

namespace stiffscope::page {

/// Base64 (RFC 4648, section 4) with padding, no line breaks.
std::string base64(const std::vector<std::uint8_t>& bytes);

struct Attribute {
  const char* name;
  std::string value;
};

using Attributes = std::vector<Attribute>;

/// Writes HTML5 that is well-formed XML too. Text and attributes are escaped; control characters and bytes
/// that are not UTF-8 become '?'. Elements other than void ones get an end tag even when empty, because HTML
/// reads <div/> as <div>.
class Html {
 public:
  /// Closes its element when it goes out of scope.
  class Element {
   public:
    explicit Element(Html& html) : html_(html) {}
    ~Element();
    Element(const Element&) = delete;
    Element& operator=(const Element&) = delete;

   private:
    Html& html_;
  };

  Html();
  ~Html();
  Html(const Html&) = delete;
  Html& operator=(const Html&) = delete;

  [[nodiscard]] Element element(const char* name, const Attributes& attributes = {});
  void voidElement(const char* name, const Attributes& attributes = {});  ///< meta, img
  void text(const std::string& text);
  /// `x_{abc}` sets abc as a subscript, a word between backticks is set as code; what asIs made stays. `@{Audit}`
  /// becomes a link to the section of that name with its number; where the page has none, the name alone.
  void rich(const std::string& text);
  void leaf(const char* name, const std::string& rich_text, const Attributes& attributes = {});
  void paragraph(const std::string& rich_text, const char* css_class = "");
  void list(const std::vector<std::string>& rich_items);  ///< nothing where there is none
  /// A <script> with this text to the letter, that is code or data to HTML and to XML alike. Throws
  /// std::invalid_argument where it holds "</script" or "]]>".
  void script(std::string_view code, const Attributes& attributes = {});

  /// A <style> with this text to the letter. Throws std::invalid_argument where it holds "</style" or "]]>".
  void style(std::string_view rules);

  std::string bytes() const;

  /// The sections of the page in their order, before anything that refers to them.
  struct Section {
    std::string id, name;
  };
  void setSections(std::vector<Section> sections) { sections_ = std::move(sections); }

  /// What tables written from now on are of, for the names of their files: "-2" for the second campaign.
  void setTableSuffix(const std::string& suffix) { table_suffix_ = suffix; }
  /// Keeps a table that is on the page as a file; `id` is letters, digits and hyphens, empty: by its number.
  void keepTable(const std::string& id, std::string csv);
  const std::vector<reports::TableFile>& tables() const { return tables_; }

 private:
  void open(const char* name, const Attributes& attributes);
  void refer(const std::string& section);
  std::unique_ptr<tinyxml2::XMLPrinter> printer_;
  std::vector<Section> sections_;
  std::string table_suffix_;
  std::vector<reports::TableFile> tables_;
};

/// Writes it with <caption> and a scope on every header. Empty tables (no rows) are not written.
/// Throws std::invalid_argument where a row's width is not that of the columns.
void writeTable(Html& html, const reports::Table& table);

/// Remarks that cells refer to by a letter; the same text gets the same letter.
class Notes {
 public:
  std::string mark(const std::string& text);  ///< the letter of `text`
  void write(Html& html) const;               ///< the list of them

 private:
  std::vector<std::string> texts_;
};

}  // namespace stiffscope::page
