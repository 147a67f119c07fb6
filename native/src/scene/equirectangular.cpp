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
  EquirectangularCoordinates at;
  equirectangular_coordinates(*this, world, at);
  for (int i = 0; i < world.count; ++i) {
    const EnvironmentTexel* above = row(std::max(at.y[i] - 1, 0)) + at.x[i];
    const EnvironmentTexel* below = row(std::min(at.y[i], height_ - 1)) + at.x[i];
    const float w11 = at.fx[i] * at.fy[i], w01 = at.fx[i] - w11, w10 = at.fy[i] - w11, w00 = 1.0f - at.fx[i] - w10;
    const auto blend = [&](float EnvironmentTexel::*c) {
      return w00 * (above[0].*c) + w01 * (above[1].*c) + w10 * (below[0].*c) + w11 * (below[1].*c);
    };
    radiance.r[i] = blend(&EnvironmentTexel::r);
    radiance.g[i] = blend(&EnvironmentTexel::g);
    radiance.b[i] = blend(&EnvironmentTexel::b);
    pdf.v[i] = blend(&EnvironmentTexel::node) * at.pole[i] * at.inverse_sin[i] * density_scale_;
  }
}

Vec3 EquirectangularImage::sample(const Vec2& u) const {
  // A band between two rows, the place in it, then one of the two rows in proportion to its share there: together the
  // bilinear density, each part inverted in closed form.
  const int band = find_cell(marginal_cdf_.data(), marginal_guide_.data(), height_ + 1, u.y);
  const float* edge = &marginal_cdf_[static_cast<size_t>(band)];
  const float in_band = std::clamp((u.y - edge[0]) / std::max(edge[1] - edge[0], 1e-30f), 0.0f, 1.0f);
  const float above = band > 0 ? row_node_[static_cast<size_t>(band) - 1] : 0.0f;
  const float below = band < height_ ? row_node_[static_cast<size_t>(band)] : 0.0f;
  const float t = invert_linear(above, below, in_band);

  float ux = u.x;
  const float share_above = (1.0f - t) * above, share_below = t * below;
  const bool lower = choose_second(share_above / std::max(share_above + share_below, 1e-30f), ux);
  const size_t y = static_cast<size_t>(std::clamp(lower ? band : band - 1, 0, height_ - 1));
  const size_t w = static_cast<size_t>(width_);
  const float* cdf = &row_cdf_[y * (w + 1)];
  const int cell = find_cell(cdf, &row_guide_[y * w], width_, ux);
  const float in_cell = std::clamp((ux - cdf[cell]) / std::max(cdf[cell + 1] - cdf[cell], 1e-30f), 0.0f, 1.0f);
  const EnvironmentTexel* texel = row(static_cast<int>(y)) + cell;
  const float x = static_cast<float>(cell) - 0.5f + invert_linear(texel[0].node, texel[1].node, in_cell);

  // The bands at the poles are half as high.
  float v = static_cast<float>(band) - 0.5f + t;
  if (band == 0) v = 0.5f * t;
  if (band == height_) v = static_cast<float>(height_) - 0.5f + 0.5f * t;
  return direction(x, v);
}

Vec3 EquirectangularImage::direction(float x, float y) const {
  const float phi = 2.0f * kPi * (0.5f - x / static_cast<float>(width_));
  const float theta = kPi * y / static_cast<float>(height_);
  const float sin_theta = std::sin(theta);
  return glm::transpose(world_to_image_) * Vec3(sin_theta * std::cos(phi), sin_theta * std::sin(phi), std::cos(theta));
}

uint64_t EquirectangularImage::bytes() const {
  return texels_.size() * sizeof(EnvironmentTexel) +
         (row_node_.size() + marginal_cdf_.size() + row_cdf_.size()) * sizeof(float) +
         (marginal_guide_.size() + row_guide_.size()) * sizeof(uint32_t);
}

}  // namespace velour
