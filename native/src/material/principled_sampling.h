// How Principled materials are evaluated and sampled, uniform or textured.
#pragma once

#include "material/material.h"
#include "material/principled_lobes.h"

namespace velour {

/// Of what draws a sample: they add up to 1.
struct PrincipledShares {
  float diffuse, specular, coat;
};

/// Samples the cosine, the visible normals of the base's lobe or those of the coat's, in proportion to their albedos.
class PrincipledSampling : public Material {
 public:
  void eval(const PreparedBrdf& point, const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const final;
  void sample(const PreparedBrdf& point, std::span<const Vec2> u, DirectionBatch& wl) const final;
  /// f less that of the diffuse base.
  void eval_specular(const PreparedBrdf& point, const DirectionBatch& wl, RgbBatch& f) const;
  bool isotropic() const final { return true; }

 protected:
  /// `specular`: albedo of metal and dielectric under the coat, in luminance; how well it is known decides the noise.
  static void set_up(const PrincipledLobes& lobes, const PrincipledLobes::View& view, float specular,
                     PreparedBrdf& point);
  /// Those that `point` was set up with.
  virtual const PrincipledLobes& lobes(const PreparedBrdf& point) const = 0;

 private:
  void eval_parts(const PreparedBrdf& point, float diffuse_scale, const DirectionBatch& wl, RgbBatch& f,
                  ScalarBatch& pdf) const;
};

}  // namespace velour
