// The color spaces that PNG (W3C, third edition), JPEG and TIFF files of integers state.
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>

#include "base/file.h"
#include "image/open_picture.h"

namespace velour {
namespace {

using Bytes = std::span<const uint8_t>;

constexpr size_t kMaxProfile = 1 << 22;  // larger profiles are tables for printers

/// Big-endian; 0 beyond the end.
uint32_t number_at(Bytes bytes, size_t at, size_t count = 4) {
  uint32_t value = 0;
  for (size_t i = 0; i < count; ++i) value = value << 8 | (at + i < bytes.size() ? bytes[at + i] : 0u);
  return value;
}

double fixed_at(Bytes bytes, size_t at) { return static_cast<int32_t>(number_at(bytes, at)) / 65536.0; }

std::string_view text_at(Bytes bytes, size_t at, size_t count) {
  if (at >= bytes.size()) return {};
  return {reinterpret_cast<const char*>(bytes.data()) + at, std::min(count, bytes.size() - at)};
}

bool is_near(double value, double expected, double tolerance) { return std::abs(value - expected) < tolerance; }

/// An ICC profile of a display: its tags by signature.
class IccProfile {
 public:
  explicit IccProfile(Bytes bytes) : bytes_(bytes) {}

  bool is_valid() const { return text_at(bytes_, 36, 4) == "acsp"; }
  std::string_view space() const { return text_at(bytes_, 16, 4); }

  std::string name() const {
    const Bytes tag = find("desc");
    if (text_at(tag, 0, 4) == "desc") return printable(text_at(tag, 12, number_at(tag, 8)), 1);
    if (text_at(tag, 0, 4) == "mluc") return printable(text_at(tag, number_at(tag, 24), number_at(tag, 20)), 2);
    return "";
  }

  /// A profile of tables alone is known by its name.
  bool is_srgb() const {
    if (find("rXYZ").empty()) return name().find("sRGB") != std::string::npos;
    constexpr double kColumns[3][3] = {{0.436, 0.222, 0.014}, {0.385, 0.717, 0.097}, {0.143, 0.061, 0.714}};  // D50
    constexpr const char* kPrimaries[] = {"rXYZ", "gXYZ", "bXYZ"};
    for (size_t c = 0; c < 3; ++c) {
      const Bytes tag = find(kPrimaries[c]);
      for (size_t i = 0; i < 3; ++i) {
        if (tag.empty() || !is_near(fixed_at(tag, 8 + 4 * i), kColumns[c][i], 0.01)) return false;
      }
    }
    return decodes_as_srgb("rTRC");
  }

  bool decodes_as_srgb(const char* signature) const {
    const auto half = half_decoded(find(signature));
    return half && is_near(*half, 0.214, 0.02);
  }

 private:
  static std::string printable(std::string_view text, size_t bytes_per_character) {
    std::string name;
    for (size_t i = bytes_per_character - 1; i < text.size() && name.size() < 60; i += bytes_per_character) {
      if (text[i] == '\0') break;
      name += text[i] >= ' ' && text[i] <= '~' ? text[i] : '?';
    }
    return name;
  }

  Bytes find(std::string_view signature) const {
    const uint32_t count = std::min(number_at(bytes_, 128), 1000u);
    for (uint32_t i = 0; i < count; ++i) {
      const size_t entry = 132 + size_t{12} * i;
      const size_t at = number_at(bytes_, entry + 4), size = number_at(bytes_, entry + 8);
      if (text_at(bytes_, entry, 4) != signature) continue;
      return at < bytes_.size() ? bytes_.subspan(at, std::min(size, bytes_.size() - at)) : Bytes{};
    }
    return {};
  }

  /// What a curve makes of half of the largest value.
  static std::optional<double> half_decoded(Bytes curve) {
    if (text_at(curve, 0, 4) == "curv") {
      const size_t count = number_at(curve, 8);
      if (count == 0) return 0.5;
      if (count == 1) return std::pow(0.5, number_at(curve, 12, 2) / 256.0);
      return number_at(curve, 12 + 2 * (count / 2), 2) / 65535.0;
    }
    if (text_at(curve, 0, 4) != "para") return std::nullopt;
    const double gamma = fixed_at(curve, 12);
    if (number_at(curve, 8, 2) == 0) return std::pow(0.5, gamma);
    return std::pow(fixed_at(curve, 16) * 0.5 + fixed_at(curve, 20), gamma);  // above the linear part
  }

