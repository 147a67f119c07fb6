// Prints what docs/engine/capture.md#micro-surface-goniometer states: albedo of a lossless surface by order of
// reflection, and single reflection against Beckmann's closed form, one JSON object a line. Arguments: samples
// (24000000).
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "capture/goniometer/goniometer.h"
#include "support/beckmann.h"

namespace {

using namespace velour;

/// Root mean square of measured / closed form - 1 over lights within one roughness of the mirror direction's slope.
double distance_from_beckmann(const MicrosurfaceBrdf& brdf, double alpha, const Vec3& wv) {
  double sum = 0;
  int count = 0;
  for (int ring = 0; ring <= 8; ++ring) {
    for (int turn = 0; turn < 12; ++turn) {
      const double slope = alpha * ring / 8.0, angle = 2 * kPiD * turn / 12;
      const Vec3 h = glm::normalize(Vec3(slope * std::cos(angle), slope * std::sin(angle), 1));
      const Vec3 wl = 2 * glm::dot(wv, h) * h - wv;
      if (wl.z <= 0.05f) continue;
      sum += std::pow(static_cast<double>(brdf.single({wl, wv}).g) / test::beckmann(alpha, {wl, wv}) - 1, 2);
      ++count;
    }
  }
  return std::sqrt(sum / count);
}

void check(double alpha, uint64_t samples) {
  GoniometerOptions options;
  options.surface.roughness = alpha;
  options.facets = Reflectance({0.0, 1.0});
  options.samples_per_tile = samples / static_cast<uint64_t>(options.batches * options.tiles_per_batch);
  const GoniometerBins bins(options);
  Progress progress;
  GoniometerSums sums(bins);
  for (const GoniometerSums& batch : run_goniometer(options, progress)) sums += batch;
  const MicrosurfaceBrdf brdf(options, bins, sums);
  for (const int view : {0, 30, 45, 60, 75, 80, 85, 88}) {
    const Vec3 wv = direction(radians_from(static_cast<float>(view)), 0);
    const float single = albedo(brdf, &MicrosurfaceBrdf::single, wv, 100'000).g;
    const float multiple = albedo(brdf, &MicrosurfaceBrdf::multiple, wv, 100'000).g;
    std::printf(
        "{\"roughness\": %g, \"view\": %d, \"single\": %.4f, \"multiple\": %.4f, \"total\": %.4f, "
        "\"beckmann\": %.4f, \"lost\": %.1e}\n",
        alpha, view, static_cast<double>(single), static_cast<double>(multiple), static_cast<double>(single + multiple),
        distance_from_beckmann(brdf, alpha, wv), static_cast<double>(sums.lost) / sums.samples);
  }
}

}  // namespace

int main(int argc, char** argv) {
  for (const double alpha : {0.1, 0.2, 0.6}) check(alpha, argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 24'000'000);
}
