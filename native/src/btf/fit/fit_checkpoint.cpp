#include "btf/fit/fit_checkpoint.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "base/file.h"

namespace velour {
namespace {

constexpr size_t kHash = 64;  // hexadecimal digits

std::span<const uint8_t> bytes_of(const void* data, size_t bytes) { return {static_cast<const uint8_t*>(data), bytes}; }

/// Hash of a record, without joining its parts.
template <class Header>
std::string hash_of(const Header& header, const std::string& name, const void* data) {
  const std::string parts = sha256_hex(bytes_of(&header, sizeof header)) +
                            sha256_hex(bytes_of(name.data(), name.size())) + sha256_hex(bytes_of(data, header.bytes()));
  return sha256_hex(bytes_of(parts.data(), parts.size()));
}

template <typename Stages>
size_t erase_stages(Stages& stages, const std::string& prefix) {
  return std::erase_if(stages, [&](const auto& entry) { return entry.first.starts_with(prefix); });
}

template <typename Number>
bool all_finite(std::span<const Number> values) {
  return std::all_of(values.begin(), values.end(), [](Number v) { return std::isfinite(v); });
}

constexpr auto kOpen = std::ios::in | std::ios::out | std::ios::binary;

}  // namespace

std::string side_stage(size_t side) { return "side." + std::to_string(side); }

FitCheckpoint::FitCheckpoint(CheckpointOptions options) : options_(std::move(options)) {
  std::error_code ignored;
  if (!options_.resume || options_.path.empty() || !std::filesystem::exists(options_.path, ignored)) return;
  try {
    read();
  } catch (const std::exception& error) {
    file_.close();
    stages_.clear();
    warnings_.push_back(warning<WarningCode::fit_not_resumed>({{"reason", error.what()}}));
  }
}

void FitCheckpoint::read() {
  const uint64_t size = RandomAccessFile(options_.path).size();
  file_.open(options_.path, kOpen);
  const auto first = next_record(size);
  if (!first || first->header.kind != Kind::key) {
    throw Error(Status::bad_data, options_.path + " is not the checkpoint of a fit, or it is damaged.");
  }
  if (first->name != options_.key) {
    throw Error(Status::bad_data, options_.path + " belongs to a fit of another BTF or with other options.");
  }
  uint64_t complete = 0;  // size of all complete blocks
  Stages stages;
  while (auto record = next_record(size)) {
    if (record->header.kind == Kind::forgotten) {
      erase_stages(stages, record->name);
    } else if (record->header.kind == Kind::end) {
      stages_ = stages;
      complete = static_cast<uint64_t>(file_.tellg());
    } else {
      stages[record->name] = *record;
    }
  }
  if (complete == 0) throw Error(Status::bad_data, options_.path + " has no finished stage, or it is damaged.");
  file_.clear();
  std::filesystem::resize_file(options_.path, complete);
}

/// The record at the file's position; empty if it is incomplete or damaged.
std::optional<FitCheckpoint::Record> FitCheckpoint::next_record(uint64_t size) const {
  Record record{};
  Header& header = record.header;
  file_.read(reinterpret_cast<char*>(&header), sizeof header);
  if (!file_) return std::nullopt;
  const uint64_t left = size - static_cast<uint64_t>(file_.tellg());
  const uint64_t row = left / header.bytes_of_number() / std::max<uint64_t>(1, header.rows);
  if (header.name > left || header.rows > left || header.columns > row) return std::nullopt;
  record.name.resize(header.name);
  file_.read(record.name.data(), header.name);
  record.data = static_cast<uint64_t>(file_.tellg());
  std::vector<char> data(header.bytes());
  file_.read(data.data(), static_cast<std::streamsize>(data.size()));
  std::string hash(kHash, ' ');
  file_.read(hash.data(), kHash);
  if (!file_ || hash != hash_of(header, record.name, data.data())) return std::nullopt;
  return record;
}

const FitCheckpoint::Record* FitCheckpoint::find(const std::string& stage, Kind kind) const {
  const auto found = stages_.find(stage);
  return found == stages_.end() || found->second.header.kind != kind ? nullptr : &found->second;
}

bool FitCheckpoint::load(const Record& record, void* to) const {
  file_.seekg(static_cast<std::streamoff>(record.data));
  file_.read(static_cast<char*>(to), static_cast<std::streamsize>(record.header.bytes()));
  if (file_) return true;
  file_.clear();
  return false;
}

std::optional<RowMatrix> FitCheckpoint::matrix(const std::string& stage, Eigen::Index rows,
                                               Eigen::Index columns) const {
  const Record* record = find(stage, Kind::matrix);
  if (!record || record->header.rows != static_cast<uint64_t>(rows) ||
      record->header.columns != static_cast<uint64_t>(columns)) {
    return std::nullopt;
  }
  RowMatrix matrix(rows, columns);
  if (!load(*record, matrix.data()) ||
      !all_finite(std::span<const float>(matrix.data(), static_cast<size_t>(matrix.size()))))
    return std::nullopt;
  return matrix;
}

std::optional<std::vector<double>> FitCheckpoint::numbers(const std::string& stage, size_t most) const {
  const Record* record = find(stage, Kind::numbers);
  if (!record || record->header.rows > most || record->header.columns != 1) return std::nullopt;
  std::vector<double> numbers(record->header.rows);
  if (!load(*record, numbers.data()) || !all_finite(std::span<const double>(numbers))) return std::nullopt;
  return numbers;
}

std::optional<std::vector<size_t>> FitCheckpoint::integers(const std::string& stage, size_t most,
                                                           size_t largest) const {
  const auto numbers = this->numbers(stage, most);
  if (!numbers) return std::nullopt;
  std::vector<size_t> integers;
  for (const double n : *numbers) {
    if (!(n >= 0 && n <= static_cast<double>(largest) && n == std::floor(n))) return std::nullopt;
    integers.push_back(static_cast<size_t>(n));
  }
  return integers;
}

void FitCheckpoint::append(Kind kind, const std::string& name, const void* data, uint64_t rows, uint64_t columns) {
  if (options_.path.empty() || failed_) return;
  if (!file_.is_open() && kind != Kind::key) {
    file_.open(options_.path, kOpen | std::ios::trunc);
    append(Kind::key, options_.key, nullptr, 0, 0);
    if (failed_) return;
  }
  file_.seekp(0, std::ios::end);
  const Header header{kind, static_cast<uint32_t>(name.size()), rows, columns};
  const std::string hash = hash_of(header, name, data);
  file_.write(reinterpret_cast<const char*>(&header), sizeof header).write(name.data(), header.name);
  if (kind == Kind::matrix || kind == Kind::numbers) {
    stages_[name] = {header, name, static_cast<uint64_t>(file_.tellp())};
  }
  file_.write(static_cast<const char*>(data), static_cast<std::streamsize>(header.bytes()));
  file_.write(hash.data(), kHash);
  if (kind == Kind::end) file_.flush();
  if (file_) return;
  failed_ = true;
  stages_.clear();
  warnings_.push_back(warning<WarningCode::checkpoint_not_written>(
      {{"reason", options_.path + ": cannot write: " + std::generic_category().message(errno) + "."}}));
}

void FitCheckpoint::keep(const std::string& stage, const RowMatrix& matrix) {
  append(Kind::matrix, stage, matrix.data(), static_cast<uint64_t>(matrix.rows()),
         static_cast<uint64_t>(matrix.cols()));
}

void FitCheckpoint::keep_numbers(const std::string& stage, std::span<const double> numbers) {
  append(Kind::numbers, stage, numbers.data(), numbers.size(), 1);
}

void FitCheckpoint::keep_integers(const std::string& stage, const std::vector<size_t>& integers) {
  keep_numbers(stage, std::vector<double>(integers.begin(), integers.end()));
}

void FitCheckpoint::forget(const std::string& prefix) {
  if (erase_stages(stages_, prefix) > 0) append(Kind::forgotten, prefix, nullptr, 0, 0);
}

void FitCheckpoint::write() { append(Kind::end, "", nullptr, 0, 0); }

}  // namespace velour
