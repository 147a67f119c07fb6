#include "btf/fit/fit_checkpoint.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "base/file.h"

namespace velour {
namespace {

constexpr char kKind[] = "velour.kind", kKindOfThis[] = "fit-checkpoint", kKey[] = "velour.checkpoint.key";
constexpr int kWords = 4;  // 16-bit words of a double, which floats represent exactly

void append_words(double number, std::vector<float>& out) {
  const auto bits = std::bit_cast<uint64_t>(number);
  for (int w = 0; w < kWords; ++w) out.push_back(static_cast<float>((bits >> (16 * w)) & 0xffff));
}

std::optional<double> number_of(const float* words) {
  uint64_t bits = 0;
  for (int w = 0; w < kWords; ++w) {
    if (!(words[w] >= 0 && words[w] <= 65535 && words[w] == std::floor(words[w]))) return std::nullopt;
    bits |= static_cast<uint64_t>(words[w]) << (16 * w);
  }
  const auto number = std::bit_cast<double>(bits);
  return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

}  // namespace

std::string side_stage(size_t side) { return "side." + std::to_string(side); }

FitCheckpoint::FitCheckpoint(CheckpointOptions options) : options_(std::move(options)) {
  file_.attributes = {{kKind, kKindOfThis}, {kKey, options_.key}};
  if (options_.resume && !options_.path.empty()) read();
}

void FitCheckpoint::read() {
  if (!std::filesystem::exists(options_.path)) return;
  try {
    TensorFile file = decode_tensors(read_file(options_.path), options_.path);
    if (file.attributes[kKind] != kKindOfThis || file.attributes[kKey] != options_.key) {
      throw Error(Status::bad_data, options_.path + " belongs to a fit of another BTF or with other options.");
    }
    file_ = std::move(file);
  } catch (const Error& error) {
    warnings_.push_back(warning<WarningCode::fit_not_resumed>({{"reason", error.what()}}));
  }
}

const Tensor* FitCheckpoint::find(const std::string& stage) const {
  const auto found = file_.tensors.find(stage);
  return found == file_.tensors.end() ? nullptr : &found->second;
}

std::optional<RowMatrix> FitCheckpoint::matrix(const std::string& stage, Eigen::Index rows,
                                               Eigen::Index columns) const {
  const Tensor* tensor = find(stage);
  const std::vector<uint64_t> shape{static_cast<uint64_t>(rows), static_cast<uint64_t>(columns)};
  if (tensor == nullptr || tensor->shape != shape) return std::nullopt;
  const auto finite = [](float v) { return std::isfinite(v); };
  if (!std::all_of(tensor->data.begin(), tensor->data.end(), finite)) return std::nullopt;
  return Eigen::Map<const RowMatrix>(tensor->data.data(), rows, columns);
}

std::optional<std::vector<double>> FitCheckpoint::numbers(const std::string& stage, size_t most) const {
  const Tensor* tensor = find(stage);
  if (tensor == nullptr || tensor->shape.size() != 2 || tensor->shape[1] != kWords || tensor->shape[0] > most) {
    return std::nullopt;
  }
  std::vector<double> numbers;
  for (const float* words = tensor->data.data(); numbers.size() < tensor->shape[0]; words += kWords) {
    const auto number = number_of(words);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
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

void FitCheckpoint::keep(const std::string& stage, const RowMatrix& matrix) {
  if (options_.path.empty() || matrix.size() == 0) return;
  file_.tensors[stage] = {{static_cast<uint64_t>(matrix.rows()), static_cast<uint64_t>(matrix.cols())},
                          {matrix.data(), matrix.data() + matrix.size()}};
}

void FitCheckpoint::keep_numbers(const std::string& stage, std::span<const double> numbers) {
  if (options_.path.empty() || numbers.empty()) return;
  Tensor& tensor = file_.tensors[stage] = {{numbers.size(), kWords}, {}};
  for (const double n : numbers) append_words(n, tensor.data);
}

void FitCheckpoint::keep_integers(const std::string& stage, const std::vector<size_t>& integers) {
  keep_numbers(stage, std::vector<double>(integers.begin(), integers.end()));
}

void FitCheckpoint::forget(const std::string& prefix) {
  std::erase_if(file_.tensors, [&](const auto& entry) { return entry.first.starts_with(prefix); });
}

void FitCheckpoint::write() {
  if (options_.path.empty() || failed_ || file_.tensors.empty()) return;
  try {
    write_file(options_.path, encode_tensors(file_));
  } catch (const Error& error) {
    failed_ = true;
    warnings_.push_back(warning<WarningCode::checkpoint_not_written>({{"reason", error.what()}}));
  }
}

void FitCheckpoint::remove() {
  std::error_code ignored;  // a missing file counts as removed
  if (!options_.path.empty()) std::filesystem::remove(options_.path, ignored);
}

}  // namespace velour
