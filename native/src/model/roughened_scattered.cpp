#include <algorithm>

#include "model/roughened_model.h"
#include "srbf/lobe_light.h"
#include "srbf/widened_lobe.h"

namespace velour {
namespace {

constexpr float kMinViewCosine = 1e-4f;
constexpr double kMinLobeLight = 1e-30;

/// Roughens a lobe of f cos over light directions.
void roughen(Kernel kernel, double by, float cosine, float& bandwidth, Rgb& coefficient) {
  const auto before = static_cast<double>(bandwidth);
  bandwidth = std::min(bandwidth, static_cast<float>(widened_bandwidth(kernel, before, by)));
  const auto light = [&](double b) { return kernel_integral_above(kernel, b, static_cast<double>(cosine)); };
  coefficient *= static_cast<float>(light(before) / std::max(light(static_cast<double>(bandwidth)), kMinLobeLight));
}

}  // namespace

ScatteredBrdf roughened(const ScatteredBrdf& brdf, double roughness) {
  ScatteredBrdf rougher = brdf;
  for (size_t view = 0; view < brdf.views.size(); ++view) {
    const double cosine = static_cast<double>(std::max(brdf.views[view].z, kMinViewCosine));
    const double by = light_bandwidth_of_roughness(roughness, cosine);
    for (size_t j = brdf.first_lobe[view]; j < brdf.first_lobe[view + 1]; ++j) {
      roughen(brdf.kernel, by, brdf.center[j].z, rougher.bandwidth[j], rougher.coefficient[j]);
    }
  }
  return rougher;
}

}  // namespace velour
