// Albedo: share of light that a surface reflects toward the viewer.
#pragma once

#include "material/material.h"
#include "render/path_numbers.h"
#include "render/vertex.h"

namespace velour {

/// Holds scratch memory; one per thread.
class SurfaceAlbedo {
 public:
  explicit SurfaceAlbedo(const std::optional<Mat3>& rec709_to_working) : rec709_to_working_(rec709_to_working) {}

  /// Unbiased estimate of the integral of f cos over the sphere, in the working space, from kDirections directions
  /// sampled by the material; may be above 1. Excludes emission.
  Rgb estimate(const Vertex& vertex, PathNumbers numbers);

 private:
  static constexpr int kDirections = 4;

  const std::optional<Mat3>& rec709_to_working_;
  PreparedBrdf prepared_;
  DirectionBatch drawn_, wl_;
  RgbBatch f_;
  ScalarBatch pdf_;
};

}  // namespace velour
