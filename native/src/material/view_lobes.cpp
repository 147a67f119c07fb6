#include "material/view_lobes.h"

#include <algorithm>

namespace velour {

void ViewLobes::add(const Vec3& center, float bandwidth, const Rgb& coefficient) {
  x_.push_back(center.x);
  y_.push_back(center.y);
  z_.push_back(center.z);
  bandwidth_.push_back(bandwidth);
  r_.push_back(coefficient.r);
  g_.push_back(coefficient.g);
  b_.push_back(coefficient.b);
  luminance_.push_back(std::max(luminance(coefficient), 0.0f));
  mass_.push_back(luminance_.back() * static_cast<float>(kernel_integral(kernel_, static_cast<double>(bandwidth))));
}

void ViewLobes::end_view(const Rgb& diffuse) {
  first_.push_back(x_.size());
  diffuse_.push_back(diffuse);
}

void ViewLobes::append_to(LobeMixture& mixture, size_t view, const Mat3& rotation, float weight) const {
  const size_t first = first_[view];
  const auto from = [first](const std::vector<float>& values) { return values.data() + first; };
  const LobeSpan lobes{
      from(x_), from(y_), from(z_),         from(bandwidth_), from(r_),
      from(g_), from(b_), from(luminance_), from(mass_),      static_cast<int>(first_[view + 1] - first)};
  mixture.append(lobes, rotation, weight);
  mixture.add_diffuse(weight * diffuse_[view]);
}

}  // namespace velour
