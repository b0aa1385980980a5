#include "core/input/csv_lines.h"

// The reader's own thread would only read ahead in memory.
#define CSV_IO_NO_THREAD
// It cuts file names at 255 bytes on purpose, which the compiler takes for a slip.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wstringop-truncation"
#include <libfccp/csv.h>
#pragma GCC diagnostic pop

#include <cstring>
#include <limits>

#include "core/input/input_error.h"

namespace stiffscope {

struct CsvLines::Reader {
  io::LineReader lines;
};

CsvLines::CsvLines(std::string file, std::string_view bytes)
    : file_(std::move(file)),
      reader_(new Reader{io::LineReader(file_, bytes.data(), bytes.data() + bytes.size())}) {}

CsvLines::~CsvLines() = default;

std::size_t CsvLines::line() const { return reader_->lines.get_file_line(); }

bool CsvLines::next(std::vector<std::string_view>& cells) {
  using Quotes = io::double_quote_escape<',', '"'>;
  cells.clear();
  try {
    char* rest = nullptr;
    do {
      rest = reader_->lines.next_line();
      if (rest == nullptr) return false;
    } while (io::empty_line_comment::is_comment(rest));
    while (rest != nullptr) {
      char* begin = nullptr;
      char* end = nullptr;
      io::detail::chop_next_column<Quotes>(rest, begin, end);
      io::trim_chars<' ', '\t'>::trim(begin, end);
      Quotes::unescape(begin, end);
      cells.emplace_back(begin, static_cast<std::size_t>(end - begin));
    }
    return true;
  } catch (const io::error::escaped_string_not_closed&) {
    throw InputError({file_, line(), ""}, "\"", "expected a closing quote on the same line");
  } catch (const io::error::line_length_limit_exceeded&) {
    throw InputError({file_, line(), ""}, "", "expected lines shorter than 16 MB");
  }
}

}  // namespace stiffscope