  Bytes bytes_;
};

std::string inflated(Bytes compressed) {
  std::vector<uint8_t> bytes(std::min<size_t>(kMaxProfile, kMaxExpansion * compressed.size()));
  auto size = static_cast<uLongf>(bytes.size());
  if (uncompress(bytes.data(), &size, compressed.data(), static_cast<uLong>(compressed.size())) != Z_OK) return "";
  return {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)};
}

Bytes bytes_of(std::string_view text) { return {reinterpret_cast<const uint8_t*>(text.data()), text.size()}; }

/// The chunks of a PNG file that state its color space, by type.
std::map<std::string, std::vector<uint8_t>, std::less<>> color_chunks(const RandomAccessFile& file) {
  constexpr std::string_view kTypes[] = {"cICP", "iCCP", "sRGB", "gAMA", "cHRM"};
  constexpr uint64_t kBesideData = 12;  // length, type and checksum of a chunk
  constexpr int kMaxChunks = 4096;
  std::map<std::string, std::vector<uint8_t>, std::less<>> chunks;
  std::array<uint8_t, 8> head;
  uint64_t at = 8;
  for (int i = 0; i < kMaxChunks && at + kBesideData <= file.size(); ++i) {
    file.read(at, head);
    const uint64_t length = number_at(head, 0);
    const std::string type(text_at(head, 4, 4));
    if (type == "IDAT" || at + kBesideData + length > file.size()) break;
    if (std::ranges::count(kTypes, type) > 0 && length <= kMaxProfile) {
      std::vector<uint8_t>& data = chunks[type];
      data.resize(length);
      file.read(at + 8, data);
    }
    at += kBesideData + length;
  }
  return chunks;
}

std::string space_of_png(const RandomAccessFile& file) {
  const auto chunks = color_chunks(file);
  const auto find = [&](std::string_view type) {
    const auto found = chunks.find(type);
    return found == chunks.end() ? Bytes{} : Bytes(found->second);
  };
  if (const Bytes cicp = find("cICP"); cicp.size() >= 2) {
    const std::string codes = std::to_string(cicp[0]) + "/" + std::to_string(cicp[1]);
    return codes == "1/13" ? "" : "of code points " + codes;  // H.273
  }
  if (const Bytes iccp = find("iCCP"); !iccp.empty()) {
    const auto end = static_cast<size_t>(std::ranges::find(iccp, uint8_t{0}) - iccp.begin());
    return end + 2 >= iccp.size() ? "" : other_color_space(bytes_of(inflated(iccp.subspan(end + 2))));
  }
  if (!find("sRGB").empty()) return "";
  const Bytes gama = find("gAMA"), chrm = find("cHRM");
  const double exponent = number_at(gama, 0) / 1e5;
  if (!gama.empty() && exponent > 0 && !is_near(exponent, 1 / 2.2, 0.02)) {
    std::string gamma = std::to_string(std::round(100 / exponent) / 100);
    gamma.erase(gamma.find_last_not_of('0') + 1);
    if (gamma.ends_with('.')) gamma.pop_back();
    return "of gamma " + gamma;
  }
  constexpr double kSrgb[] = {0.3127, 0.329, 0.64, 0.33, 0.3, 0.6, 0.15, 0.06};
  for (size_t i = 0; !chrm.empty() && i < std::size(kSrgb); ++i) {
    if (!is_near(number_at(chrm, 4 * i) / 1e5, kSrgb[i], 0.01)) return "of other primaries (cHRM)";
  }
  return "";
}

/// The parts of a profile in the segments before the first scan, in order.
std::string space_of_jpeg(const RandomAccessFile& file) {
  constexpr uint8_t kFill = 0xff, kStartOfScan = 0xda, kApp2 = 0xe2;
  constexpr std::string_view kMark("ICC_PROFILE\0", 12);
  constexpr int kMaxSegments = 4096;
  std::map<uint8_t, std::vector<uint8_t>> parts;
  std::array<uint8_t, 18> head;
  uint64_t at = 2;
  for (int i = 0; i < kMaxSegments && at + head.size() <= file.size(); ++i) {
    file.read(at, head);
    if (head[0] != kFill || head[1] == kStartOfScan) break;
    if (head[1] == kFill) {
      ++at;
      continue;
    }
    const uint64_t size = number_at(head, 2, 2);
    if (size < 2 || at + 2 + size > file.size()) break;
    if (head[1] == kApp2 && text_at(head, 4, kMark.size()) == kMark && size >= 16) {
      std::vector<uint8_t>& part = parts[head[16]];
      part.resize(size - 16);
      file.read(at + head.size(), part);
    }
    at += 2 + size;
  }
  std::vector<uint8_t> profile;
  for (const auto& [number, part] : parts) profile.insert(profile.end(), part.begin(), part.end());
  return other_color_space(profile);
}

}  // namespace

std::string other_color_space(std::span<const uint8_t> icc_profile) {
  const IccProfile profile(icc_profile);
  if (!profile.is_valid()) return "";
  const std::string name = profile.name().empty() ? "without a name" : "'" + profile.name() + "'";
  if (profile.space() == "RGB ") return profile.is_srgb() ? "" : name;
  if (profile.space() == "GRAY") return profile.decodes_as_srgb("kTRC") ? "" : name;
  return name;
}

std::string other_color_space(PictureFormat format, const std::string& path) {
  const RandomAccessFile file(path);
  if (format == PictureFormat::png) return space_of_png(file);
  return format == PictureFormat::jpeg ? space_of_jpeg(file) : "";
}

void PictureHeader::note_color_space(const std::string& path, const std::string& space) {
  if (space.empty()) return;
  warnings.push_back(warning<WarningCode::color_space_ignored>({{"file", path}, {"space", space}}));
}

}  // namespace velour
