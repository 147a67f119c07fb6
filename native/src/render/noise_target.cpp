#include "render/noise_target.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace velour {
namespace {

constexpr int kBlockSize = 16;

/// Boundaries that cut the pixels [begin, end) into equal parts as close to kBlockSize as possible.
std::vector<int> cuts(int begin, int end) {
  const int side = end - begin;
  const int parts = std::max(1, (side + kBlockSize / 2) / kBlockSize);
  std::vector<int> at;
  for (int i = 0; i <= parts; ++i) at.push_back(begin + static_cast<int>(static_cast<int64_t>(side) * i / parts));
  return at;
}

double mean_luminance(std::span<const BlockError> errors, std::span<const PixelRect> blocks) {
  double sum = 0.0, pixels = 0.0;
  for (size_t b = 0; b < blocks.size(); ++b) {
    const double count = static_cast<double>(blocks[b].width()) * blocks[b].height();
    sum += count * errors[b].luminance;
    pixels += count;
  }
  return sum / pixels;
}

}  // namespace

std::vector<PixelRect> blocks_of(const PixelRect& picture) {
  const std::vector<int> x = cuts(picture.x0, picture.x1), y = cuts(picture.y0, picture.y1);
  std::vector<PixelRect> blocks;
  for (size_t j = 0; j + 1 < y.size(); ++j) {
    for (size_t i = 0; i + 1 < x.size(); ++i) blocks.push_back({x[i], y[j], x[i + 1], y[j + 1]});
  }
  return blocks;
}

double BlockError::relative_to(double picture_luminance) const {
  const double scale_sq = luminance * luminance + 0.01 * picture_luminance * picture_luminance;
  return scale_sq > 0.0 ? std::sqrt(variance / scale_sq) : 0.0;
}

BlockError block_error(std::span<const PixelSum> pixels) {
  BlockError error;
  error.known = true;
  for (const PixelSum& pixel : pixels) {
    if (pixel.camera_rays < 2) return {};
    error.luminance += pixel.mean_luminance();
    error.variance += pixel.variance();
  }
  error.luminance /= static_cast<double>(pixels.size());
  error.variance /= static_cast<double>(pixels.size());
  return error;
}

NoiseTarget::NoiseTarget(double target, std::vector<PixelRect> blocks) : target_(target), blocks_(std::move(blocks)) {
  for (size_t b = 0; b < blocks_.size(); ++b) active_.push_back(b);
  passed_.resize(blocks_.size());
}

std::vector<BlockError> NoiseTarget::errors(const Film& film) const {
  std::vector<BlockError> errors;
  std::vector<PixelSum> pixels;
  for (const PixelRect& block : blocks_) {
    pixels.resize(static_cast<size_t>(block.width()) * static_cast<size_t>(block.height()));
    film.load(block, pixels);
    errors.push_back(block_error(pixels));
  }
  return errors;
}

void NoiseTarget::decide(const Film& film) {
  // Grows by a quarter: two successive estimates that share most of their samples would count as one.
  next_ += std::max(kRaysAtLeast, next_ / 4 / kRaysAtLeast * kRaysAtLeast);
  const auto all = errors(film);
  const double luminance = mean_luminance(all, blocks_);
  std::erase_if(active_, [&](size_t b) {
    const bool passes = all[b].known && all[b].relative_to(luminance) <= target_;
    const bool done = passes && passed_[b];
    passed_[b] = passes;
    return done;
  });
}

double NoiseTarget::worst(const Film& film) const {
  const auto all = errors(film);
  const double luminance = mean_luminance(all, blocks_);
  double worst = 0.0;
  for (const BlockError& error : all) worst = std::max(worst, error.relative_to(luminance));
  return worst;
}

}  // namespace velour
