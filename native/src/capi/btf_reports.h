// JSON reports on BTFs, with the keys of the command line's verbs (docs/reference/cli_btf.md).
#pragma once

#include <string>
#include "btf/fit/btf_compare.h"
#include "btf/formats/btf_export.h"
#include "btf/measure/btf_measurement.h"
#include "capture/btf/btf_capture.h"
#include "capture/goniometer/microsurface.h"
#include "capture/tile/tile.h"
#include "model/model.h"

namespace velour::capi {

/// Reads a few pairs to count their values, unless these have been counted.
std::string btf_json(const BtfMeasurement& btf);
std::string btf_export_json(const BtfExportReport& report);
/// Report on the fit of a BTF's model.
std::string compression_json(const Model& model, uint64_t file_bytes);
std::string btf_errors_json(const BtfErrors& errors, double p99);

// JSON reports on virtual measurements, with the keys of the command line's verbs (docs/reference/cli_btf.md).

std::string capture_json(const BtfCaptureReport& report);
std::string microsurface_json(const MicrosurfaceReport& report);

// JSON reports on procedural mesostructure, with the keys of the command line's verbs (docs/reference/cli_btf.md).

std::string tile_json(const Tile& tile);
std::string tile_kinds_json();

}  // namespace velour::capi
