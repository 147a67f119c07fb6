// Reads and encodes PNG files in a library without OpenImageIO.
#include <zlib.h>

#include <algorithm>
#include <climits>
#include <cstring>
#include <string_view>

#include "base/error.h"
#include "base/file.h"
#include "image/portable/portable_picture.h"

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_NO_STDIO
#define STBI_ONLY_PNG
#include <stb/stb_image.h>
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

namespace velour {
namespace {

/// stb_image reads zeros beyond the end of a file, so a read or skip beyond it means that the file ends early.
struct Source {
  std::span<const uint8_t> bytes;
  size_t position = 0;
  bool ended_early = false;

  static int read(void* user, char* to, int size) {
    auto& self = *static_cast<Source*>(user);
    const size_t rest = self.bytes.size() - self.position;
    if (rest == 0) self.ended_early = true;
    const size_t count = std::min(rest, static_cast<size_t>(size));
    if (count > 0) std::memcpy(to, self.bytes.data() + self.position, count);
    self.position += count;
    return static_cast<int>(count);
  }
  static void skip(void* user, int size) {
    auto& self = *static_cast<Source*>(user);
    const size_t rest = self.bytes.size() - self.position;
    const size_t count = size > 0 ? static_cast<size_t>(size) : 0;
    self.ended_early |= size < 0 || count > rest;
    self.position += std::min(rest, count);
  }
  static int at_end(void* user) {
    const auto& self = *static_cast<Source*>(user);
    return self.position == self.bytes.size();
  }
  static constexpr stbi_io_callbacks kCallbacks{read, skip, at_end};
};

template <typename T>
struct Free {
  void operator()(T* values) const { stbi_image_free(values); }
};
template <typename T>
using Values = std::unique_ptr<T, Free<T>>;

uint32_t big_endian(std::span<const uint8_t> bytes) {
  return uint32_t{bytes[0]} << 24 | uint32_t{bytes[1]} << 16 | uint32_t{bytes[2]} << 8 | uint32_t{bytes[3]};
}

/// Calls `use` with the type and the bytes (type, data) of each chunk of a PNG file, until it returns false.
template <class Use>
void for_each_chunk(std::span<const uint8_t> png, const Use& use) {
  constexpr size_t kSignature = 8, kBesideData = 12;  // length, type and checksum
  for (uint64_t at = kSignature; at + kBesideData <= png.size();) {
    const uint64_t length = big_endian(png.subspan(at));
    if (length > png.size() - at - kBesideData) return;
    const std::string_view type(reinterpret_cast<const char*>(&png[at + 4]), 4);
    if (!use(type, png.subspan(at + 4, length + 8))) return;
    at += kBesideData + length;
  }
}

/// Whether a PNG file has a transparent color (tRNS), which stb_image does not report before it decodes.
bool has_clear_color(std::span<const uint8_t> png) {
  bool found = false;
  for_each_chunk(png, [&](std::string_view type, std::span<const uint8_t>) {
    found = type == "tRNS";
    return !found && type != "IDAT";
  });
  return found;
}

/// Throws Error(bad_data) for a wrong checksum of a chunk that pixels need, which stb_image does not compare.
void check_checksums(const std::string& path, std::span<const uint8_t> png) {
  for_each_chunk(png, [&](std::string_view type, std::span<const uint8_t> chunk) {
    const auto bytes = chunk.first(chunk.size() - 4);
    const bool is_critical = (type[0] & 0x20) == 0;
    if (is_critical && crc32_z(0, bytes.data(), bytes.size()) != big_endian(chunk.last(4))) {
      throw Error(Status::bad_data, input_error(path, std::string(type) + ": CRC error"));
    }
    return true;
  });
}

/// `png` with a palette of 256 colors: stb_image does not initialize those that a file leaves out, which are black, as
/// in libpng. The checksum of the palette is not valid afterwards.
std::vector<uint8_t> with_full_palette(std::span<const uint8_t> png) {
  constexpr size_t kPaletteBytes = 3 * 256;
  std::vector<uint8_t> bytes(png.begin(), png.end());
  for_each_chunk(png, [&](std::string_view type, std::span<const uint8_t> chunk) {
    const size_t length = chunk.size() - 8;
    if (type != "PLTE") return true;
    if (length >= kPaletteBytes || length % 3 != 0) return false;
    const auto colors = chunk.data() + 4 - png.data();
    bytes[static_cast<size_t>(colors) - 6] = kPaletteBytes >> 8;  // the length, of four bytes
    bytes[static_cast<size_t>(colors) - 5] = kPaletteBytes & 0xff;
    bytes.insert(bytes.begin() + colors + static_cast<std::ptrdiff_t>(length), kPaletteBytes - length, uint8_t{0});
    return false;
  });
  return bytes;
}

class ByStb : public OpenPicture {
 public:
  explicit ByStb(const std::string& path) : path_(path), bytes_(read_file(path)) {
    const auto* data = bytes_.data();
    const int size = static_cast<int>(std::min<size_t>(bytes_.size(), INT32_MAX));
    if (stbi_info_from_memory(data, size, &header_.width, &header_.height, &header_.channels) == 0)
      throw Error(Status::bad_data, input_error(path, stbi_failure_reason()));
    header_.integers = true;
    if (header_.channels % 2 == 1 && has_clear_color(bytes_)) ++header_.channels;
    sixteen_bits_ = stbi_is_16_bit_from_memory(data, size) != 0;
    if (header_.channels % 2 == 0) header_.alpha_channel = header_.channels - 1;
  }

