// Velour's own BTF format: a folder with an index, btf.json, and one image file per view
// (docs/reference/measurement_formats.md).
#pragma once

#include <memory>
#include <string>
#include <vector>
#include "btf/formats/btf_index.h"
#include "btf/measure/btf_measurement.h"
#include "image/image_stack.h"

namespace velour {

/// One view to be written. The arrays are borrowed.
struct BtfView {
  std::span<const HalfBits> values;          // [light of the view][row][column][3]
  std::span<const HalfBits> errors = {};     // [light of the view][row][column]; empty if the index has no errors
  const ViewStructure* structure = nullptr;  // null if the index has no structure
};

/// Writes views in any order. Each file is written atomically, so a killed capture leaves only complete views.
/// Different views may be written concurrently from different threads.
class BtfFolderWriter {
 public:
  /// Creates `path`, or continues an existing folder. Throws Error(io) if the folder holds another BTF (whose index
  /// differs in any way from `index`) or files that are not a BTF; also if it holds this BTF and `resume` is false.
  BtfFolderWriter(const std::string& path, BtfIndex index, bool resume);

  /// Whether this view's file exists and is complete.
  bool has(uint32_t view) const;
  /// Throws Error(invalid_argument) if an array does not have the size required by the index.
  void write(uint32_t view, const BtfView& content, const Progress& progress = Progress()) const;
  /// Counts values, hashes files and marks the BTF as complete; before that it cannot be loaded. Throws
  /// Error(invalid_state) if a view is missing.
  void finish(const Progress& progress = Progress()) const;
  /// Total size of all existing files in bytes.
  uint64_t bytes() const;

 private:
  std::string path_;
  BtfIndex index_;
};

/// Checks sizes, headers and chunk tables of all view files; pixels are read on demand. `tile_metres` overrides the
/// index. Throws Error(io, bad_data, version_mismatch) with one sentence that names the file and the field.
std::shared_ptr<const BtfMeasurement> load_btf_folder(const std::string& path,
                                                      const std::optional<Vec2>& tile_metres = std::nullopt);

/// Whether `path` is a folder with an index of this format.
bool is_btf_folder(const std::string& path);

// The file of one view in Velour's own BTF format and its image stacks. Internal to btf/.

/// Indices of the parts present in a view's file: values and errors first; coverage, mean and spread of heights last.
inline constexpr size_t kValuesPart = 0, kErrorsPart = 1, kStructureParts = 3;

/// `folder`/view_0007.exr.
std::string view_path(const std::string& folder, size_t view);

/// Empty for a view without lights and structure, which has no file.
std::vector<ImageStack> view_stacks(const BtfIndex& index, size_t view);

}  // namespace velour
