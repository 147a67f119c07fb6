#include "render/film/noise_target.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "denoise/denoiser.h"

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
  if (!std::isfinite(variance) || !std::isfinite(scale_sq)) return std::numeric_limits<double>::infinity();
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

namespace {

// Growth factors of the camera rays between decisions; a decision costs as much as about ten of them.
constexpr double kMinGrowth = 1.25, kMaxGrowth = 4;

}  // namespace

void DenoisedTarget::decide(Film& film, const Progress& progress) {
  denoise(film, threads_, progress);
  const std::optional<DenoisedError> error = film.denoised_error();
  const double excess = error ? error->bound() / (target_ * target_) : kMaxGrowth;
  done_ = excess <= 1;
  const double rays = next_ * std::clamp(excess, kMinGrowth, kMaxGrowth);
  next_ = 2 * static_cast<int>(std::ceil(rays / 2));  // both halves have the same number
}

namespace {

constexpr size_t kOfHalf = 9;  // floats per pixel of "Halves": color, albedo, normal

/// 3 floats per pixel each.
struct Pictures {
  explicit Pictures(size_t pixels) : color(3 * pixels), albedo(3 * pixels), normal(3 * pixels) {}
  std::vector<float> color, albedo, normal;

  void set(size_t pixel, const float* half) {
    std::copy_n(half, 3, &color[3 * pixel]);
    std::copy_n(half + 3, 3, &albedo[3 * pixel]);
    std::copy_n(half + 6, 3, &normal[3 * pixel]);
  }
  NoisyPicture of(const Film& film) const { return {film.width(), film.height(), color, albedo, normal}; }
};

struct Halves {
  explicit Halves(const Film& film)
      : camera_rays(static_cast<size_t>(film.width()) * static_cast<size_t>(film.height())),
        half{Pictures(camera_rays.size()), Pictures(camera_rays.size())} {
    std::vector<PixelSum> sums(camera_rays.size());
    film.load(film.window(), sums);
    std::ranges::transform(sums, camera_rays.begin(), &PixelSum::camera_rays);
    std::vector<float> values(2 * kOfHalf * camera_rays.size());
    film.read_pass("Halves", values);
    for (size_t i = 0; i < camera_rays.size(); ++i) {
      for (size_t h = 0; h < 2; ++h) half[h].set(i, &values[(2 * i + h) * kOfHalf]);
    }
  }

  /// Images of all camera rays: the mean of both halves, weighted by their numbers of rays.
  Pictures whole() const {
    Pictures mean = half[0];
    const auto join = [&](std::vector<float>& first, const std::vector<float>& second) {
      for (size_t i = 0; i < first.size(); ++i) {
        const uint32_t rays = camera_rays[i / 3];
        const float share = rays > 0 ? static_cast<float>(rays / 2) / static_cast<float>(rays) : 0.0f;
        first[i] += share * (second[i] - first[i]);
      }
    };
    join(mean.color, half[1].color);
    join(mean.albedo, half[1].albedo);
    join(mean.normal, half[1].normal);
    return mean;
  }

  std::vector<uint32_t> camera_rays;
  Pictures half[2];
};

std::vector<float> denoised(Denoiser& denoiser, const Film& film, const Pictures& pictures, const Progress& progress) {
  std::vector<float> colors(pictures.color.size());
  denoiser.run(pictures.of(film), colors, progress);
  return colors;
}

}  // namespace

std::vector<float> denoised_colors(const Film& film, int threads, const Progress& progress) {
  Denoiser denoiser(threads, Denoiser::Effort::least);
  return denoised(denoiser, film, Halves(film).whole(), progress);
}

void denoise(Film& film, int threads, const Progress& progress) {
  if (film.is_denoised()) return;
  const Halves halves(film);
  Denoiser denoiser(threads);
  const auto colors_of = [&](const Pictures& pictures) { return denoised(denoiser, film, pictures, progress); };
  if (std::ranges::min(halves.camera_rays) < 2) return film.keep_denoised(colors_of(halves.whole()), std::nullopt);
  const std::vector<float> first = colors_of(halves.half[0]), second = colors_of(halves.half[1]);
  std::vector<float> picture(first.size());
  const DenoisedError error =
      combine({{halves.half[0].color, halves.half[1].color}, {first, second}, halves.camera_rays}, picture);
  film.keep_denoised(std::move(picture), error);
}

}  // namespace velour
