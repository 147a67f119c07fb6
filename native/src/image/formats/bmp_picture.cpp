// Reads BMP files: OpenImageIO (2.4) ignores the masks of colors, and stb_image refuses rows from the top and misreads
// the palettes of OS/2.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>

#include "base/byte_reader.h"
#include "base/error.h"
#include "base/file.h"
#include "image/open_picture.h"

namespace velour {
namespace {

constexpr uint32_t kNoCompression = 0, kBitFields = 3, kAlphaBitFields = 6;
/// Sizes of headers: of OS/2 1 and Windows 3, and the first ones with masks of colors and of alpha.
constexpr uint32_t kShortHeader = 12, kInfoHeader = 40, kMaskHeader = 52, kAlphaHeader = 56;
constexpr uint64_t kFileHeader = 14, kPlaceOfOffset = 10;

/// The bits of a pixel that hold a channel, as a fraction of the largest value; 0 without bits.
float share_of(uint32_t pixel, uint32_t mask) {
  if (mask == 0) return 0;
  const int shift = std::countr_zero(mask);
  return static_cast<float>((pixel & mask) >> shift) / static_cast<float>(mask >> shift);
}

class BmpPicture : public OpenPicture {
 public:
  explicit BmpPicture(const std::string& path) : path_(path), bytes_(read_file(path)) {
    ByteReader in(bytes_, path);
    in.seek(kPlaceOfOffset, "header");
    offset_ = in.number<uint32_t>("offset of the pixels");
    read_header(in);
    check_pixels();
    header_.integers = true;
    header_.channels = masks_[3] != 0 ? 4 : 3;
    if (masks_[3] != 0) header_.alpha_channel = 3;
  }

  const PictureHeader& header() const override { return header_; }
  std::optional<std::string> text(const std::string&) const override { return std::nullopt; }

  void read(std::span<float> values) override {
    const auto width = static_cast<size_t>(header_.width), height = static_cast<size_t>(header_.height);
    const auto channels = static_cast<size_t>(header_.channels);
    for (size_t y = 0; y < height; ++y) {
      const uint8_t* row = bytes_.data() + offset_ + row_bytes() * (top_first_ ? y : height - 1 - y);
      for (size_t x = 0; x < width; ++x) {
        const uint32_t pixel = is_palette() ? palette_[code_at(row, x)] : pixel_at(row, x);
        for (size_t c = 0; c < channels; ++c)
          *(values.data() + (y * width + x) * channels + c) = share_of(pixel, masks_[c]);
      }
    }
  }

 private:
  bool is_palette() const { return bits_ <= 8; }
  uint64_t row_bytes() const { return (static_cast<uint64_t>(header_.width) * bits_ + 31) / 32 * 4; }

  void read_header(ByteReader& in) {
    const auto size = in.number<uint32_t>("size of the header");
    const bool is_short = size == kShortHeader;
    if (!is_short && (size < kInfoHeader || size > 124)) refuse("a header of " + std::to_string(size) + " bytes");
    int64_t width, height;
    if (is_short) {
      width = in.number<uint16_t>("width");
      height = in.number<uint16_t>("height");
    } else {
      width = in.number<int32_t>("width");
      height = in.number<int32_t>("height");
    }
    in.take(2, "number of planes");
    bits_ = in.number<uint16_t>("bits per pixel");
    const auto compression = is_short ? kNoCompression : in.number<uint32_t>("compression");
    top_first_ = height < 0;
    header_.width = static_cast<int>(width);
    header_.height = static_cast<int>(std::min<int64_t>(std::abs(height), INT32_MAX));
    check_kind(compression);
    uint32_t colors = 0;
    if (!is_short) {
      in.take(12, "size and resolution");
      colors = in.number<uint32_t>("number of colors");
      in.take(4, "number of important colors");
    }
    if (compression != kNoCompression || size >= kMaskHeader) read_masks(in, size, compression);
    in.seek(std::max(in.position(), kFileHeader + size), "end of the header");
    if (is_palette()) read_palette(in, is_short ? 3 : 4, colors);
  }

