// Run-time evaluator of a surface: f and samples at a prepared point, one virtual call per batch of directions.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include "base/memory.h"
#include "material/surface_site.h"
#include "math/sphere/directions.h"
#include "math/sphere/vec.h"
#include "math/srbf/lobe_products.h"

namespace velour {

class TableSampler;

/// Lobes without width: directions in which a surface reflects or refracts light without scattering it.
struct DeltaLobes {
  static constexpr int kCapacity = 4;
  struct Lobe {
    Vec3 wl;     // below the horizon for refraction
    Rgb weight;  // share of the radiance from there that leaves towards the view
  };
  int count = 0;
  Lobe lobe[kCapacity];
  float rest = 1;  // approximate albedo of what PreparedBrdf::eval() describes, which only steers sampling; 0: nothing

  /// Lobes of one direction are merged; beyond the capacity, a lobe joins the one nearest to it.
  void add(const Vec3& wl, const Rgb& weight) {
    if (weight == Rgb(0.0f)) return;
    int nearest = -1;
    for (int i = 0; i < count; ++i) {
      if (nearest < 0 || glm::dot(lobe[i].wl, wl) > glm::dot(lobe[nearest].wl, wl)) nearest = i;
    }
    const bool is_same = nearest >= 0 && glm::distance(lobe[nearest].wl, wl) < 1e-5f;
    if (is_same || count == kCapacity) {
      lobe[nearest].weight += weight;
    } else {
      lobe[count++] = {wl, weight};
    }
  }
};

/// A material at a site, seen from one view. Directions are in the local shading frame. Lives in a ScratchArena, and
/// uses its material and other objects of that arena. No allocation, no lock; any number of threads may call it.
class PreparedBrdf {
 public:
  /// f in 1/sr without cosine (0 at the horizon and, unless the material transmits, below; never negative, never NaN)
  /// and the density of `sample`, per solid angle, of each direction of the batch. The batch is padded.
  virtual void eval(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const = 0;

  /// Samples a wl for each of up to 64 `u` with the density that `eval` reports as pdf. A wl may lie below the horizon,
  /// with zero contribution unless the material transmits; a transmitting material gives (0, 0, 0) for a sample without
  /// a direction. The batch is not padded.
  virtual void sample(std::span<const Vec2> u, DirectionBatch& wl) const = 0;

  /// Result of eval_one(), which evaluates one direction without the memory of a batch.
  struct Reflection {
    Rgb f;
    float pdf;
  };
  virtual Reflection eval_one(const Vec3& wl) const {
    DirectionBatch batch;
    batch.push(wl);
    batch.pad();
    RgbBatch f;
    ScalarBatch pdf;
    eval(batch, f, pdf);
    return {f.get(0), pdf.v[0]};
  }
  virtual Vec3 sample_one(const Vec2& u) const {
    DirectionBatch wl;
    sample({&u, 1}, wl);
    return wl.get(0);
  }

  /// Probability that `wl`, sampled with density `pdf`, counts as diffuse, Cycles' term for samples of lobes without
  /// microfacets. The default suits materials without microfacet lobes: the cosine density over `pdf`.
  virtual float diffuse_share(const Vec3& wl, float pdf) const { return std::min(std::abs(wl.z) / (kPi * pdf), 1.0f); }

  /// Replaces `lobes` by those without width, which eval() and sample() leave out. The default: none.
  virtual void delta_lobes(DeltaLobes& lobes) const {
    lobes.count = 0;
    lobes.rest = 1;
  }

  /// A few Gaussians over light directions that approximate f cos; `product` sampling multiplies them with the
  /// environment. They only steer sampling, so lobes of another space may be approximated. False: there are none.
  virtual bool proposal_lobes(ProposalLobes& /*lobes*/) const { return false; }

 protected:
  ~PreparedBrdf() = default;  // never called
};

/// Options of Material::prepare.
struct PrepareOptions {
  bool value_only = false;          // no sampling; densities may be 0
  bool interpolated_draws = false;  // per-view models sample as in [T09]
  /// For paths of a render: smooth glass has delta_lobes() in place of very sharp ones, and rough glass is evaluated as
  /// in Cycles (glass_lobe.h).
  bool of_path = false;
  bool facets_only = false;  // with of_path: rough glass has nothing where no facet refracts (glass_lobe.h)
  LobeFilter filter{};
};

/// Immutable and thread-safe.
class Material {
 public:
  virtual ~Material() = default;

  /// The material at a point, in `arena`; never null. Requires wv.z > 0. Allocates only where `arena` has to grow.
  virtual const PreparedBrdf* prepare(const Vec3& wv, const SurfaceSite& site, const PrepareOptions& options,
                                      ScratchArena& arena) const = 0;
  /// The average over the whole surface, which is exact for a uniform material.
  const PreparedBrdf* prepare(const Vec3& wv, ScratchArena& arena) const {
    return prepare(wv, SurfaceSite::everywhere(), {}, arena);
  }

  /// False for a uniform material, which uses nothing of the site except `back`.
  virtual bool varies() const { return false; }
  /// Texels along both coordinates at the finest level of a pyramid over the tile; (1, 1) without one.
  virtual Vec2 texels() const { return Vec2(1.0f); }

  /// True where alpha() is 1 everywhere.
  virtual bool opaque() const { return true; }
  /// Opacity of `site`, in [0, 1]. f describes only the opaque part.
  virtual float alpha(const SurfaceSite& /*site*/) const { return 1.0f; }
  /// Whether light passing through the transparent part changes: passing() may differ from 1.
  virtual bool tints() const { return false; }
  /// Factor of light passing through the transparent part, in the color space of f; may exceed 1.
  virtual Rgb passing(const SurfaceSite& /*site*/) const { return Rgb(1.0f); }

  /// Whether emission() may be nonzero.
  virtual bool emits() const { return false; }
  /// Radiance emitted by the opaque part, equal in all directions, in the working space.
  virtual Rgb emission(const SurfaceSite& /*site*/) const { return Rgb(0.0f); }

  /// True where f may be above 0 for light from the other side of the surface, wl.z < 0; the cosine is |wl.z|.
  virtual bool transmits() const { return false; }

  /// Tables that the material itself samples from; null: none, and `table` sampling makes them.
  virtual std::shared_ptr<const TableSampler> tables() const { return nullptr; }

  /// True when f depends on the azimuth difference alone (tables of it need one meridian of views).
  virtual bool isotropic() const = 0;
};

/// Share of samples from the plain cosine, so that the density is positive where tables and lobes miss some of f.
inline constexpr float kDefensiveShare = 0.05f;

}  // namespace velour
