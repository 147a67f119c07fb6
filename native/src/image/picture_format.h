// Which format a picture file has, by its first bytes.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace velour {

enum class PictureFormat { exr, radiance, png, jpeg, tiff, bmp };

/// Bytes that picture_format_of() looks at; fewer where the file is shorter.
inline constexpr size_t kPictureHeadBytes = 16;

/// Throws Error(unsupported) for every other content, naming the file, its format where that is known, and the formats
/// that are read.
PictureFormat picture_format_of(std::span<const uint8_t> head, const std::string& path);

}  // namespace velour
