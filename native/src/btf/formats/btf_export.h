// Exports BTFs as folders of image files, for other programs.
#pragma once

#include <string>

#include "base/progress.h"
#include "btf/measure/btf_measurement.h"

namespace velour {

struct BtfExportReport {
  std::string format;  // "ubo2003": images named by their angles; "csv": numbered images and an index, btf.csv
  uint64_t pictures = 0, bytes = 0;
  double seconds = 0;
};

/// Writes one half-float OpenEXR image per pair into `path`, a new or empty folder. Images are named by their angles if
/// the set is complete and all angles are whole degrees from 0 to 999; otherwise they are numbered and listed in
/// btf.csv. Images hold the apparent BRDF and are tagged as such, so that load_btf returns the same bits in the same
/// order (NaNs stay NaNs). Standard errors and structure are not exported. Throws Error(io).
BtfExportReport export_btf(const BtfMeasurement& btf, const std::string& path, Progress& progress);

}  // namespace velour
