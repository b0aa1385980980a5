#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace stiffscope::interchange {

/// How a file's bytes stand for characters. Programs of trackers and robots run on Windows: what is not UTF-8 there is
/// UTF-16 or the Western code page, or the Japanese one.
enum class Encoding { utf8, utf16_le, utf16_be, cp1252, cp932 };

/// utf-8, utf-16le, utf-16be, cp1252, cp932.
const std::vector<std::string>& encodingNames();
std::string nameOf(Encoding encoding);

/// The encoding of that name. Throws InputError, naming `option`, for another.
Encoding encodingNamed(const std::string& name, const std::string& option);

struct DecodedText {
  Encoding encoding = Encoding::utf8;
  std::string_view own;   ///< of a file in UTF-8: its bytes, which have to live as long
  std::string converted;  ///< of another

  /// UTF-8, without a byte-order mark.
  std::string_view text() const { return encoding == Encoding::utf8 ? own : std::string_view(converted); }
};

/// Bytes as UTF-8. Without `wanted` the encoding is what the file shows: a byte-order mark; zeros in every second byte;
/// UTF-8 where all of it is; else CP1252, or CP932 where a byte is none of CP1252 and all are CP932. Throws InputError,
/// with the line, where bytes are none of an encoding, where some characters are UTF-8 and others are not (two files
/// put together), and where the file shows another encoding than the one wanted. `file` is its name for messages.
DecodedText decodeText(const std::string& file, std::string_view bytes, std::optional<Encoding> wanted = std::nullopt);

}  // namespace stiffscope::interchange
