// A GGX lobe over a diffuse base with free reflectances: what a renderer without measured materials would use for one,
// and the proposal that importance-samples it.
#pragma once

#include <memory>

#include "material/specular_albedo.h"
#include "sphere/direction_batch.h"

namespace velour {

class Material;

/// f = diffuse / pi + F G2 D / (4 wl.z wv.z), F = schlick_fresnel(f0, wv.h, f90). Linear Rec. 709, >= 0. f90 is free
/// because few measurements rise to 1 at grazing angles; the base is not dimmed by the coat for the same reason.
struct GgxParameters {
  Vec2 alpha{0.5f};  // slope roughness along x and along y
  Rgb f0{0.0f}, f90{0.0f}, diffuse{0.0f};
};

/// f in 1/sr without cosine; both directions above the horizon.
Rgb ggx_model(const GgxParameters& parameters, const DirectionPair& w);

/// What sampling derives from a view.
struct GgxPoint {
  Vec3 wv;
  float cosine_share;  // probability of the cosine component: base and defence
  float lobe_scale;    // density of the other component = lobe_scale (|s|^2 / ggx_spread(s))^2 with s = wl + wv
};

/// Visible normals or the cosine, in proportion to their albedo at the view, and 5 % cosine in any case: the same
/// defence as the samplers of lobes and tables have. Immutable, thread-safe, no allocation after construction.
class GgxSampler {
 public:
  explicit GgxSampler(const GgxParameters& parameters);

  /// `wv.z > 0`.
  void prepare(const Vec3& wv, GgxPoint& point) const;
  /// May lie below the horizon.
  Vec3 sample(const GgxPoint& point, const Vec2& u) const;
  /// Density of `sample` per solid angle, at each direction of the padded batch.
  void pdf(const GgxPoint& point, const DirectionBatch& wl, ScalarBatch& pdf) const;

 private:
  float specular_albedo(const Vec3& wv) const;

  Vec2 alpha_;
  float diffuse_;                     // luminance
  float specular_;                    // luminance of the brighter of f0 and f90: the scale of the tables
  SpecularAlbedo along_x_, along_y_;  // of views in the planes of the axes
};

/// f, samples and density of the fitted lobe itself.
std::shared_ptr<const Material> make_ggx_material(const GgxParameters& parameters);

}  // namespace velour
