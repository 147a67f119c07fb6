#include "image/picture_format.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "base/error.h"

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

}  // namespace velour
