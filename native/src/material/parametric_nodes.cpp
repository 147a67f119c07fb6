#include "material/parametric_nodes.h"

#include <cmath>

#include "job/parallel.h"
#include "material/idle_lobes.h"
#include "sphere/frame.h"
#include "srbf/kernel.h"
#include "srbf/lobe_tree.h"

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

Vec3 mirror(const Vec3& w) { return {-w.x, -w.y, w.z}; }

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
  const Mat3 align = rotation_between(mirror(nodes_.view(node)), mirror(own));
  for (int j = 0; j < lobes.count; ++j) {
    const Vec3 center = align * lobes.lobe[j].center;
    lobes.lobe[j].center = {c * center.x - s * center.y, s * center.x + c * center.y, center.z};
  }
}

}  // namespace velour
