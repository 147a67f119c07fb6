#include "image/formats/exr_header_check.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "image/open_picture.h"

namespace velour {
namespace {

constexpr std::pair<std::string_view, uint32_t> kFixedTypes[] = {
    {"int", 4},         {"float", 4},     {"double", 8},   {"v2i", 8},
    {"v2f", 8},         {"v3i", 12},      {"v3f", 12},     {"v2d", 16},
    {"v3d", 24},        {"box2i", 16},    {"box2f", 16},   {"m33f", 36},
    {"m33d", 72},       {"m44f", 64},     {"m44d", 128},   {"chromaticities", 32},
    {"compression", 1}, {"lineOrder", 1}, {"rational", 8}, {"timecode", 8},
    {"keycode", 28},    {"envmap", 1},    {"tiledesc", 9}, {"deepImageState", 1}};

/// Properties of a compression method of OpenEXR.
struct Packing {
  double rows;        // per block in memory, even if the picture has fewer
  double most_ratio;  // maximum ratio of decoded to stored bytes
};

constexpr double kDeflate = 1032;
/// Indexed by the compression attribute: none, RLE, ZIPS, ZIP, PIZ (10 bits for 257 16-bit values), PXR24 (DEFLATE of
/// 24 of 32 bits), B44 and B44A (3 bytes for a 4 x 4 block of 32), DWAA and DWAB (DEFLATE of the means of 8 x 8
/// blocks).
constexpr Packing kPackings[] = {{1, 1},     {1, 128}, {1, kDeflate}, {16, kDeflate},       {32, 412},
                                 {16, 1376}, {32, 11}, {32, 11},      {32, kDeflate * 128}, {256, kDeflate * 128}};

/// Claims of a header about its part.
struct Claims {
  bool has_window = false;
  int64_t width = 0, height = 0;
  double pixel_bytes = 0;
  std::optional<uint8_t> compression;
  uint32_t tile_width = 0, tile_height = 0;
  bool is_deep = false;  // any number of values per pixel
};

class HeaderCheck {
 public:
  explicit HeaderCheck(const std::string& path)
      : path_(path), head_(read_file_head(path, kMaxHeader)), file_bytes_(std::filesystem::file_size(path)) {}

  void run() {
    const auto version = number<uint32_t>(4);
    if (!version) return;
    const bool has_parts = (*version & kSeveralParts) != 0;
    size_t at = 8;
    do {
      at = check_part(at);
    } while (has_parts && at < head_.size() && head_[at] != 0);
    if (has_parts && at == head_.size()) require_end();
  }

 private:
  static constexpr size_t kMaxHeader = size_t{1} << 20, kEnd = SIZE_MAX;
  static constexpr size_t kBesideChannelName = 16;   // type, a flag, steps along x and y
  static constexpr uint32_t kSeveralParts = 0x1000;  // multi-part bit of the version field

  [[noreturn]] void fail(const std::string& what) const { throw Error(Status::bad_data, path_ + ": " + what); }

  /// Throws if the file goes on after what was read: no header that is not checked may reach OpenEXR.
  void require_end() const {
    if (head_.size() < file_bytes_)
      fail("its header is larger than 1 MB, which is not supported. Remove metadata from the file.");
  }

  template <typename T>
  std::optional<T> number(size_t at) const {
    T value;
    if (at > head_.size() || sizeof value > head_.size() - at) return std::nullopt;
    std::memcpy(&value, head_.data() + at, sizeof value);
    return value;
  }

  std::optional<std::string> text(size_t& at) const {
    const auto begin = head_.begin() + static_cast<std::ptrdiff_t>(std::min(at, head_.size()));
    const auto end = std::find(begin, head_.end(), 0);
    if (end == head_.end()) return std::nullopt;
    at = static_cast<size_t>(end - head_.begin()) + 1;
    return std::string(begin, end);
  }

  /// Checks the attributes (name, type, size, value) of the part whose header begins at `at`. Returns where the next
  /// header begins, or kEnd if the file ends before, which OpenEXR reports.
  size_t check_part(size_t at) const {
    Claims claims;
    while (at < head_.size() && head_[at] != 0) {
      const auto name = text(at), type = text(at);
      const auto size = number<uint32_t>(at);
      if (!name || !type || !size) {
        require_end();
        return kEnd;
      }
      at += sizeof *size;
      if (*size > file_bytes_ - at) fail("its header is damaged. Save the image again.");
      if (*size > head_.size() - at) require_end();
      check_value(*name, *type, *size, at);
      take_claim(*name, *type, *size, at, claims);
      at += *size;
    }
    if (at >= head_.size()) {
      require_end();
      return kEnd;
    }
    check_claims(claims);
    return at + 1;
  }

  /// OpenEXR reads a value by its type and ignores the size, so a wrong size would misplace the next attribute.
  void check_value(const std::string& name, const std::string& type, uint32_t size, size_t at) const {
    const auto fixed = fixed_exr_bytes(type);
    const bool is_whole = fixed                    ? size == *fixed
                          : type == "chlist"       ? is_channel_list(size, at)
                          : type == "preview"      ? is_preview(size, at)
                          : type == "stringvector" ? are_texts(size, at)
                                                   : true;
    if (!is_whole) {
      fail("its header is damaged: attribute " + name + " of type " + type + " has a size of " + std::to_string(size) +
           " bytes, which does not match its content. Save the image again.");
    }
  }

