#include "image/open_picture.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/file.h"

namespace velour {

namespace {

using namespace std::string_view_literals;

constexpr std::pair<std::string_view, PictureFormat> kFormats[] = {
    {"\x76\x2f\x31\x01"sv, PictureFormat::exr},
    {"#?"sv, PictureFormat::radiance},
    {"\x89PNG\r\n\x1a\n"sv, PictureFormat::png},
    {"\xff\xd8\xff"sv, PictureFormat::jpeg},
    {"II\x2a\0"sv, PictureFormat::tiff},
    {"MM\0\x2a"sv, PictureFormat::tiff},
    {"II\x2b\0"sv, PictureFormat::tiff},
    {"MM\0\x2b"sv, PictureFormat::tiff},
    {"BM"sv, PictureFormat::bmp},
};

/// Unsupported formats to name in the error message. A dot matches any byte.
constexpr std::pair<std::string_view, std::string_view> kOthers[] = {
    {"SDPX"sv, "a DPX file"},
    {"XPDS"sv, "a DPX file"},
    {"\x80\x2a\x5f\xd7"sv, "a Cineon file"},
    {"FOR4"sv, "an IFF file"},
    {"FORM"sv, "an IFF file"},
    {"GIF8"sv, "a GIF file"},
    {"8BPS"sv, "a Photoshop file"},
    {"RIFF....WEBP"sv, "a WebP file"},
    {"PF\n"sv, "a PFM file"},
    {"Pf\n"sv, "a PFM file"},
    {"P6\n"sv, "a PPM file"},
    {"P5\n"sv, "a PGM file"},
    {"....ftypavif"sv, "an AVIF file"},
    {"....ftyphei"sv, "a HEIF file"},
    {"\0\0\0\x0cjP  "sv, "a JPEG 2000 file"},
    {"\xff\x4f\xff\x51"sv, "a JPEG 2000 file"},
    {"\xff\x0a"sv, "a JPEG XL file"},
    {"DDS "sv, "a DDS file"},
    {"\x01\xda"sv, "an SGI file"},
};

bool begins_with(std::span<const uint8_t> head, std::string_view pattern) {
  return head.size() >= pattern.size() &&
         std::equal(pattern.begin(), pattern.end(), head.begin(),
                    [](char p, uint8_t b) { return p == '.' || static_cast<uint8_t>(p) == b; });
}

}  // namespace

PictureFormat picture_format_of(std::span<const uint8_t> head, const std::string& path) {
  for (const auto& [magic, format] : kFormats) {
    if (begins_with(head, magic)) return format;
  }
  std::string found = head.empty() ? "an empty file" : "not in a supported image format";
  for (const auto& [magic, name] : kOthers) {
    if (begins_with(head, magic)) found = name;
  }
  throw Error(Status::unsupported,
              path + ": is " + found + ". Convert it to OpenEXR, Radiance HDR, PNG, JPEG, TIFF or BMP.");
}

namespace {

/// Corner of the stored pixels where the upright picture's first pixel lies.
struct Origin {
  bool right = false, bottom = false;
};

Origin origin_of(Orientation orientation) {
  switch (orientation) {
    case Orientation::mirrored:
    case Orientation::turned_ccw:
      return {.right = true};
    case Orientation::flipped:
    case Orientation::turned_cw:
      return {.bottom = true};
    case Orientation::turned_180:
    case Orientation::transversed:
      return {.right = true, .bottom = true};
    case Orientation::normal:
    case Orientation::transposed:
      break;
  }
  return {};
}

}  // namespace

Picture upright(Picture stored, Orientation orientation) {
  if (orientation == Orientation::normal) return stored;
  const bool swapped = swaps_sides(orientation);
  Picture result{swapped ? stored.height : stored.width, swapped ? stored.width : stored.height, stored.channels, {}};
  result.pixels.resize(stored.pixels.size());
  const Origin origin = origin_of(orientation);
  float* out = result.pixels.data();
  for (int y = 0; y < result.height; ++y) {
    for (int x = 0; x < result.width; ++x, out += stored.channels) {
      const int column = swapped ? y : x, row = swapped ? x : y;
      const float* in = stored.pixel(origin.right ? stored.width - 1 - column : column,
                                     origin.bottom ? stored.height - 1 - row : row);
      std::copy_n(in, stored.channels, out);
    }
  }
  return result;
}

namespace {

using namespace std::string_view_literals;

// Protect against hostile files with segments and chunks of a few bytes.
constexpr int kMaxSegments = 4096, kMaxChunks = 1 << 20;

/// Bounds-checked view of a part of a file; reads beyond its end return nothing.
class Part {
 public:
  explicit Part(const RandomAccessFile& file) : file_(file), begin_(0), size_(file.size()) {}

  uint64_t size() const { return size_; }

  Part from(uint64_t at) const { return {file_, begin_ + std::min(at, size_), size_ - std::min(at, size_)}; }

  std::optional<uint64_t> number(uint64_t at, size_t count, bool big_endian) const {
    std::array<uint8_t, 8> bytes{};
    if (at > size_ || count > size_ - at) return std::nullopt;
    file_.read(begin_ + at, std::span(bytes).first(count));
    uint64_t value = 0;
    for (size_t i = 0; i < count; ++i) value |= uint64_t{bytes[i]} << (8 * (big_endian ? count - 1 - i : i));
    return value;
  }

