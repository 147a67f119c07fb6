// Checks the headers of an OpenEXR file by any program before OpenEXR sees them: OpenEXR allocates memory for all rows,
// chunks and attributes that they claim before their number can be queried. Internal to image/.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace velour {

/// Throws Error(bad_data) for claims that exceed the file, and for attributes whose sizes or contents do not match
/// their types. A header that ends early is left to OpenEXR, which reports it.
void check_exr_header(const std::string& path);

/// Size in bytes of an attribute of this type; empty if it varies.
std::optional<uint32_t> fixed_exr_bytes(std::string_view type);

}  // namespace velour
