#include "render/film.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "job/error.h"

namespace velour {
namespace {

void write_combined(const PixelSum& p, float* out) {
  const float scale = p.camera_rays > 0 ? 1.0f / static_cast<float>(p.camera_rays) : 0.0f;
  out[0] = p.radiance.r * scale;
  out[1] = p.radiance.g * scale;
  out[2] = p.radiance.b * scale;
  out[3] = p.alpha * scale;
}

void write_depth(const PixelSum& p, float* out) { out[0] = p.depth; }

void write_normal(const PixelSum& p, float* out) {
  const float scale = p.camera_rays > 0 ? 1.0f / static_cast<float>(p.camera_rays) : 0.0f;
  for (int c = 0; c < 3; ++c) out[c] = p.normal[c] * scale;
}

void write_count(const PixelSum& p, float* out) { out[0] = static_cast<float>(p.directions); }

struct Pass {
  std::string_view name;
  int channels;
  void (*write)(const PixelSum&, float*);
};

constexpr Pass kPasses[] = {{"Combined", 4, write_combined},
                            {"Depth", 1, write_depth},
                            {"Normal", 3, write_normal},
                            {"Sample Count", 1, write_count}};

const Pass& find_pass(std::string_view name) {
  for (const Pass& pass : kPasses) {
    if (pass.name == name) return pass;
  }
  throw Error(Status::invalid_argument,
              "There is no pass \"" + std::string(name) + "\": Combined, Depth, Normal and Sample Count are.");
}

}  // namespace

void PixelSum::add(const CameraSample& sample) {
  if (camera_rays == 0) depth = sample.depth;
  radiance += sample.radiance;
  alpha += sample.alpha;
  normal += sample.normal;
  luminance[camera_rays % 2] += velour::luminance(sample.radiance);
  ++camera_rays;
  directions += static_cast<uint32_t>(sample.directions);
}

double PixelSum::mean_luminance() const {
  return (static_cast<double>(luminance[0]) + static_cast<double>(luminance[1])) / camera_rays;
}

double PixelSum::variance() const {
  const double odd = camera_rays / 2, even = camera_rays - camera_rays / 2, n = camera_rays;
  const double difference = static_cast<double>(luminance[0]) / even - static_cast<double>(luminance[1]) / odd;
  // E difference^2 = v (1/even + 1/odd) where a half of k rays has variance v / k, and the mean has v / n.
  return difference * difference * even * odd / (n * n);
}

Film::Film(const PixelRect& window) : window_(window) {
  if (window.width() <= 0 || window.height() <= 0) {
    throw Error(Status::invalid_argument, "A picture of " + std::to_string(window.width()) + " x " +
                                              std::to_string(window.height()) + " pixels is empty.");
  }
  pixels_.resize(static_cast<size_t>(window.width()) * static_cast<size_t>(window.height()));
}

void Film::clear() {
  const std::lock_guard lock(mutex_);
  std::fill(pixels_.begin(), pixels_.end(), PixelSum{});
}

namespace {

/// Calls copy(offset of the row in the film, offset in the tile) for every row of `rect`.
template <typename Copy>
void for_rows(const PixelRect& rect, const PixelRect& window, Copy&& copy) {
  for (int y = rect.y0; y < rect.y1; ++y) {
    copy(static_cast<std::ptrdiff_t>(y - window.y0) * window.width() + rect.x0 - window.x0,
         static_cast<std::ptrdiff_t>(y - rect.y0) * rect.width());
  }
}

}  // namespace

void Film::load(const PixelRect& rect, std::span<PixelSum> pixels) const {
  const std::lock_guard lock(mutex_);
  for_rows(rect, window_, [&](std::ptrdiff_t from, std::ptrdiff_t to) {
    std::copy_n(pixels_.begin() + from, rect.width(), pixels.begin() + to);
  });
}

void Film::store(const PixelRect& rect, std::span<const PixelSum> pixels) {
  const std::lock_guard lock(mutex_);
  for_rows(rect, window_, [&](std::ptrdiff_t to, std::ptrdiff_t from) {
    std::copy_n(pixels.begin() + from, rect.width(), pixels_.begin() + to);
  });
}

int Film::channels(std::string_view pass) { return find_pass(pass).channels; }

void Film::read_pass(std::string_view name, std::span<float> pixels) const {
  const Pass& pass = find_pass(name);
  const std::lock_guard lock(mutex_);
  if (pixels.size() != pixels_.size() * static_cast<size_t>(pass.channels)) {
    throw Error(Status::invalid_argument, "Pass \"" + std::string(name) + "\" has " +
                                              std::to_string(pixels_.size() * static_cast<size_t>(pass.channels)) +
                                              " numbers, not " + std::to_string(pixels.size()) + ".");
  }
  float* out = pixels.data();
  for (const PixelSum& pixel : pixels_) {
    pass.write(pixel, out);
    out += pass.channels;
  }
}

void Film::read_over(const Film* coarser, std::span<float> pixels) const {
  if (coarser == nullptr) return read_pass("Combined", pixels);
  const std::lock_guard lock(mutex_), other(coarser->mutex_);
  float* out = pixels.data();
  for (int y = 0; y < height(); ++y) {
    const int row = y * coarser->height() / height() * coarser->width();
    for (int x = 0; x < width(); ++x, out += 4) {
      const PixelSum& own = pixels_[static_cast<size_t>(y * width() + x)];
      const PixelSum& under = coarser->pixels_[static_cast<size_t>(row + x * coarser->width() / width())];
      write_combined(own.camera_rays > 0 ? own : under, out);
    }
  }
}

uint64_t Film::directions() const {
  const std::lock_guard lock(mutex_);
  uint64_t sum = 0;
  for (const PixelSum& p : pixels_) sum += p.directions;
  return sum;
}

double Film::noise() const {
  const std::lock_guard lock(mutex_);
  double variance = 0.0, mean = 0.0;
  for (const PixelSum& p : pixels_) {
    if (p.camera_rays < 2) return 0.0;
    mean += p.mean_luminance();
    variance += p.variance();
  }
  const double count = static_cast<double>(pixels_.size());
  return mean > 0.0 ? std::sqrt(variance / count) / (mean / count) : 0.0;
}

}  // namespace velour
