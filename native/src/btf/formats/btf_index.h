// The index of Velour's own BTF format, btf.json (docs/reference/measurement_formats.md).
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "btf/measure/btf_measurement.h"

namespace velour {

/// Maximum size of an index file.
inline constexpr uint64_t kMaxBtfIndexBytes = uint64_t{1} << 30;

/// Data known before any view is written.
struct BtfIndex {
  PairLayout layout;
  TexelGrid grid;
  std::optional<Shell> shell = std::nullopt;
  std::string source = {};  // name of the captured surface
  std::string options =
      "{}";                // JSON object of all settings that affect the values; must match when a capture is resumed
  bool structure = false;  // each view has a ViewStructure
  bool errors = false;     // each view has standard errors
};

/// Data known once all views are written.
struct BtfContent {
  struct ViewFile {
    uint64_t bytes = 0;
    std::string sha256;
    bool operator==(const ViewFile&) const = default;
  };
  std::vector<ViewFile> views;  // one per view
  ValueCounts counts;
  bool operator==(const BtfContent&) const = default;
};

struct DecodedBtfIndex {
  BtfIndex index;
  std::optional<BtfContent> content;  // empty while views are missing
};

/// All numbers survive a round trip bit for bit. Throws Error(invalid_argument) for an invalid index.
std::string encode_btf_index(const BtfIndex& index, const std::optional<BtfContent>& content);

/// `name`: file name for error messages, which also name the field at fault. Throws Error(bad_data), or
/// Error(version_mismatch) for another version of the format.
DecodedBtfIndex decode_btf_index(std::span<const uint8_t> bytes, const std::string& name);

/// Name of the first field in which two indices differ; empty if they are equal.
std::optional<std::string> difference(const BtfIndex& a, const BtfIndex& b);

}  // namespace velour
