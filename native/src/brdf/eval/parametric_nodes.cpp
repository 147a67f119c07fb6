#include "brdf/eval/parametric_table.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>
#include "base/parallel.h"
#include "math/sphere/frame.h"
#include "math/srbf/kernel.h"
#include "math/srbf/lobe_tree.h"
#include "math/srbf/warped_mixture.h"

namespace velour {

namespace {

constexpr int kRadiusCells = 64, kSquareCells = 16;

/// Replaces each lobe's part of f cos by the Gaussian of the same mass and mean direction, and merges these until a
/// proposal holds them.
ProposalLobes few_lobes(const WarpedMixture& lobes, const LightPoints& points) {
  GaussianLobes gaussians;
  for (int j = 0; j < lobes.count; ++j) {
    const auto brightness = static_cast<double>(luminance({lobes.r[j], lobes.g[j], lobes.b[j]}));
    double mass = 0;
    Vec3d sum(0);
    for (size_t i = 0; i < points.size(); ++i) {
      if (!(points.weight(i) > 0)) continue;
      const double part = points.weight(i) * brightness * points.kernel(i, j) * points.per_value(i);
      mass += part;
      sum += part * Vec3d(points.light(i));
    }
    if (!(mass > 1e-9 * points.mass())) continue;
    const double bandwidth = gaussian_bandwidth_of_mean(1 - glm::length(sum) / mass);
    gaussians.add({Vec3(glm::normalize(sum)), static_cast<float>(bandwidth),
                   static_cast<float>(mass / kernel_integral(Kernel::gaussian, bandwidth))});
  }
  ProposalLobes few;
  constexpr GaussianLobe kEverywhere{{0, 0, 1}, 0, 1};
  for (const GaussianLobe& lobe : LobeTree(gaussians).cut(kEverywhere, ProposalLobes::kCapacity)) {
    few.lobe[few.count++] = lobe;
  }
  return few;
}

}  // namespace

std::vector<WarpedLobe> lobes_of(const WarpedMixture& m) {
  std::vector<WarpedLobe> lobes;
  for (int j = 0; j < m.count; ++j) {
    lobes.push_back({m.half[j] > 0 ? LobeSpace::half : LobeSpace::light,
                     {m.s_xx[j], m.s_xy[j], m.s_yy[j]},
                     glm::normalize(Vec3d(m.x[j], m.y[j], m.z[j])),
                     m.bandwidth[j],
                     {m.r[j], m.g[j], m.b[j]}});
  }
  return lobes;
}

ParametricNodes::ParametricNodes(const ParametricValues& values)
    : isotropic_(values.isotropic()),
      nodes_(isotropic_, isotropic_ ? kRadiusCells : kSquareCells),
      proposals_(static_cast<size_t>(nodes_.count())),
      matter_(static_cast<size_t>(nodes_.count())) {
  parallel_fill(proposals_.size(), [&](size_t node) { fill_node(values, static_cast<int>(node)); });
}

void ParametricNodes::fill_node(const ParametricValues& values, int node) {
  WarpedMixture m;
  const Vec3 wv = nodes_.view(node);
  values.evaluate(wv, ViewPlace(wv), m);
  const LightPoints points(m);
  matter_[static_cast<size_t>(node)] = lobes_that_matter(m, points);
  proposals_[static_cast<size_t>(node)] = few_lobes(m, points);
}

uint32_t ParametricNodes::matter_between(const ViewPlace& first, const ViewPlace& last) const {
  uint32_t matter = 0;
  for (int node = nodes_.at(first).node[0]; node <= nodes_.at(last).node[1]; ++node) {
    matter |= matter_[static_cast<size_t>(node)];
  }
  return matter;
}

void ParametricNodes::propose(const Vec3& wv, ProposalLobes& lobes) const {
  const ViewPlace place(wv);
  const float c = isotropic_ ? place.cos_phi : 1, s = isotropic_ ? place.sin_phi : 0;
  const Vec3 own(c * wv.x + s * wv.y, c * wv.y - s * wv.x, wv.z);  // in the lobes' frame
  const int node = nodes_.at(place).nearest;
  lobes = proposals_[static_cast<size_t>(node)];
  const Mat3 align = rotation_between(reflected(nodes_.view(node)), reflected(own));
  for (int j = 0; j < lobes.count; ++j) {
    const Vec3 center = align * lobes.lobe[j].center;
    lobes.lobe[j].center = {c * center.x - s * center.y, s * center.x + c * center.y, center.z};
  }
}

namespace {

/// Error from dropping a lobe, relative to the limits of negligible lobes.
struct Loss {
  double albedo = 0, norm = 0, value = 0;

