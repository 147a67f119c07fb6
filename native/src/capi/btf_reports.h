// JSON reports on BTFs, with the keys of the command line's verbs (docs/command_line.md).
#pragma once

#include <string>

#include "btf/btf_export.h"
#include "btf/btf_measurement.h"
#include "compress/btf_compare.h"
#include "model/model.h"

namespace velour::capi {

/// Reads a few pairs to count their values, unless these have been counted.
std::string btf_json(const BtfMeasurement& btf);
std::string btf_export_json(const BtfExportReport& report);
/// Report on the fit of a BTF's model.
std::string compression_json(const Model& model, uint64_t file_bytes);
std::string btf_errors_json(const BtfErrors& errors, double p99);

}  // namespace velour::capi
