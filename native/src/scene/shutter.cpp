#include "scene/shutter.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"
#include "scene/motion.h"

namespace velour {

Shutter::Shutter(const std::vector<float>& opening) : density_(opening) {
  const auto wrong = std::ranges::find_if(opening, [](float x) { return !(x >= 0.0f && std::isfinite(x)); });
  if (wrong != opening.end()) {
    refuse("The shutter curve has the value " + std::to_string(*wrong) + "; values must be finite and at least 0.");
  }
  if (std::ranges::none_of(opening, [](float x) { return x > 0.0f; })) {
    refuse("The shutter curve is 0 everywhere, so the shutter never opens; raise a part of it.");
  }
  if (density_.size() == 1) density_.push_back(density_[0]);
  std::vector<double> below = {0.0};
  for (size_t i = 1; i < density_.size(); ++i) {
    below.push_back(below.back() + 0.5 * (static_cast<double>(density_[i - 1]) + static_cast<double>(density_[i])));
  }
  const double all = below.back(), pieces = static_cast<double>(density_.size() - 1);
  for (const double x : below) below_.push_back(static_cast<float>(x / all));
  for (float& x : density_) x = static_cast<float>(static_cast<double>(x) / all * pieces);
}

float Shutter::time(float u) const {
  const auto above = std::upper_bound(below_.begin() + 1, below_.end() - 1, u);
  const auto i = static_cast<size_t>(above - below_.begin()) - 1;
  const float a = density_[i], b = density_[i + 1], share = below_[i + 1] - below_[i];
  const float part = share > 0.0f ? std::clamp((u - below_[i]) / share, 0.0f, 1.0f) : 0.0f;
  // Root of the integral of a density that is linear from a to b, without cancellation.
  const float root = a + std::sqrt(a * a + part * (b * b - a * a));
  const float at = root > 0.0f ? std::min(part * (a + b) / root, 1.0f) : 0.0f;
  return (static_cast<float>(i) + at) / static_cast<float>(density_.size() - 1);
}

float Shutter::density(float time) const {
  const MotionTime at(density_.size(), time);
  return at.between(density_[at.before], density_[at.before + 1]);
}

}  // namespace velour
