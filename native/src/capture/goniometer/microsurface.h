// A virtual goniometer for random micro-surfaces: measurements with known ground truth, generated from a seed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>
#include "base/progress.h"
#include "capture/goniometer/coated_body.h"
#include "math/sphere/vec.h"

namespace velour {

struct MicrosurfaceOptions {
  double roughness = 0.2;        // Beckmann alpha along x = sqrt(2) x RMS slope
  double anisotropy = 1.0;       // alpha_x / alpha_y
  std::string metal = "copper";  // one of metal_names()
  Rgb base_albedo{0, 0, 0};      // diffuse base
  double base_share = 0.0;       // share of the surface that is diffuse base
  /// Refractive index of a clear surface, below which base and metal are pigment and flakes. 0: no clear surface.
  double ior = 0.0;
  double flake_roughness = 0.2;  // Beckmann alpha of the flakes below a clear surface
  uint64_t rays = 0;             // 0: the default
  uint64_t seed = 0;
  int threads = 0;
};

struct MicrosurfaceReport {
  double seconds = 0;
  uint64_t rays = 0;  // traced, all orders of scattering
  double rays_per_second = 0;
  uint64_t bytes = 0;                  // of the file
  double resolution_degrees = 0;       // of the bins that collect the rays, near the highlight
  double relative_standard_error = 0;  // median over the bins that hold 90 % of the energy
  double albedo[3] = {0, 0, 0};        // at normal incidence
};

/// Traces, tabulates and writes `path`, in MERL layout if isotropic, otherwise as Velour's EXR table.
MicrosurfaceReport capture_microsurface(const MicrosurfaceOptions& options, const std::string& path,
                                        Progress& progress);

// The metals that surfaces and flakes are made of.

std::vector<std::string> metal_names();

/// Reflectance of clean metal below a medium of refractive index `outside` (1: air or vacuum). Throws
/// Error(invalid_argument) that lists the known names. metals.cpp gives the sources of the data.
Reflectance metal_reflectance(const std::string& name, double outside = 1.0);

}  // namespace velour
