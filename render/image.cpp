#include "render/image.h"

#include <png.h>

#include <fmt/format.h>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace stiffscope::render {

namespace {

void append(png_structp png, png_bytep data, png_size_t length) {
  auto* bytes = static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(png));
  bytes->insert(bytes->end(), data, data + length);
}

// libpng must not return from its error handler; an exception unwinds through it as well as its longjmp
// would.
void fail(png_structp, png_const_charp message) {
  throw std::runtime_error(fmt::format("cannot encode PNG: {}", message));
}

struct Writer {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, nullptr);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  ~Writer() { png_destroy_write_struct(&png, &info); }
};

/// A picture of few colours: an index a pixel.
struct Palettised {
  std::vector<png_color> palette;  ///< empty: it has more than 256
  std::vector<std::uint8_t> indices;
};

Palettised palettisedOf(const Image& image) {
  constexpr std::size_t kSlots = 1024, kMost = 256;  // a table that is a quarter full at most
  std::array<std::uint32_t, kSlots> keys{};          // colour + 1; 0: free
  std::array<std::uint8_t, kSlots> values{};
  Palettised result;
  result.indices.resize(image.rgb.size() / 3);
  std::uint32_t last = 0;  // most pixels are as the one before
  std::uint8_t index = 0;
  for (std::size_t i = 0; i < result.indices.size(); ++i) {
    const std::uint8_t* at = &image.rgb[3 * i];
    const std::uint32_t key = 1u + (std::uint32_t{at[0]} << 16 | std::uint32_t{at[1]} << 8 | at[2]);
    if (key != last) {
      std::size_t slot = (key * 2654435761u) >> 22;
      while (keys[slot] != 0 && keys[slot] != key) slot = (slot + 1) % kSlots;
      if (keys[slot] == 0) {
        if (result.palette.size() == kMost) return {};
        keys[slot] = key;
        values[slot] = static_cast<std::uint8_t>(result.palette.size());
        result.palette.push_back({at[0], at[1], at[2]});
      }
      index = values[slot];
      last = key;
    }
    result.indices[i] = index;
  }
  return result;
}

}  // namespace

std::vector<std::uint8_t> encodePng(const Image& image) {
  const auto width = static_cast<std::size_t>(image.width);
  const auto height = static_cast<std::size_t>(image.height);
  if (image.width <= 0 || image.height <= 0 || image.rgb.size() != 3 * width * height) {
    throw std::invalid_argument(fmt::format("image of {} x {} pixels has {} bytes, expected 3 a pixel", image.width,
                                            image.height, image.rgb.size()));
  }
  const Palettised palettised = palettisedOf(image);
  const bool few = !palettised.palette.empty();
  Writer writer;
  if (writer.info == nullptr) throw std::runtime_error("cannot encode PNG: libpng did not start");

  std::vector<std::uint8_t> bytes;
  bytes.reserve(image.rgb.size() / 16);
  png_set_write_fn(writer.png, &bytes, append, nullptr);
  png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
               few ? PNG_COLOR_TYPE_PALETTE : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  // Flat colours compress best unfiltered, and soonest.
  png_set_filter(writer.png, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
  png_set_compression_level(writer.png, 6);
  if (few) png_set_PLTE(writer.png, writer.info, palettised.palette.data(), static_cast<int>(palettised.palette.size()));
  png_write_info(writer.png, writer.info);
  for (std::size_t y = 0; y < height; ++y)
    png_write_row(writer.png, few ? &palettised.indices[width * y] : &image.rgb[3 * width * y]);
  png_write_end(writer.png, nullptr);
  return bytes;
}

}  // namespace stiffscope::render
