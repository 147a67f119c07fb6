// Velour's own form of a BTF: a folder with an index, btf.json, and one file of images a view (docs/formats.md).
#pragma once

#include <memory>
#include <string>

#include "btf/btf_measurement.h"

namespace velour {

/// What the index says before any view is there.
struct BtfIndex {
  PairLayout layout;
  TexelGrid grid;
  std::optional<Shell> shell;
  std::string source;      // name of what was captured
  std::string options;     // JSON object: whatever decides the values, so that a resumed capture is the same capture
  bool structure = false;  // views come with a ViewStructure
  bool errors = false;     // ... and with standard errors
};

/// One view, ready to be written.
struct BtfView {
  std::vector<HalfBits> values;            // [light of the view][row][column][3]
  std::vector<HalfBits> errors;            // the same without channels; empty when the index has none
  std::optional<ViewStructure> structure;  // as the index says
};

/// Writes view by view, in any order, from one thread at a time; each view's file is written atomically, so that what a
/// killed capture leaves are whole views.
class BtfFolderWriter {
 public:
  /// Makes `path`, or goes on with what is there. Throws Error(io) when the folder holds another BTF (its index
  /// differs in any way from `index`) and unless `resume` also when it holds views of this one.
  BtfFolderWriter(const std::string& path, BtfIndex index, bool resume);

  /// Whether this view's file is there and whole.
  bool has(uint32_t view) const;
  void write(uint32_t view, const BtfView& content) const;
  /// Marks the BTF as complete: until then it cannot be loaded. Throws Error(invalid_state) when a view is missing.
  void finish() const;
  /// Bytes of all files.
  uint64_t bytes() const;

 private:
  std::string path_;
  BtfIndex index_;
};

/// Throws Error(io, bad_data, version_mismatch) with one sentence that names file and field. Checks the sizes of all
/// views' files; their pixels are read when asked for.
std::shared_ptr<const BtfMeasurement> load_btf_folder(const std::string& path);

/// Whether `path` is a folder that holds an index of ours.
bool is_btf_folder(const std::string& path);

}  // namespace velour
