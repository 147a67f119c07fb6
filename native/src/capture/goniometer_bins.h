// Options of the goniometer, and the bins in which it collects light.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "capture/coated_body.h"
#include "capture/height_field.h"
#include "capture/pair_grid.h"
#include "capture/reflectance.h"
#include "capture/slope_bins.h"

namespace velour {

struct GoniometerOptions {
  HeightFieldOptions surface;
  Reflectance facets{RefractiveIndex{0.0, 1.0}};  // default: reflects everything
  Rgb base_albedo{0, 0, 0};                       // of the diffuse base
  double base_share = 0.0;                        // share of the mean plane over which the surface is base
  std::optional<CoatedBody> body;  // below a clear surface, which `facets` then describes; excludes base_share
  uint64_t seed = 0;
  int batches = 32;         // independent repetitions; errors are estimated from their spread
  int tiles_per_batch = 2;  // surfaces per batch
  uint64_t samples_per_tile = 375'000;
  int threads = 0;         // 0: all
  bool reciprocal = true;  // also counts every path with its two ends exchanged
};

/// The bins for a set of options.
struct GoniometerBins {
  explicit GoniometerBins(const GoniometerOptions& options);
  SlopeBins slopes;
  PairGrid mirror;   // one reflection, off metal or an interface
  PairGrid metal;    // several such reflections and nothing else
  PairGrid diffuse;  // light that met the base or a body; it varies slowest
};

/// Collected light. The sums of two runs may be added.
struct GoniometerSums {
  explicit GoniometerSums(const GoniometerBins& bins);
  GoniometerSums& operator+=(const GoniometerSums& other);
  GoniometerSums& operator-=(const GoniometerSums& other);

  std::vector<double> metal_facets;  // per slope bin
  double facets = 0;                 // of both kinds
  std::vector<double> tried;         // per mirror bin: sum of the guide over the mirror pairs of metal facets...
  std::vector<double> clear;         // ... and how many of them saw both the light and the viewer
  std::vector<double> metal_flux;    // per metal bin, 3 channels: flux towards wl per unit of incident flux
  std::vector<double> diffuse_flux;  // per diffuse bin, likewise
  double samples = 0;
  uint64_t rays = 0;
  uint64_t lost = 0;  // abandoned paths: lost rays, and more than kMaxBounces reflections
};

}  // namespace velour
