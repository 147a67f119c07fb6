// How well a fitted BTF agrees with what it was made of.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace velour {

struct BtfRecord {
  std::string method;                                  // "svd", "srbf"
  double psnr = 0;                                     // dB, over all pairs that were fitted (docs/conventions.md)
  std::optional<double> psnr_held_out = std::nullopt;  // of pairs that no fit has seen
  double ser = 0;                                      // squared error of f cos(theta_l) over its squares
  double p99 = 0;                     // the 99th percentile of the measurement's f, 1/sr: white of `psnr`
  uint64_t raw_bytes = 0;             // of the measurement as half floats
  double seconds = 0;                 // wall clock of the fit
  double evaluations_per_second = 0;  // of one thread, random places and directions; 0: nobody measured
  uint64_t seed = 0;
  std::vector<std::string> warnings;  // sentences
};

/// JSON, for an attribute of the model file.
std::string btf_record_json(const BtfRecord& record);
/// Throws Error(bad_data) with `where` (file and attribute) and the key at fault.
BtfRecord parse_btf_record(const std::string& text, const std::string& where);

}  // namespace velour
