// The headers of an OpenEXR file of any program, checked before OpenEXR sees them: it takes memory for all rows, chunks
// and attributes that they claim before anyone can ask how many. Internal to image/.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace velour {

/// Throws Error(bad_data) for claims that the file cannot hold, and attributes whose sizes or contents are not those of
/// their types. A header that ends early is left to OpenEXR, which says so.
void check_exr_header(const std::string& path);

/// The size of an attribute of this type; nothing where sizes vary.
std::optional<uint32_t> fixed_exr_bytes(std::string_view type);

}  // namespace velour
