// A quadrature over light directions that suits a mixture of warped lobes.
#pragma once

#include <span>
#include <vector>

#include "srbf/warped_lobe.h"

namespace velour {

/// A lobe as a component of the density. Its parameterisation stays that of f.
struct DrawnLobe {
  double probability;
  Vec3d center;  // of a Gaussian over psi
  double bandwidth;
  Vec3d light_center;  // of the Gaussian over light directions that has the same mean
  double light_bandwidth;
};

/// Evenly spread draws of every lobe and of the cosine, and what each lobe sees of them. Good to a few per cent.
class LightPoints {
 public:
  /// `drawn` are the lobes that are drawn from, in the parameterisations of `lobes`.
  LightPoints(std::span<const WarpedLobe> lobes, std::span<const DrawnLobe> drawn, const Vec3d& wv);

  size_t size() const { return light_.size(); }
  /// The integral of the luminance of f cos over the hemisphere.
  double mass() const;
  const Vec3d& light(size_t i) const { return light_[i]; }
  double value(size_t i) const { return value_[i]; }    // luminance of f
  double weight(size_t i) const { return weight_[i]; }  // part of the mass
  const Vec3d& psi(size_t i, size_t lobe) const { return psi_[i * lobes_ + lobe]; }
  double jacobian(size_t i, size_t lobe) const { return jacobian_[i * lobes_ + lobe]; }

 private:
  size_t lobes_;
  std::vector<Vec3d> light_, psi_;
  std::vector<double> value_, weight_, jacobian_;
};

/// The lobes of f as they are, within the bandwidths that draws may have.
std::vector<DrawnLobe> drawn_as_they_are(std::span<const WarpedLobe> lobes);

}  // namespace velour
