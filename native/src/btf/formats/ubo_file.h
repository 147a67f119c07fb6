// BTFs of Bonn's UBO2014 database: factorized .btf files, decoded pair by pair (docs/reference/btf_formats.md).
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include "base/file.h"
#include "btf/formats/load_btf.h"
#include "btf/measure/pair_layout.h"

namespace velour {

// Header and structure of Bonn's .btf files (UBO2014), as in public readers (docs/reference/btf_formats.md). Internal
// to btf/.

/// Color model of the three decorrelated channels.
enum class UboColors : int32_t {
  rgb = 0,
  yuv = 1,
  log_y_uv = 9,       // ln(Y + eps), U, V
  log_y_ratios = 11,  // ln(Y + eps), U / (Y + eps), V / (Y + eps)
  log_rgb = 12,       // ln(channel + eps)
};

/// A matrix of `rows` x `components`, row by row.
struct UboMatrix {
  uint64_t offset = 0;  // bytes
  uint64_t rows = 0;
};

/// channel[texel][pair] = sum over components of texels[texel][k] pairs[pair][k].
struct UboChannel {
  uint32_t scalar_bytes = 2;  // 2, 4 or 8
  uint64_t components = 0;
  UboMatrix pairs, texels;
};

struct UboHeader {
  uint32_t version = 0;
  std::string setup, sensor, light_source;
  float pixels_per_mm = 0;
  bool cosine = false;  // whether the numbers include the cosine of the light
  std::optional<PairLayout> layout;
  std::vector<uint64_t> row_of_pair;  // row of each pair in the pair matrices
  uint32_t width = 0, height = 0;
  UboColors colors = UboColors::rgb;
  std::array<UboChannel, 3> channels;
};

/// Checks every size against the file's before allocating. Throws Error(bad_data, unsupported) with file and field.
UboHeader read_ubo_header(const RandomAccessFile& file);

/// Decodes on demand from the file; keeps no factors in memory. Throws Error(io, bad_data, unsupported).
std::shared_ptr<const BtfMeasurement> load_ubo_file(const std::string& path, const BtfLoadOptions& options);

/// Whether a file begins with a signature of Bonn's formats.
bool is_ubo_file(const std::string& path);

}  // namespace velour
