// BTFs of Bonn's UBO2014 database: .btf files of factors, decoded pair by pair (docs/btf.md).
#pragma once

#include <memory>
#include <string>

#include "btf/load_btf.h"

namespace velour {

/// Decodes what is asked for from the file; holds no factors in memory. Throws Error(io, bad_data, unsupported).
std::shared_ptr<const BtfMeasurement> load_ubo_file(const std::string& path, const BtfLoadOptions& options);

/// Whether a file begins as one of Bonn's does.
bool is_ubo_file(const std::string& path);

}  // namespace velour
