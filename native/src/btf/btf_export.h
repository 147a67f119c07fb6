// BTFs as folders of pictures, for other programs.
#pragma once

#include <string>

#include "btf/btf_measurement.h"
#include "job/progress.h"

namespace velour {

struct BtfExportReport {
  std::string format;  // "ubo2003": pictures named for their angles; "csv": an index, btf.csv, with numbered pictures
  uint64_t pictures = 0, bytes = 0;
  double seconds = 0;
};

/// Writes one OpenEXR picture of half floats a pair into the new or empty folder `path`: named for its angles where the
/// set is complete and all angles are whole degrees from 0 to 999, else numbered and listed in btf.csv. Pictures hold
/// the apparent BRDF and say so, so that load_btf gives back the same bits in the same order (NaNs stay NaNs). Standard
/// errors and structure are left behind. Throws Error(io).
BtfExportReport export_btf(const BtfMeasurement& btf, const std::string& path, Progress& progress);

}  // namespace velour
