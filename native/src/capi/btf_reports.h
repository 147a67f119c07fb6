// JSON texts about BTFs: the keys of the command line's verbs (docs/command_line.md).
#pragma once

#include <string>

#include "btf/btf_export.h"
#include "btf/btf_measurement.h"

namespace velour::capi {

/// Reads a few pairs to count values, where nobody has counted them.
std::string btf_json(const BtfMeasurement& btf);
std::string btf_export_json(const BtfExportReport& report);

}  // namespace velour::capi
