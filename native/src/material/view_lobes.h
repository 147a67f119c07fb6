// The lobes of many views, in the layout that LobeMixture appends.
#pragma once

#include <vector>

#include "srbf/lobe_mixture.h"

namespace velour {

/// Built view by view: add() the lobes, then end_view(). Structure of arrays.
class ViewLobes {
 public:
  explicit ViewLobes(Kernel kernel) : kernel_(kernel) {}

  void add(const Vec3& center, float bandwidth, const Rgb& coefficient);
  /// `diffuse`: coefficient of the clipped cosine.
  void end_view(const Rgb& diffuse);

  /// Appends a view's lobes, rotated and times `weight`, to `mixture`. The diffuse part is tied to the normal and does
  /// not rotate with the highlight.
  void append_to(LobeMixture& mixture, size_t view, const Mat3& rotation, float weight) const;
  Kernel kernel() const { return kernel_; }

 private:
  Kernel kernel_;
  std::vector<float> x_, y_, z_, bandwidth_, r_, g_, b_, luminance_, mass_;
  std::vector<size_t> first_{0};
  std::vector<Rgb> diffuse_;
};

}  // namespace velour
