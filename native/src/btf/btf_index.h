// The index of Velour's own form of a BTF: btf.json (docs/formats.md).
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "btf/btf_measurement.h"
#include "btf/value_counts.h"

namespace velour {

/// More than the largest index takes.
inline constexpr uint64_t kMostBtfIndexBytes = uint64_t{1} << 30;

/// What is known before any view is there.
struct BtfIndex {
  PairLayout layout;
  TexelGrid grid;
  std::optional<Shell> shell = std::nullopt;
  std::string source = {};  // name of what was captured
  std::string options =
      "{}";                // JSON object: whatever decides the values, so that a resumed capture is the same capture
  bool structure = false;  // views come with a ViewStructure
  bool errors = false;     // ... and with standard errors
};

/// What is known once all views are there.
struct BtfContent {
  struct ViewFile {
    uint64_t bytes = 0;
    std::string sha256;
    bool operator==(const ViewFile&) const = default;
  };
  std::vector<ViewFile> views;  // one each
  ValueCounts counts;
  bool operator==(const BtfContent&) const = default;
};

struct DecodedBtfIndex {
  BtfIndex index;
  std::optional<BtfContent> content;  // nothing: views are still missing
};

/// All numbers survive a round trip bit for bit. Throws Error(invalid_argument) for an index that cannot be one.
std::string encode_btf_index(const BtfIndex& index, const std::optional<BtfContent>& content);

/// Throws Error(bad_data), or Error(version_mismatch) for a later version of the format; with `name`, the file's, and
/// the field at fault.
DecodedBtfIndex decode_btf_index(std::span<const uint8_t> bytes, const std::string& name);

/// The first field in which two indices differ; nothing when they are the same.
std::optional<std::string> difference(const BtfIndex& a, const BtfIndex& b);

}  // namespace velour
