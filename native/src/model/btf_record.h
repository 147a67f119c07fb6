// Quality of a fitted BTF relative to its source.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/warning.h"
#include "model/records.h"

namespace velour {

/// One fit of the search for a size.
struct SizeTrial {
  int coefficients = 0;  // per texel, of the side with the most; for an SVD, components
  uint64_t parameter_bytes = 0;
  double expected = 0;     // relative L2 error before the fit
  double relative_l2 = 0;  // measured

  bool operator==(const SizeTrial&) const = default;
};

/// A shape of clustered tensors that was tried before the fit.
struct ShapeTrial {
  uint32_t clusters = 0, members = 0;
  std::array<uint32_t, 4> rank{};  // of texels, views, lights, colors
  uint64_t parameter_bytes = 0;
  double expected = 0;  // relative L2 error, over the texels of the trial

  bool operator==(const ShapeTrial&) const = default;
};

struct BtfRecord {
  std::string method;                                  // "svd", "srbf", "tucker", "cta", "kcta"
  double psnr = 0;                                     // dB, over all fitted pairs (docs/engine/conventions.md)
  std::optional<double> psnr_held_out = std::nullopt;  // dB, over held-out pairs
  double ser = 0;                                      // squared error of f cos(theta_l) over its sum of squares
  double p99 = 0;                     // 99th percentile of the measurement's f, 1/sr: the white of `psnr`
  uint64_t raw_bytes = 0;             // size of the measurement as half floats
  double seconds = 0;                 // wall clock of the fit
  double evaluations_per_second = 0;  // per CPU second of one thread, at random places and directions; 0: not measured
  uint64_t seed = 0;
  std::vector<Warning> warnings;
  double relative_l2 = 0;          // of companded values over all fitted pairs; 0: not measured
  double tolerance = 0;            // requested maximum of relative_l2; 0: none
  OrderCurve order;                // error over size; `lobes` are coefficients per texel, or components
  std::vector<SizeTrial> search;   // in the order of the fits
  std::vector<ShapeTrial> shapes;  // of clustered tensors, in the order of the trials
};

/// [{"coefficients", "parameter_bytes", "expected", "relative_l2"}, ...], errors with four digits.
nlohmann::ordered_json trials_json(const std::vector<SizeTrial>& trials);

/// [{"clusters", "members", "texel_rank", "view_rank", "light_rank", "color_rank", "parameter_bytes", "expected"}, ...]
nlohmann::ordered_json shapes_json(const std::vector<ShapeTrial>& shapes);

/// JSON, for an attribute of the model file.
std::string btf_record_json(const BtfRecord& record);
/// Throws Error(bad_data) with `where` (file and attribute) and the key at fault.
BtfRecord parse_btf_record(const std::string& text, const std::string& where);

}  // namespace velour