  void check_kind(uint32_t compression) const {
    constexpr uint32_t kDepths[] = {1, 2, 4, 8, 16, 24, 32};
    if (header_.width <= 0 || header_.height <= 0) {
      throw Error(Status::bad_data, path_ + ": claims " + std::to_string(header_.width) + " x " +
                                        std::to_string(header_.height) + " pixels; the file is damaged.");
    }
    if (std::ranges::count(kDepths, bits_) == 0) refuse(std::to_string(bits_) + " bits per pixel");
    const bool are_masks = compression == kBitFields || compression == kAlphaBitFields;
    if (compression != kNoCompression && !(are_masks && (bits_ == 16 || bits_ == 32))) {
      refuse("compression " + std::to_string(compression));
    }
  }

  [[noreturn]] void refuse(const std::string& what) const {
    throw Error(Status::unsupported, path_ + ": BMP files with " + what + " are not supported. Save the image as PNG.");
  }

  void read_masks(ByteReader& in, uint32_t size, uint32_t compression) {
    if (is_palette() || bits_ == 24 || compression == kNoCompression) return;
    const bool with_alpha = size >= kAlphaHeader || compression == kAlphaBitFields;
    for (size_t c = 0; c < (with_alpha ? 4 : 3); ++c) masks_[c] = in.number<uint32_t>("mask of a color");
  }

  void read_palette(ByteReader& in, uint64_t entry_bytes, uint32_t colors) {
    const uint32_t all = 1u << bits_;
    if (colors == 0 || colors > all) colors = all;
    palette_.assign(all, 0);
    for (uint32_t i = 0; i < colors && in.remaining() >= entry_bytes && in.position() + entry_bytes <= offset_; ++i) {
      const auto entry = in.take(entry_bytes, "palette");
      palette_[i] = entry[0] | uint32_t{entry[1]} << 8 | uint32_t{entry[2]} << 16;
    }
  }

  /// The last row may lack its padding.
  void check_pixels() {
    if (bits_ == 16 && masks_ == std::array<uint32_t, 4>{0xff0000, 0xff00, 0xff, 0}) masks_ = {0x7c00, 0x3e0, 0x1f, 0};
    const uint64_t last = (static_cast<uint64_t>(header_.width) * bits_ + 7) / 8;
    const uint64_t needed = row_bytes() * (static_cast<uint64_t>(header_.height) - 1) + last;
    if (offset_ > bytes_.size() || needed > bytes_.size() - offset_) {
      throw Error(Status::bad_data, path_ + ": " + std::to_string(header_.width) + " x " +
                                        std::to_string(header_.height) + " pixels take " + std::to_string(needed) +
                                        " bytes from byte " + std::to_string(offset_) + " on, but the file ends at " +
                                        std::to_string(bytes_.size()) + "; it is truncated or damaged.");
    }
  }

  uint32_t code_at(const uint8_t* row, size_t x) const {
    const size_t first = x * bits_;
    return row[first / 8] >> (8 - bits_ - first % 8) & ((1u << bits_) - 1);
  }

  uint32_t pixel_at(const uint8_t* row, size_t x) const {
    uint32_t pixel = 0;
    for (size_t i = 0; i < bits_ / 8; ++i) pixel |= uint32_t{row[x * bits_ / 8 + i]} << (8 * i);
    return pixel;
  }

  std::string path_;
  std::vector<uint8_t> bytes_;
  PictureHeader header_;
  uint64_t offset_ = 0;
  uint32_t bits_ = 0;
  bool top_first_ = false;
  std::array<uint32_t, 4> masks_{0xff0000, 0xff00, 0xff, 0};  // of red, green, blue and alpha
  std::vector<uint32_t> palette_;
};

}  // namespace

std::unique_ptr<OpenPicture> open_bmp(const std::string& path) { return std::make_unique<BmpPicture>(path); }

}  // namespace velour
