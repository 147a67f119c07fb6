// BTFs of Bonn's UBO2014 database: factorized .btf files, decoded pair by pair (docs/reference/btf_formats.md).
#pragma once

#include <memory>
#include <string>

#include "btf/formats/load_btf.h"

namespace velour {

/// Decodes on demand from the file; keeps no factors in memory. Throws Error(io, bad_data, unsupported).
std::shared_ptr<const BtfMeasurement> load_ubo_file(const std::string& path, const BtfLoadOptions& options);

/// Whether a file begins with a signature of Bonn's formats.
bool is_ubo_file(const std::string& path);

}  // namespace velour
