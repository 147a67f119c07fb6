// A quadrature over light directions that suits a mixture of warped lobes.
#pragma once

#include <span>
#include <vector>

#include "srbf/warped_lobe.h"

namespace velour {

/// Evenly spread draws of every lobe and of the cosine, and what each lobe sees of them. Good to a few per cent.
class LightPoints {
 public:
  LightPoints(std::span<const WarpedLobe> lobes, const Vec3d& wv);

  size_t size() const { return light_.size(); }
  /// The integral of the luminance of f cos over the hemisphere.
  double mass() const;
  const Vec3d& light(size_t i) const { return light_[i]; }
  double value(size_t i) const { return value_[i]; }    // luminance of f
  double weight(size_t i) const { return weight_[i]; }  // part of the mass
  double kernel(size_t i, size_t lobe) const { return kernel_[i * lobes_ + lobe]; }

 private:
  size_t lobes_;
  std::vector<Vec3d> light_;
  std::vector<double> value_, weight_, kernel_;
};

}  // namespace velour
