// What a fit has finished, kept in a file so that a killed one can go on.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compress/companded_views.h"
#include "image/exr_tensors.h"

namespace velour {

struct CheckpointOptions {
  std::string path;     // empty: nothing is kept
  std::string key;      // names the measurement and all options that bits depend on
  bool resume = false;  // what the file holds is used, where its key is this one
};

/// Name of the stage that fits side `side` of a BTF.
std::string side_stage(size_t side);

/// Results of stages by name. Whatever comes from the file is checked: what is missing or not as it should be is as if
/// it had not been kept. Not thread-safe.
class FitCheckpoint {
 public:
  FitCheckpoint() = default;  // keeps nothing
  explicit FitCheckpoint(CheckpointOptions options);

  /// Of [rows][columns]; nothing where it is not there in that shape, all finite.
  std::optional<RowMatrix> matrix(const std::string& stage, Eigen::Index rows, Eigen::Index columns) const;
  /// Of any number up to `most`, finite.
  std::optional<std::vector<double>> numbers(const std::string& stage, size_t most) const;
  /// The same of whole numbers from 0 to `largest`.
  std::optional<std::vector<size_t>> wholes(const std::string& stage, size_t most, size_t largest) const;

  void keep(const std::string& stage, const RowMatrix& matrix);
  void keep_numbers(const std::string& stage, std::span<const double> numbers);
  void keep_wholes(const std::string& stage, const std::vector<size_t>& wholes);
  /// Forgets all stages whose names begin so; the file follows with the next write().
  void forget(const std::string& prefix);
  /// All that was kept so far, whole or not at all. A file that cannot be written is warned of, once; the fit goes on.
  void write();
  /// After a success.
  void remove();

  /// Sentences.
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  void read();
  const Tensor* find(const std::string& stage) const;

  CheckpointOptions options_;
  TensorFile file_;
  bool failed_ = false;
  std::vector<std::string> warnings_;
};

}  // namespace velour
