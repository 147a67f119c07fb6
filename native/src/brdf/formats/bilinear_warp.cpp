#include "brdf/formats/bilinear_warp.h"

#include <algorithm>
#include <cmath>

namespace velour {
namespace {

/// Integral over [0, t] of a function that is linear from a to b over [0, 1].
float ramp_integral(float a, float b, float t) { return t * (a + 0.5f * t * (b - a)); }

/// t with ramp_integral(a, b, t) = `area`: the form of the quadratic's root that is stable for a = b.
float ramp_inverse(float a, float b, float area) {
  const float root = std::sqrt(std::max(0.0f, a * a + 2.0f * area * (b - a)));
  return a + root > 0.0f ? std::clamp(2.0f * area / (a + root), 0.0f, 1.0f) : 0.0f;
}

}  // namespace

BilinearWarp::BilinearWarp(std::span<const float> values, uint32_t width, uint32_t height)
    : width_(width), height_(height), nodes_(values.size()), rows_below_(values.size() / width) {
  const size_t slice_size = static_cast<size_t>(width) * height;
  for (size_t slice = 0; slice * slice_size < values.size(); ++slice)
    build_slice(values.subspan(slice * slice_size, slice_size), static_cast<uint32_t>(slice));
}

void BilinearWarp::build_slice(std::span<const float> values, uint32_t slice) {
  Node* nodes = nodes_.data() + static_cast<size_t>(slice) * values.size();
  float* below = rows_below_.data() + static_cast<size_t>(slice) * height_;
  std::vector<double> running(values.size());
  double total = 0.0, previous = 0.0;
  for (size_t y = 0; y < height_; ++y) {
    for (size_t x = 1; x < width_; ++x) {
      const size_t i = y * width_ + x;
      running[i] = running[i - 1] + 0.5 * (double{values[i - 1]} + double{values[i]});
    }
    const double row = running[y * width_ + width_ - 1];
    if (y > 0) total += 0.5 * (previous + row);
    previous = row;
  }
  const double scale = total > 0.0 ? 1.0 / total : 0.0;
  for (size_t i = 0; i < values.size(); ++i)
    nodes[i] = {static_cast<float>(scale * values[i]), static_cast<float>(scale * running[i])};
  double sum = 0.0;
  for (size_t y = 1; y < height_; ++y) {
    sum += 0.5 * scale * (running[y * width_ - 1] + running[(y + 1) * width_ - 1]);
    below[y] = static_cast<float>(sum);
  }
}

float BilinearWarp::row_sum(const SliceMix& mix, uint32_t y) const {
  float sum = 0.0f;
  for (size_t s = 0; s < static_cast<size_t>(mix.count); ++s)
    sum += mix.weight[s] * node(mix.slice[s], y, width_ - 1).running;
  return sum;
}

float BilinearWarp::rows_below(const SliceMix& mix, uint32_t y) const {
  float sum = 0.0f;
  for (size_t s = 0; s < static_cast<size_t>(mix.count); ++s)
    sum += mix.weight[s] * rows_below_[static_cast<size_t>(mix.slice[s]) * height_ + y];
  return sum;
}

bool BilinearWarp::invert(const SliceMix& mix, const Vec2& position, Vec2& u) const {
  const AxisCell x = axis_cell(position.x, width_), y = axis_cell(position.y, height_);
  float left = 0.0f, right = 0.0f, before = 0.0f, row_low = 0.0f, row_high = 0.0f, below = 0.0f;
  for (size_t s = 0; s < static_cast<size_t>(mix.count); ++s) {
    const Node* low = &node(mix.slice[s], y.low, 0);
    const Node* high = low + width_;
    const float w_high = mix.weight[s] * y.t, w_low = mix.weight[s] - w_high;
    left += w_low * low[x.low].density + w_high * high[x.low].density;
    right += w_low * low[x.low + 1].density + w_high * high[x.low + 1].density;
    before += w_low * low[x.low].running + w_high * high[x.low].running;
    row_low += mix.weight[s] * low[width_ - 1].running;
    row_high += mix.weight[s] * high[width_ - 1].running;
    below += mix.weight[s] * rows_below_[static_cast<size_t>(mix.slice[s]) * height_ + y.low];
  }
  const float row = row_low + y.t * (row_high - row_low);
  if (!(row > 0.0f)) return false;
  u = {std::min((before + ramp_integral(left, right, x.t)) / row, 1.0f),
       std::min(below + ramp_integral(row_low, row_high, y.t), 1.0f)};
  return true;
}

Vec2 BilinearWarp::warp(const SliceMix& mix, const Vec2& u) const {
  uint32_t y = 0;
  while (y + 2 < height_ && rows_below(mix, y + 1) <= u.y) ++y;
  const float row_low = row_sum(mix, y), row_high = row_sum(mix, y + 1);
  const float t_y = ramp_inverse(row_low, row_high, u.y - rows_below(mix, y));

  const auto along = [&](uint32_t x, float Node::*member) {
    float sum = 0.0f;
    for (size_t s = 0; s < static_cast<size_t>(mix.count); ++s)
      sum += mix.weight[s] *
             ((1.0f - t_y) * node(mix.slice[s], y, x).*member + t_y * node(mix.slice[s], y + 1, x).*member);
    return sum;
  };
  const float target = u.x * along(width_ - 1, &Node::running);
  uint32_t x = 0;
  while (x + 2 < width_ && along(x + 1, &Node::running) <= target) ++x;
  const float t_x =
      ramp_inverse(along(x, &Node::density), along(x + 1, &Node::density), target - along(x, &Node::running));
  return {(static_cast<float>(x) + t_x) / static_cast<float>(width_ - 1),
          (static_cast<float>(y) + t_y) / static_cast<float>(height_ - 1)};
}

}  // namespace velour
