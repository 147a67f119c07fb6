// What a path may ask of the surface that it meets, so that it makes less noise.
#pragma once

namespace velour {

/// What Cycles' Filter Glossy and Reflective Caustics do to lobes of microfacets. Both bias the picture. Measured
/// materials have no such lobes, and keep all that they reflect.
struct LobeFilter {
  float min_alpha = 0;  // lobes are at least as rough; how bright they are stays as it was without
  bool diffuse_only = false;
};

}  // namespace velour