  const PictureHeader& header() const override { return header_; }
  std::optional<std::string> text(const std::string&) const override { return std::nullopt; }

  void read(std::span<float> values) override {
    check_checksums(path_, bytes_);
    if (sixteen_bits_) return copy(load<stbi_us>(stbi_load_16_from_callbacks), 65535.0f, values);
    copy(load<stbi_uc>(stbi_load_from_callbacks), 255.0f, values);
  }

 private:
  template <typename T, typename Load>
  Values<T> load(Load* function) const {
    const std::vector<uint8_t> png = with_full_palette(bytes_);
    Source source{png};
    int width = 0, height = 0, channels = 0;
    Values<T> values(function(&Source::kCallbacks, &source, &width, &height, &channels, header_.channels));
    if (!values) throw Error(Status::bad_data, input_error(path_, stbi_failure_reason()));
    if (source.ended_early || width != header_.width || height != header_.height)
      throw Error(Status::bad_data, input_error(path_, "the file is truncated."));
    return values;
  }

  template <typename T>
  static void copy(const Values<T>& from, float largest, std::span<float> to) {
    for (size_t i = 0; i < to.size(); ++i) to[i] = static_cast<float>(from.get()[i]) / largest;
  }

  std::string path_;
  std::vector<uint8_t> bytes_;
  PictureHeader header_;
  bool sixteen_bits_ = false;
};

void append(void* to, void* data, int size) {
  auto& bytes = *static_cast<std::vector<uint8_t>*>(to);
  const auto* from = static_cast<const uint8_t*>(data);
  bytes.insert(bytes.end(), from, from + size);
}

}  // namespace

std::unique_ptr<OpenPicture> open_by_stb(const std::string& path) { return std::make_unique<ByStb>(path); }

std::vector<uint8_t> png_of(const std::string& path, int width, int height, int channels,
                            std::span<const uint8_t> values) {
  std::vector<uint8_t> bytes;
  // The encoder counts the bytes of an image in an int.
  if ((uint64_t{static_cast<uint32_t>(width)} * static_cast<uint32_t>(channels) + 1) * static_cast<uint32_t>(height) >
      static_cast<uint64_t>(INT_MAX))
    throw Error(Status::unsupported, path + ": a PNG file of 2 GiB of pixels or more cannot be written. Use OpenEXR.");
  if (channels > 4 ||
      stbi_write_png_to_func(append, &bytes, width, height, channels, values.data(), width * channels) == 0)
    throw Error(Status::unsupported, path + ": a PNG file must have 1 to 4 channels.");
  return bytes;
}

}  // namespace velour
