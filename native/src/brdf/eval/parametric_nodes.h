// A parametric model at evenly spread views: which of its lobes matter, and a few Gaussians that resemble f cos.
#pragma once

#include <cstdint>
#include <span>
#include <vector>
#include "brdf/eval/parametric_values.h"
#include "brdf/eval/view_nodes.h"
#include "math/srbf/lobe_products.h"
#include "math/srbf/warped_lobe.h"
#include "math/srbf/warped_mixture.h"

namespace velour {

// Quadrature over light directions adapted to a mixture of warped lobes.

/// Stratified samples of every lobe and of the cosine, in the lobes' frame, with each lobe's kernel at each sample.
/// Accurate to a few per cent.
class LightPoints {
 public:
  /// Uses only the value of `mixture`, not its density.
  explicit LightPoints(const WarpedMixture& mixture);

  size_t size() const { return light_.size(); }
  /// The integral of the luminance of f cos over the hemisphere.
  double mass() const { return mass_; }
  const Vec3& light(size_t i) const { return light_[i]; }
  double value(size_t i) const { return value_[i]; }          // luminance of f
  double per_value(size_t i) const { return per_value_[i]; }  // 1 / value; 0 where that is 0
  double weight(size_t i) const { return weight_[i]; }        // part of the mass
  double kernel(size_t i, int lobe) const { return static_cast<double>(kernel_[lobe][i]); }

 private:
  void add(const WarpedMixture& even, const DirectionBatch& wl);

  std::vector<Vec3> light_;
  std::vector<double> value_, per_value_, weight_;
  double mass_ = 0;
  std::vector<float> kernel_[WarpedMixture::kCapacity];  // peak 1
};

/// The lobes of a mixture's value as WarpedLobes, in the mixture's frame.
std::vector<WarpedLobe> lobes_of(const WarpedMixture& mixture);

/// Immutable; thread-safe; no allocation after construction.
class ParametricNodes {
 public:
  explicit ParametricNodes(const ParametricValues& values);

  /// Gaussians over light directions that approximate f cos at `wv`, in the surface's frame. They match the moments of
  /// each lobe's part at the nearest node, are merged to a few, and rotate with the view's mirror direction.
  void propose(const Vec3& wv, ProposalLobes& lobes) const;

  /// Bit mask of the lobes that matter at any node from the one before `first` to the one after `last`,
  /// on a meridian of an isotropic model.
  uint32_t matter_between(const ViewPlace& first, const ViewPlace& last) const;

 private:
  void fill_node(const ParametricValues& values, int node);

  bool isotropic_;
  ViewNodes nodes_;
  std::vector<ProposalLobes> proposals_;  // per node, in the lobes' frame
  std::vector<uint32_t> matter_;          // per node
};

// Finds lobes that are negligible at a view.

/// Limits for all lobes dropped at a view together, as fractions of the albedo, of the L2 norm of f cos, and of f
/// itself at every light direction.
inline constexpr double kIdleAlbedo = 1e-3, kIdleNorm = 1e-3, kIdleValue = 1e-2;

/// Bit mask of the lobes to keep, up to 32, judged at `points`, the quadrature of `lobes` at the view. Lobes are
/// dropped in order of increasing loss, which compares a lobe's largest channel with the luminance of all lobes, until
/// the next one would exceed these limits.
uint32_t lobes_that_matter(const WarpedMixture& lobes, const LightPoints& points);

}  // namespace velour
