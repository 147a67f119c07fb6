// Finished stages of a fit, stored in a file so that a killed fit can be resumed.
#pragma once

#include <fstream>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/warning.h"
#include "btf/fit/side_views.h"

namespace velour {

struct CheckpointOptions {
  std::string path;     // empty: nothing is stored
  std::string key;      // identifies the measurement and all options that affect the bits
  bool resume = false;  // use the stages in the file if its key matches
};

/// Name of the stage that fits side `side` of a BTF.
std::string side_stage(size_t side);

/// Results of stages by name, kept in the file alone. The file only grows: write() ends a block of records, each beside
/// its hash. Blocks that are incomplete or damaged, and all after them, count as not stored, as does what has another
/// shape or is not finite. Not thread-safe.
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

  // If the file cannot be written, these warn once; the fit continues.
  void keep(const std::string& stage, const RowMatrix& matrix);
  void keep_numbers(const std::string& stage, std::span<const double> numbers);
  void keep_integers(const std::string& stage, const std::vector<size_t>& integers);
  /// Removes all stages whose names start with `prefix`.
  void forget(const std::string& prefix);
  /// Ends a block: a killed fit finds all that was kept and forgotten since the last call, or nothing of it.
  void write();

  const std::vector<Warning>& warnings() const { return warnings_; }

 private:
  enum class Kind : uint32_t { key = 0x31434656, matrix, numbers, forgotten, end };  // "VFC1" begins the file
  struct Header {
    Kind kind;
    uint32_t name;           // length
    uint64_t rows, columns;  // of the data
    uint64_t bytes_of_number() const { return kind == Kind::matrix ? sizeof(float) : sizeof(double); }
    uint64_t bytes() const { return rows * columns * bytes_of_number(); }
  };
  struct Record {
    Header header;
    std::string name;
    uint64_t data;  // position in the file
  };
  using Stages = std::map<std::string, Record>;

  void read();
  std::optional<Record> next_record(uint64_t size) const;
  const Record* find(const std::string& stage, Kind kind) const;
  bool load(const Record& record, void* to) const;
  void append(Kind kind, const std::string& name, const void* data, uint64_t rows, uint64_t columns);

  CheckpointOptions options_;
  mutable std::fstream file_;
  Stages stages_;
  bool failed_ = false;
  std::vector<Warning> warnings_;
};

}  // namespace velour