  /// The list ends with an empty name.
  bool is_channel_list(uint32_t size, size_t at) const {
    const size_t end = at + size;
    while (at < end) {
      const auto name = text(at);
      if (!name || at > end) return false;
      if (name->empty()) return at == end;
      at += kBesideChannelName;
    }
    return false;
  }

  bool is_preview(uint32_t size, size_t at) const {
    const auto width = number<uint32_t>(at), height = number<uint32_t>(at + 4);
    return size >= 8 && width && height && uint64_t{*width} * *height * 4 == size - 8 && *width <= size;
  }

  bool are_texts(uint32_t size, size_t at) const {
    const size_t end = at + size;
    while (at < end) {
      const auto length = number<uint32_t>(at);
      if (!length || end - at < sizeof *length || *length > end - at - sizeof *length) return false;
      at += sizeof *length + *length;
    }
    return true;
  }

  void take_claim(const std::string& name, const std::string& type, uint32_t size, size_t at, Claims& claims) const {
    const auto value = [&](size_t offset) { return int64_t{*number<int32_t>(at + offset)}; };
    if (name == "dataWindow" && size == 16) {
      claims.has_window = true;
      claims.width = value(8) - value(0) + 1;
      claims.height = value(12) - value(4) + 1;
    } else if (name == "chunkCount" && size == 4) {
      if (value(0) < 0 || static_cast<uint64_t>(value(0)) > file_bytes_ / sizeof(uint64_t))
        fail("the header claims " + std::to_string(value(0)) +
             " chunks, more than the file can contain; the file is damaged.");
    } else if (name == "compression" && size == 1) {
      claims.compression = head_[at];
    } else if (name == "tiles" && size == 9) {
      claims.tile_width = *number<uint32_t>(at);
      claims.tile_height = *number<uint32_t>(at + 4);
    } else if (name == "type" && type == "string") {
      constexpr std::string_view kDeep = "deep";
      claims.is_deep = std::string_view(reinterpret_cast<const char*>(&head_[at]), size).starts_with(kDeep);
    } else if (name == "channels" && type == "chlist") {
      claims.pixel_bytes = bytes_of_channels(size, at);
    }
  }

  /// Bytes per pixel; subsampled channels count in proportion.
  double bytes_of_channels(uint32_t size, size_t at) const {
    constexpr int32_t kHalf = 1;
    const size_t end = at + size;
    double bytes = 0;
    while (at < end && !text(at)->empty()) {
      const double steps = std::max(1.0, static_cast<double>(*number<int32_t>(at + 8)) * *number<int32_t>(at + 12));
      bytes += (*number<int32_t>(at) == kHalf ? 2 : 4) / steps;
      at += kBesideChannelName;
    }
    return bytes;
  }

  void check_claims(const Claims& claims) const {
    constexpr double kAlwaysAllowed = 64 << 20, kTimesDecoded = 4;
    // OpenEXR assumes defaults for what is missing: 64 x 64 pixels, ZIP.
    const auto require = [&](bool is_there, const char* name) {
      if (!is_there) fail("its header is damaged: attribute " + std::string(name) + " is missing.");
    };
    require(claims.has_window, "dataWindow");
    require(claims.compression.has_value(), "compression");
    if (claims.width <= 0 || claims.height <= 0) return;  // reported by OpenEXR
    const Packing& packing = kPackings[std::min<size_t>(*claims.compression, std::size(kPackings) - 1)];
    const double row = static_cast<double>(claims.width) * claims.pixel_bytes;
    const double decoded = row * static_cast<double>(claims.height);
    const std::string said =
        "the header claims " + std::to_string(claims.width) + " x " + std::to_string(claims.height) + " pixels";
    const double most_rows = static_cast<double>(kMaxExpansion * 8) * static_cast<double>(file_bytes_);
    if ((!claims.is_deep && decoded > packing.most_ratio * static_cast<double>(file_bytes_)) ||
        static_cast<double>(claims.height) > most_rows) {
      fail(said + ", more than the file can contain; the file is damaged.");
    }
    const double tile = static_cast<double>(claims.tile_width) * claims.tile_height * claims.pixel_bytes;
    if (std::max(tile, packing.rows * row) > kAlwaysAllowed + kTimesDecoded * decoded)
      fail(said + " in compression blocks that are many times as large. Save the image without compression.");
  }

  std::string path_;
  std::vector<uint8_t> head_;  // read first, for a clear error message about a bad path
  uint64_t file_bytes_;
};

}  // namespace

void check_exr_header(const std::string& path) { HeaderCheck(path).run(); }

std::optional<uint32_t> fixed_exr_bytes(std::string_view type) {
  const auto found = std::ranges::find(kFixedTypes, type, &std::pair<std::string_view, uint32_t>::first);
  return found != std::end(kFixedTypes) ? std::optional(found->second) : std::nullopt;
}

}  // namespace velour
