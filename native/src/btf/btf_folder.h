// Velour's own form of a BTF: a folder with an index, btf.json, and one file of images a view (docs/formats.md).
#pragma once

#include <memory>
#include <string>

#include "btf/btf_index.h"
#include "btf/btf_measurement.h"

namespace velour {

/// One view, ready to be written: borrowed arrays.
struct BtfView {
  std::span<const HalfBits> values;          // [light of the view][row][column][3]
  std::span<const HalfBits> errors = {};     // the same without channels; empty when the index has none
  const ViewStructure* structure = nullptr;  // as the index says
};

/// Writes view by view, in any order; each view's file is written atomically, so that what a killed capture leaves are
/// whole views. Different views may be written from different threads at a time.
class BtfFolderWriter {
 public:
  /// Makes `path`, or goes on with what is there. Throws Error(io) when the folder holds another BTF (its index
  /// differs in any way from `index`) or files that are no BTF, and unless `resume` also when it holds this BTF.
  BtfFolderWriter(const std::string& path, BtfIndex index, bool resume);

  /// Whether this view's file is there and whole.
  bool has(uint32_t view) const;
  /// Throws Error(invalid_argument) when an array does not have the size that the index asks for.
  void write(uint32_t view, const BtfView& content, const Progress& progress = Progress()) const;
  /// Counts values and hashes files, and marks the BTF as complete: until then it cannot be loaded. Throws
  /// Error(invalid_state) when a view is missing.
  void finish(const Progress& progress = Progress()) const;
  /// Bytes of all files that are there.
  uint64_t bytes() const;

 private:
  std::string path_;
  BtfIndex index_;
};

/// Throws Error(io, bad_data, version_mismatch) with one sentence that names file and field. Checks sizes, headers and
/// chunk tables of all views' files; their pixels are read when asked for. `tile_metres` stands in for what the index
/// says.
std::shared_ptr<const BtfMeasurement> load_btf_folder(const std::string& path,
                                                      const std::optional<Vec2>& tile_metres = std::nullopt);

/// Whether `path` is a folder that holds an index of ours.
bool is_btf_folder(const std::string& path);

}  // namespace velour
