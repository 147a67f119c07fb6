#include "light/equirectangular.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace velour {

EquirectangularImage::EquirectangularImage(const EquirectangularPixels& pixels)
    : width_(pixels.width),
      height_(pixels.height),
      stride_(static_cast<size_t>(pixels.width) + 2),
      faults_(find_value_faults(pixels.values, static_cast<size_t>(pixels.channels), pixels.channels >= 3 ? 3 : 1)) {
  const size_t w = static_cast<size_t>(width_), h = static_cast<size_t>(height_);
  texels_.resize(stride_ * h);
  row_cdf_.resize(h * (w + 1));
  row_guide_.resize(h * w);
  row_node_.assign(h + 2, 0.0f);
  std::vector<double> mean(h);
  parallel_pieces(h, 0, Progress(), [&](size_t y) {
    store_row(pixels, static_cast<int>(y));
    mean[y] = build_row(static_cast<int>(y));
  });
  build_marginal(mean);
}

void EquirectangularImage::store_row(const EquirectangularPixels& pixels, int y) {
  const int g = pixels.channels >= 3 ? 1 : 0, b = pixels.channels >= 3 ? 2 : 0;
  const auto stored = static_cast<size_t>(pixels.bottom_up ? height_ - 1 - y : y);
  const float* in = pixels.values.data() + stored * static_cast<size_t>(width_) * static_cast<size_t>(pixels.channels);
  EnvironmentTexel* out = &texels_[static_cast<size_t>(y) * stride_];
  const float sin_theta = static_cast<float>(std::sin(kPiD * (y + 0.5) / height_));
  for (int x = 0; x < width_; ++x, in += pixels.channels) {
    const auto light = [&](float v) { return std::max(faults_.finite(v), 0.0f); };
    const Rgb c(light(in[0]), light(in[g]), light(in[b]));
    out[x + 1] = {c.r, c.g, c.b, luminance(c) * sin_theta};
  }
  out[0] = out[width_];
  out[width_ + 1] = out[1];
}

double EquirectangularImage::build_row(int y) {
  const auto w = static_cast<size_t>(width_), at = static_cast<size_t>(y);
  const EnvironmentTexel* t = row(y);
  std::vector<double> mass(w);
  for (size_t x = 0; x < w; ++x) mass[x] = 0.5 * (static_cast<double>(t[x].node) + t[x + 1].node);
  return build_cells(mass, &row_cdf_[at * (w + 1)], &row_guide_[at * w]) / static_cast<double>(w);
}

void EquirectangularImage::build_marginal(const std::vector<double>& mean) {
  const size_t h = mean.size();
  std::copy(mean.begin(), mean.end(), row_node_.begin() + 1);
  std::vector<double> bands(h + 1);
  bands.front() = 0.25 * mean.front();  // half a row high, with density 0 at the pole
  bands.back() = 0.25 * mean.back();
  for (size_t y = 1; y < h; ++y) bands[y] = 0.5 * (mean[y - 1] + mean[y]);
  marginal_cdf_.resize(h + 2);
  marginal_guide_.resize(h + 1);
  const double total = build_cells(bands, marginal_cdf_.data(), marginal_guide_.data()) / static_cast<double>(h);
  // d omega = 2 pi^2 sin(theta) du dv, so the integral of luminance over the sphere is 2 pi^2 total.
  mean_luminance_ = static_cast<float>(0.5 * kPiD * total);
  density_scale_ = total > 0.0 ? static_cast<float>(1.0 / (2.0 * kPiD * kPiD * total)) : 0.0f;
}

void EquirectangularImage::look_up(const EnvironmentPlacement& placement, const DirectionBatch& world,
                                   RgbBatch& radiance, ScalarBatch& pdf) const {
  equirectangular_look_up(*this, placement, world, radiance, pdf);
}

/// Finds the column's cell and stores what draw_columns reads.
void EquirectangularImage::find_column(EquirectangularDraws& draws, int i, int first) const {
  const auto y = static_cast<size_t>(draws.row[i]);
  const float* cdf = &row_cdf_[y * (static_cast<size_t>(width_) + 1)];
  const int cell = find_cell(cdf, first, width_, draws.u[i]);
  const EnvironmentTexel* texel = row(draws.row[i]) + cell;
  draws.cell[i] = static_cast<float>(cell);
  draws.low[i] = cdf[cell];
  draws.high[i] = cdf[cell + 1];
  draws.left[i] = texel[0].node;
  draws.right[i] = texel[1].node;
}

// Each pass prefetches the memory of the next: the tables and texels of a large image exceed the near caches, and their
// latency is then paid once instead of once per direction.
void EquirectangularImage::sample(const EnvironmentPlacement& placement, std::span<const Vec2> u,
                                  DirectionBatch& world) const {
  const int count = static_cast<int>(u.size()), padded = (count + 15) / 16 * 16;
  EquirectangularDraws draws;
  for (int i = 0; i < padded; ++i) {
    const Vec2 at = i < count ? u[static_cast<size_t>(i)] : Vec2(0.5f);
    draws.u[i] = at.x;
    draws.v[i] = at.y;
  }
  draw_rows({height_, marginal_cdf_.data(), marginal_guide_.data(), row_node_.data()}, draws, padded);
  const uint16_t* guide[DirectionBatch::kCapacity];
  for (int i = 0; i < padded; ++i) {
    guide[i] = &row_guide_[static_cast<size_t>(draws.row[i]) * static_cast<size_t>(width_)];
    __builtin_prefetch(guide[i] += guide_place(draws.u[i], width_));
  }
  for (int i = 0; i < padded; ++i) {
    __builtin_prefetch(&row_cdf_[static_cast<size_t>(draws.row[i]) * (static_cast<size_t>(width_) + 1) + *guide[i]]);
    __builtin_prefetch(row(draws.row[i]) + *guide[i]);
  }
  for (int i = 0; i < padded; ++i) find_column(draws, i, *guide[i]);
  draw_columns(width_, draws, padded);
  equirectangular_directions(placement.world_to_image, draws.u, draws.v, count, world);
  world.count = count;
  world.pad();
}

uint64_t EquirectangularImage::bytes() const {
  return texels_.size() * sizeof(EnvironmentTexel) +
         (row_node_.size() + marginal_cdf_.size() + row_cdf_.size()) * sizeof(float) +
         marginal_guide_.size() * sizeof(int32_t) + row_guide_.size() * sizeof(uint16_t);
}

}  // namespace velour
