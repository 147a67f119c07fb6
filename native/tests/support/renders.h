// Independent renders of a scene, for the comparison of their means.
#pragma once

#include "support/picture_means.h"
#include "support/test_scene.h"

namespace velour::test {

/// Renders with seeds `first_seed`, `first_seed` + 1, ...; blocks of `block` pixels.
inline PictureMeans independent_renders(const Scene& scene, RenderOptions options, int count, uint64_t first_seed,
                                        int block = 4) {
  PictureMeans means(options.width, options.height, block);
  for (int i = 0; i < count; ++i) {
    options.seed = first_seed + static_cast<uint64_t>(i);
    means.add(rendered(scene, options));
  }
  return means;
}

/// What is known in closed form, up to the rounding of a render: single precision, offsets of shadow rays.
inline Estimate closed_form(double value, double relative_error = 1e-4) { return {value, relative_error * value}; }

}  // namespace velour::test
