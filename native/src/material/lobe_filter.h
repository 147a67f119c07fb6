// Filters that a path applies to the lobes of the surface it meets, to reduce noise.
#pragma once

namespace velour {

/// Effect of Cycles' Filter Glossy and Reflective Caustics on microfacet lobes. Both bias the image. Measured materials
/// have no such lobes and are unaffected.
struct LobeFilter {
  float min_alpha = 0;  // minimum alpha of lobes; does not change their brightness
  bool diffuse_only = false;
};

}  // namespace velour
