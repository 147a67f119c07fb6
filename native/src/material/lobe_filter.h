// Filters that a path applies to the lobes of the surface it meets, to reduce noise.
#pragma once

namespace velour {

/// Effect of Cycles' Filter Glossy and Reflective Caustics on microfacet lobes. Both bias the picture. Measured
/// materials have no such lobes, and keep all that they reflect.
struct LobeFilter {
  float min_alpha = 0;  // lobes are at least as rough; how bright they are stays as it was without
  bool diffuse_only = false;
};

}  // namespace velour
