// Which lights reach which vertices.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "capture/light_kernels.h"
#include "capture/path_vertices.h"

namespace velour {

/// One mask per vertex; bit l is set if light l of the group reaches it. One per thread.
class ShadowMasks {
 public:
  explicit ShadowMasks(const RepeatedTile& tile) : cutouts_(tile) {}

  using Mask = std::array<uint64_t, kLightsTogether / 64>;

  /// Traces light by light, because rays of one direction are traced in packets. Lights below a vertex's shading or
  /// geometric horizon need no ray.
  void trace(const PathVertices& paths, const LightGroup& group, TileRays& rays, RayLog* log, const Progress& progress);

  const Mask& of(uint32_t vertex) const { return masks_[vertex]; }

 private:
  void read(const PathVertices& paths);
  void try_light(const PathVertices& paths, const CaptureLight& light, uint32_t bit, TileRays& rays, RayLog* log);
  void trace_some(const PathVertices& paths, const CaptureLight& light, TileRays& rays, RayLog* log);
  void note_reached(uint32_t bit);
  void trace_through_cutouts(const PathVertices& paths, const CaptureLight& light, TileRays& rays, RayLog* log);

  // Data of the vertices, read for every light.
  PlaceNormals normals_;
  std::vector<Vec3> origins_;
  Cutouts cutouts_;
  std::vector<Mask> masks_;
  std::vector<uint32_t> facing_;   // vertices that face the light
  std::span<const uint32_t> ids_;  // the part of facing_ whose rays are being traced
  std::vector<Ray> rays_;
  std::vector<uint8_t> blocked_;
  // Used only if surfaces let rays through.
  std::vector<Hit> hits_;
  std::vector<uint64_t> keys_;
};

}  // namespace velour
