// Recognizes the format of a picture file by its first bytes.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace velour {

enum class PictureFormat { exr, radiance, png, jpeg, tiff, bmp };

/// Number of bytes that picture_format_of() examines; shorter files have fewer.
inline constexpr size_t kPictureHeadBytes = 16;

/// Throws Error(unsupported) for any other content, naming the file, its format if known, and the supported formats.
PictureFormat picture_format_of(std::span<const uint8_t> head, const std::string& path);

}  // namespace velour
