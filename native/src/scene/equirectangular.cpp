#include "scene/equirectangular.h"

#include <algorithm>
#include <cmath>

namespace velour {
namespace {

float clean(float value) { return std::isfinite(value) ? std::max(value, 0.0f) : 0.0f; }

/// Takes the share of u in [0, 1) that lies below `split` (or above it) back to [0, 1): one number chooses twice.
bool choose_second(float split, float& u) {
  const bool second = u >= split;
  u = second ? (u - split) / (1.0f - split) : u / split;
  u = std::min(u, 0x1.fffffep-1f);
  return second;
}

}  // namespace

EquirectangularImage::EquirectangularImage(const EquirectangularPixels& pixels, float strength,
                                           const Mat3& world_to_image)
    : width_(pixels.width),
      height_(pixels.height),
      stride_(static_cast<size_t>(pixels.width) + 2),
      world_to_image_(world_to_image) {
  store_texels(pixels, strength);
  build_tables();
}

void EquirectangularImage::store_texels(const EquirectangularPixels& pixels, float strength) {
  texels_.resize(stride_ * static_cast<size_t>(height_));
  const int g = pixels.channels >= 3 ? 1 : 0, b = pixels.channels >= 3 ? 2 : 0;
  const float* in = pixels.values.data();
  for (int y = 0; y < height_; ++y) {
    EnvironmentTexel* out = &texels_[static_cast<size_t>(y) * stride_];
    const float sin_theta = static_cast<float>(std::sin(kPiD * (y + 0.5) / height_));
    for (int x = 0; x < width_; ++x, in += pixels.channels) {
      const Rgb c(clean(strength * in[0]), clean(strength * in[g]), clean(strength * in[b]));
      out[x + 1] = {c.r, c.g, c.b, luminance(c) * sin_theta};
    }
    out[0] = out[width_];
    out[width_ + 1] = out[1];
  }
}

void EquirectangularImage::build_tables() {
  const size_t w = static_cast<size_t>(width_), h = static_cast<size_t>(height_);
  row_cdf_.resize(h * (w + 1));
  row_guide_.resize(h * w);
  std::vector<double> row_mean(h), mass(w);
  for (size_t y = 0; y < h; ++y) {
    const EnvironmentTexel* t = row(static_cast<int>(y));
    for (size_t x = 0; x < w; ++x) mass[x] = 0.5 * (static_cast<double>(t[x].node) + t[x + 1].node);
    row_mean[y] = build_cells(mass, &row_cdf_[y * (w + 1)], &row_guide_[y * w]) / static_cast<double>(w);
  }
  row_node_.assign(row_mean.begin(), row_mean.end());

  std::vector<double> bands(h + 1);
  bands.front() = 0.25 * row_mean.front();  // half a row, from 0 at the pole
  bands.back() = 0.25 * row_mean.back();
  for (size_t y = 1; y < h; ++y) bands[y] = 0.5 * (row_mean[y - 1] + row_mean[y]);
  marginal_cdf_.resize(h + 2);
  marginal_guide_.resize(h + 1);
  const double total = build_cells(bands, marginal_cdf_.data(), marginal_guide_.data()) / static_cast<double>(h);
  // d omega = 2 pi^2 sin(theta) du dv, so the integral of luminance over the sphere is 2 pi^2 total.
  mean_luminance_ = static_cast<float>(0.5 * kPiD * total);
  density_scale_ = total > 0.0 ? static_cast<float>(1.0 / (2.0 * kPiD * kPiD * total)) : 0.0f;
}

void EquirectangularImage::look_up(const DirectionBatch& world, RgbBatch& radiance, ScalarBatch& pdf) const {
  equirectangular_look_up(*this, world, radiance, pdf);
}

/// A row, the place between it and its neighbour, and what is left of the random number for its columns.
struct EquirectangularImage::RowDraw {
  size_t row;
  float v;
  float u;
};

EquirectangularImage::RowDraw EquirectangularImage::draw_row(const Vec2& u) const {
  // A band between two rows, the place in it, then one of the two rows in proportion to its share there: together the
  // bilinear density, each part inverted in closed form.
  const int band = find_cell(marginal_cdf_.data(), marginal_guide_[guide_place(u.y, height_ + 1)], height_ + 1, u.y);
  const float* edge = &marginal_cdf_[static_cast<size_t>(band)];
  const float in_band = std::clamp((u.y - edge[0]) / std::max(edge[1] - edge[0], 1e-30f), 0.0f, 1.0f);
  const float above = band > 0 ? row_node_[static_cast<size_t>(band) - 1] : 0.0f;
  const float below = band < height_ ? row_node_[static_cast<size_t>(band)] : 0.0f;
  const float t = invert_linear(above, below, in_band);

  RowDraw draw{0, static_cast<float>(band) - 0.5f + t, u.x};
  // The bands at the poles are half as high.
  if (band == 0) draw.v = 0.5f * t;
  if (band == height_) draw.v = static_cast<float>(height_) - 0.5f + 0.5f * t;
  const float share_above = (1.0f - t) * above, share_below = t * below;
  const bool lower = choose_second(share_above / std::max(share_above + share_below, 1e-30f), draw.u);
  draw.row = static_cast<size_t>(std::clamp(lower ? band : band - 1, 0, height_ - 1));
  return draw;
}

float EquirectangularImage::draw_column(const RowDraw& draw, int first) const {
  const float* cdf = &row_cdf_[draw.row * (static_cast<size_t>(width_) + 1)];
  const int cell = find_cell(cdf, first, width_, draw.u);
  const float in_cell = std::clamp((draw.u - cdf[cell]) / std::max(cdf[cell + 1] - cdf[cell], 1e-30f), 0.0f, 1.0f);
  const EnvironmentTexel* texel = row(static_cast<int>(draw.row)) + cell;
  return static_cast<float>(cell) - 0.5f + invert_linear(texel[0].node, texel[1].node, in_cell);
}

// Three passes, each of which calls for the memory of the next: tables and texels of a large image are in no near
// cache, and their latency is paid once instead of once a direction.
void EquirectangularImage::sample(std::span<const Vec2> u, DirectionBatch& world) const {
  const int count = static_cast<int>(u.size());
  RowDraw draws[DirectionBatch::kCapacity];
  int first_cell[DirectionBatch::kCapacity];
  const size_t w = static_cast<size_t>(width_);
  for (int i = 0; i < count; ++i) {
    draws[i] = draw_row(u[static_cast<size_t>(i)]);
    __builtin_prefetch(&row_guide_[draws[i].row * w + guide_place(draws[i].u, width_)]);
  }
  for (int i = 0; i < count; ++i) {
    const RowDraw& draw = draws[i];
    const int cell = first_cell[i] = row_guide_[draw.row * w + guide_place(draw.u, width_)];
    __builtin_prefetch(&row_cdf_[draw.row * (w + 1) + static_cast<size_t>(cell)]);
    __builtin_prefetch(row(static_cast<int>(draw.row)) + cell);
  }
  ScalarBatch column, line;
  for (int i = 0; i < count; ++i) {
    column.v[i] = draw_column(draws[i], first_cell[i]) / static_cast<float>(width_);
    line.v[i] = draws[i].v / static_cast<float>(height_);
  }
  for (int i = count; i % 16 != 0; ++i) column.v[i] = line.v[i] = 0.5f;
  equirectangular_directions(*this, column, line, count, world);
  world.count = count;
  world.pad();
}

uint64_t EquirectangularImage::bytes() const {
  return texels_.size() * sizeof(EnvironmentTexel) +
         (row_node_.size() + marginal_cdf_.size() + row_cdf_.size()) * sizeof(float) +
         (marginal_guide_.size() + row_guide_.size()) * sizeof(uint16_t);
}

}  // namespace velour
