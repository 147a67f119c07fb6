#include "btf/mended_image.h"

#include <cmath>

namespace velour {

uint64_t mend_image(std::span<float> image) {
  uint64_t bad = 0;
  for (size_t channel = 0; channel < 3; ++channel) {
    double sum = 0;
    uint64_t good = 0, here = 0;
    for (size_t i = channel; i < image.size(); i += 3) {
      std::isfinite(image[i]) ? (sum += static_cast<double>(image[i]), ++good) : ++here;
    }
    bad += here;
    if (here == 0) continue;
    const float mean = good > 0 ? static_cast<float>(sum / static_cast<double>(good)) : 0.0f;
    for (size_t i = channel; i < image.size(); i += 3) {
      if (!std::isfinite(image[i])) image[i] = mean;
    }
  }
  return bad;
}

}  // namespace velour