  double most() const { return std::max({albedo, norm, value}); }
  void add(const Loss& other) {
    albedo += other.albedo;
    norm += other.norm;
    value += other.value;
  }
};

double largest_channel(const WarpedMixture& m, int j) {
  return static_cast<double>(std::max({m.r[j], m.g[j], m.b[j]}));
}

Loss loss_of(const WarpedMixture& lobes, int j, const LightPoints& points) {
  const double channel = largest_channel(lobes, j);
  double mass = 0, albedo = 0, norm_sq = 0, lost_sq = 0, most = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    if (!(points.weight(i) > 0)) continue;
    const double part = channel * points.kernel(i, j) * points.per_value(i);
    const double f_cos = points.weight(i) * points.value(i) * static_cast<double>(points.light(i).z);
    mass += points.weight(i);
    albedo += part * points.weight(i);
    norm_sq += f_cos;
    lost_sq += part * part * f_cos;
    most = std::max(most, part);
  }
  if (!(mass > 0)) return {1e30, 1e30, 1e30};
  return {albedo / mass / kIdleAlbedo, std::sqrt(lost_sq / norm_sq) / kIdleNorm, most / kIdleValue};
}

}  // namespace

uint32_t lobes_that_matter(const WarpedMixture& lobes, const LightPoints& points) {
  std::vector<Loss> loss;
  for (int j = 0; j < lobes.count; ++j) loss.push_back(loss_of(lobes, j, points));
  std::vector<size_t> order(loss.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return loss[a].most() < loss[b].most(); });
  uint32_t matter = 0;
  Loss lost;
  for (const size_t j : order) {
    lost.add(loss[j]);
    if (!(lost.most() <= 1)) matter |= uint32_t{1} << j;
  }
  return matter;
}

namespace {

constexpr int kZeniths = 8, kAzimuths = 8;
static_assert(kZeniths * kAzimuths == DirectionBatch::kCapacity);

/// The lobes of `mixture` in their own frame; each lobe and the cosine get the same number of samples.
WarpedMixture evenly_sampled(const WarpedMixture& mixture) {
  WarpedMixture even = mixture;
  even.turn_cos = 1;
  even.turn_sin = 0;
  for (int j = 0; j < even.count; ++j) {
    const double bandwidth = std::max(static_cast<double>(even.bandwidth[j]), kMinMeanBandwidth);
    even.r[j] = even.g[j] = even.b[j] = static_cast<float>(1 / kernel_integral(Kernel::gaussian, bandwidth));
  }
  draw_plain_lobes(even, 1 / static_cast<float>(even.count + 1));
  even.list_all();
  for (int j = 0; j < even.count; ++j) even.r[j] = even.g[j] = even.b[j] = 1;
  return even;
}

}  // namespace

LightPoints::LightPoints(const WarpedMixture& mixture) {
  const WarpedMixture even = evenly_sampled(mixture);
  const auto components = static_cast<float>(even.count + 1);
  for (int component = 0; component <= even.count; ++component) {
    Vec2 u[DirectionBatch::kCapacity];
    for (int i = 0; i < kZeniths; ++i) {
      for (int k = 0; k < kAzimuths; ++k) {
        const float zenith = (static_cast<float>(i) + 0.5f) / kZeniths,
                    azimuth = (static_cast<float>(k) + 0.5f) / kAzimuths;
        u[i * kAzimuths + k] = {(static_cast<float>(component) + zenith) / components, azimuth};
      }
    }
    DirectionBatch samples, above;
    sample_warped(even, u, samples);
    for (int i = 0; i < samples.count; ++i) {
      if (samples.z[i] > 1e-6f) above.push(samples.get(i));
    }
    if (above.count > 0) add(even, above);
  }
  value_.resize(size());
  for (int j = 0; j < mixture.count; ++j) {
    const auto brightness = static_cast<double>(luminance({mixture.r[j], mixture.g[j], mixture.b[j]}));
    for (size_t i = 0; i < size(); ++i) value_[i] += brightness * kernel(i, j);
  }
  for (size_t i = 0; i < size(); ++i) {
    weight_[i] *= value_[i] * static_cast<double>(light_[i].z);
    per_value_.push_back(value_[i] > 0 ? 1 / value_[i] : 0);
    mass_ += weight_[i];
  }
}

void LightPoints::add(const WarpedMixture& even, const DirectionBatch& wl) {
  DirectionBatch padded = wl;
  while (padded.count <= 2) padded.push(wl.get(0));  // eval_warped() ignores the lobe list for one or two directions
  padded.pad();
  RgbBatch f;
  ScalarBatch density;
  eval_warped(even, padded, f, density);
  for (int i = 0; i < wl.count; ++i) {
    light_.push_back(wl.get(i));
    const double samples = static_cast<double>(even.count + 1) * kZeniths * kAzimuths;
    weight_.push_back(1 / (samples * static_cast<double>(density.v[i])));
  }
  WarpedMixture one = even;
  one.listed_count = 1;
  for (uint8_t j = 0; j < even.count; ++j) {
    one.listed = &j;
    eval_warped(one, padded, f);
    for (int i = 0; i < wl.count; ++i) kernel_[j].push_back(f.r[i]);
  }
}

}  // namespace velour
