// Finished stages of a fit, stored in a file so that a killed fit can be resumed.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/warning.h"
#include "btf/fit/side_views.h"
#include "image/tensors/exr_tensors.h"

namespace velour {

struct CheckpointOptions {
  std::string path;     // empty: nothing is stored
  std::string key;      // identifies the measurement and all options that affect the bits
  bool resume = false;  // use the stages in the file if its key matches
};

/// Name of the stage that fits side `side` of a BTF.
std::string side_stage(size_t side);

/// Results of stages by name. Data from the file is validated; what is missing or invalid counts as not stored. Not
/// thread-safe.
class FitCheckpoint {
 public:
  FitCheckpoint() = default;  // stores nothing
  explicit FitCheckpoint(CheckpointOptions options);

  /// A matrix [rows][columns]; empty unless it is stored with that shape and finite.
  std::optional<RowMatrix> matrix(const std::string& stage, Eigen::Index rows, Eigen::Index columns) const;
  /// Up to `most` finite numbers.
  std::optional<std::vector<double>> numbers(const std::string& stage, size_t most) const;
  /// Up to `most` integers from 0 to `largest`.
  std::optional<std::vector<size_t>> integers(const std::string& stage, size_t most, size_t largest) const;

  void keep(const std::string& stage, const RowMatrix& matrix);
  void keep_numbers(const std::string& stage, std::span<const double> numbers);
  void keep_integers(const std::string& stage, const std::vector<size_t>& integers);
  /// Removes all stages whose names start with `prefix`; the file is updated by the next write().
  void forget(const std::string& prefix);
  /// Writes all stages atomically. If the file cannot be written, warns once; the fit continues.
  void write();
  /// Deletes the file, after a successful fit.
  void remove();

  const std::vector<Warning>& warnings() const { return warnings_; }

 private:
  void read();
  const Tensor* find(const std::string& stage) const;

  CheckpointOptions options_;
  TensorFile file_;
  bool failed_ = false;
  std::vector<Warning> warnings_;
};

}  // namespace velour