  bool holds(uint64_t at, std::string_view text) const {
    std::array<char, 16> bytes{};
    if (at > size_ || text.size() > size_ - at) return false;
    file_.read(begin_ + at, {reinterpret_cast<uint8_t*>(bytes.data()), text.size()});
    return text == std::string_view(bytes.data(), text.size());
  }

 private:
  Part(const RandomAccessFile& file, uint64_t begin, uint64_t size) : file_(file), begin_(begin), size_(size) {}

  const RandomAccessFile& file_;
  uint64_t begin_, size_;
};

/// Reads the first directory of EXIF data, which have the form of a TIFF file.
Orientation of_tiff(const Part& tiff) {
  constexpr uint64_t kEntryBytes = 12, kOrientationTag = 274, kShort = 3;
  const bool big = tiff.holds(0, "MM\0\x2a"sv);
  if (!big && !tiff.holds(0, "II\x2a\0"sv)) return Orientation::normal;  // BigTIFF, which no camera writes
  const auto directory = tiff.number(4, 4, big);
  const auto count = directory ? tiff.number(*directory, 2, big) : std::nullopt;
  for (uint64_t i = 0; count && i < *count; ++i) {
    const uint64_t entry = *directory + 2 + i * kEntryBytes;
    const auto tag = tiff.number(entry, 2, big), type = tiff.number(entry + 2, 2, big);
    const auto value = tiff.number(entry + 8, 2, big);
    if (!tag || !type || !value) break;
    if (*tag == kOrientationTag && *type == kShort && *value >= 1 && *value <= 8)
      return static_cast<Orientation>(*value);
  }
  return Orientation::normal;
}

/// Searches the segments before the first scan.
Orientation of_jpeg(const Part& jpeg) {
  constexpr uint64_t kFill = 0xff, kStartOfScan = 0xda, kApp1 = 0xe1;
  constexpr auto kExif = "Exif\0\0"sv;
  uint64_t at = 2;
  for (int i = 0; i < kMaxSegments && jpeg.number(at, 1, true) == kFill; ++i) {
    const auto marker = jpeg.number(at + 1, 1, true), size = jpeg.number(at + 2, 2, true);
    if (marker == kFill) {
      ++at;
      continue;
    }
    if (!marker || marker == kStartOfScan || !size || *size < 2) break;
    if (marker == kApp1 && jpeg.holds(at + 4, kExif)) return of_tiff(jpeg.from(at + 4 + kExif.size()));
    at += 2 + *size;
  }
  return Orientation::normal;
}

Orientation of_png(const Part& png) {
  constexpr uint64_t kSignature = 8, kBesideData = 12;  // length, type and checksum of a chunk
  uint64_t at = kSignature;
  for (int i = 0; i < kMaxChunks && at + kBesideData <= png.size(); ++i) {
    if (png.holds(at + 4, "eXIf"sv)) return of_tiff(png.from(at + 8));
    at += kBesideData + *png.number(at, 4, true);
  }
  return Orientation::normal;
}

}  // namespace

int check_png_chunks(const std::string& path) {
  constexpr uint64_t kSignature = 8, kBesideData = 12, kBits = 24, kColorType = 25;
  constexpr uint64_t kLengthAndType = 8;
  constexpr std::array<int, 7> kSamples{1, 0, 3, 1, 2, 0, 4};  // stored per pixel, by color type; 0: not valid
  const RandomAccessFile file(path);
  const Part png(file);
  uint64_t at = kSignature;
  for (int i = 0; at + kLengthAndType <= png.size() && !png.holds(at + 4, "IEND"sv); ++i) {
    if (i == kMaxChunks)
      throw Error(Status::bad_data, path + ": has more than a million chunks. Save the image again.");
    if (png.holds(at + 4, "CgBI"sv))
      throw Error(Status::unsupported, path + ": is an Apple-optimized PNG; save it again as a PNG.");
    const uint64_t length = *png.number(at, 4, true);
    if (at == kSignature && !png.holds(at + 4, "IHDR"sv)) {
      throw Error(Status::bad_data, path + ": is damaged: its first chunk is not IHDR. Save the image again.");
    }
    if (at + kBesideData + length > png.size()) {
      throw Error(Status::bad_data, path + ": is damaged: the chunk at byte " + std::to_string(at) +
                                        " has a length of " + std::to_string(length) +
                                        " bytes, which is beyond the end of the file. Save the image again.");
    }
    at += kBesideData + length;
  }
  const auto bits = png.number(kBits, 1, true), type = png.number(kColorType, 1, true);
  if (!bits || !type || *type >= kSamples.size()) return 1;
  const bool is_depth = *bits == 2 || *bits == 4 || *bits == 8 || *bits == 16;
  return std::max(1, is_depth ? static_cast<int>(*bits) * kSamples[*type] : kSamples[*type]);
}

Orientation exif_orientation(PictureFormat format, const std::string& path) {
  const auto found_by = [&](auto&& find) {
    const RandomAccessFile file(path);
    return find(Part(file));
  };
  switch (format) {
    case PictureFormat::jpeg:
      return found_by(of_jpeg);
    case PictureFormat::png:
      return found_by(of_png);
    case PictureFormat::tiff:
    case PictureFormat::exr:
    case PictureFormat::radiance:
    case PictureFormat::bmp:
      break;
  }
  return Orientation::normal;
}

}  // namespace velour
