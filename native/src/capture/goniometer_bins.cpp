#include "capture/goniometer_bins.h"

namespace velour {
namespace {

void add(std::vector<double>& to, const std::vector<double>& from, double sign) {
  for (size_t i = 0; i < to.size(); ++i) to[i] += sign * from[i];
}

}  // namespace

GoniometerBins::GoniometerBins(const GoniometerOptions& options)
    : slopes(options.surface.roughness, options.surface.roughness / options.surface.anisotropy),
      mirror(options.surface.anisotropy == 1.0 ? PairGrid(24, 12, 0) : PairGrid(12, 9, 24)),
      metal(options.surface.anisotropy == 1.0 ? PairGrid(20, 24, 0) : PairGrid(12, 9, 24)),
      diffuse(options.body && options.body->has_flakes() ? metal
              : options.surface.anisotropy == 1.0        ? PairGrid(14, 9, 0)
                                                         : PairGrid(8, 6, 12)) {}

GoniometerSums::GoniometerSums(const GoniometerBins& bins)
    : metal_facets(bins.slopes.size()),
      tried(bins.mirror.size()),
      clear(bins.mirror.size()),
      metal_flux(3 * bins.metal.size()),
      diffuse_flux(3 * bins.diffuse.size()) {}

GoniometerSums& GoniometerSums::operator+=(const GoniometerSums& other) {
  add(metal_facets, other.metal_facets, 1);
  add(tried, other.tried, 1);
  add(clear, other.clear, 1);
  add(metal_flux, other.metal_flux, 1);
  add(diffuse_flux, other.diffuse_flux, 1);
  facets += other.facets;
  samples += other.samples;
  rays += other.rays;
  lost += other.lost;
  return *this;
}

GoniometerSums& GoniometerSums::operator-=(const GoniometerSums& other) {
  add(metal_facets, other.metal_facets, -1);
  add(tried, other.tried, -1);
  add(clear, other.clear, -1);
  add(metal_flux, other.metal_flux, -1);
  add(diffuse_flux, other.diffuse_flux, -1);
  facets -= other.facets;
  samples -= other.samples;
  rays -= other.rays;
  lost -= other.lost;
  return *this;
}

}  // namespace velour
