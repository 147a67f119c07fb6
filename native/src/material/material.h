// The run-time evaluator. On a prepared point: eval and sample, one virtual call a batch of directions.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include "btf/srbf_point.h"
#include "btf/tensor_point.h"
#include "material/btf_table_point.h"
#include "material/factored_point.h"
#include "material/ggx_sampler.h"
#include "material/lobe_filter.h"
#include "material/principled_point.h"
#include "material/surface_site.h"
#include "material/table_point.h"
#include "sphere/direction_batch.h"
#include "sphere/frame.h"
#include "srbf/lobe_mixture.h"
#include "srbf/lobe_products.h"
#include "srbf/warped_mixture.h"

namespace velour {

struct PreparedBrdf;
class TableSampler;

/// One of the layers that a material is mixed of, at a point.
struct PreparedLayer {
  std::unique_ptr<PreparedBrdf> point;
  Rgb weight{0.0f};  // of its f; black: it is not there, and `point` is not set up
  float share = 0;   // of samples that are drawn from it; all add up to 1

  bool is_there() const { return weight != Rgb(0.0f); }
};

/// What a material sets up once a camera ray and uses for every light direction of it. A material fills only what it
/// needs; the struct is scratch memory of the thread, reused from hit to hit.
struct PreparedBrdf {
  Vec3 wv;                               // local, unit, wv.z > 0
  LobeMixture lobes;                     // SRBF materials: the value
  TablePoint table;                      // where samples are drawn from tables: those of the view
  LobeMixture draws;                     // where `interpolated_draws`: what is drawn from, and its density
  WarpedMixture warped;                  // parametric models: value and density
  float parameter[8];                    // analytic materials: what they derive from wv
  GgxPoint ggx;                          // of the fitted GGX lobe, where one is the material or draws its samples
  PrincipledPoint principled;            // Principled materials: those of the site and the view
  FactoredPoint factored;                // BTFs as sums of products: those of the site and the view
  SrbfPoint srbf;                        // BTFs of multivariate SRBFs: the same
  TensorPoint tensor;                    // BTFs of clustered tensors: the same
  std::unique_ptr<PreparedBrdf> beyond;  // BTFs of open structure: the same beyond its outline, where `folded`
  bool value_only = false;               // set before prepare(): nothing is drawn, and densities are 0
  bool interpolated_draws = false;       // set before prepare(): scattered models draw as the dissertation does
  LobeFilter filter;                     // set before prepare()
  bool folded = false;
  BtfTablePoint btf_table;                // BTFs themselves: what is blended at the site for the view
  std::unique_ptr<PreparedBrdf> through;  // where light comes through: the same for light from the other side
  float through_share = 0;                // of samples that are drawn from it
  Frame relief;                           // of materials with a normal map: about the mapped normal
  std::vector<PreparedLayer> layers;      // of materials that are mixed of others
};

/// Directions are in the local shading frame. Thread-safe; no allocation, no lock.
class Material {
 public:
  virtual ~Material() = default;

  /// Must be called before the others with this `point`; `wv.z > 0`.
  virtual void prepare(const Vec3& wv, const SurfaceSite& site, PreparedBrdf& point) const = 0;
  /// The same averaged over the whole surface: all there is of a uniform material.
  void prepare(const Vec3& wv, PreparedBrdf& point) const { prepare(wv, SurfaceSite::everywhere(), point); }

  /// False for a uniform material: it does not look at the site, and whoever asks need not find it out.
  virtual bool varies() const { return false; }
  /// How many texels along both coordinates a pyramid over the tile has at its finest; (1, 1) where there is none.
  virtual Vec2 texels() const { return Vec2(1.0f); }

  /// True where alpha() is 1 everywhere.
  virtual bool opaque() const { return true; }
  /// The share of `site` that is there, in [0, 1]; through the rest one sees what lies behind. f is that of what is
  /// there.
  virtual float alpha(const SurfaceSite& /*site*/) const { return 1.0f; }
  /// Whether light that passes through the rest changes: passing() may be other than 1.
  virtual bool tints() const { return false; }
  /// What light that passes is multiplied with, in the space that f is in; it may be above 1.
  virtual Rgb passing(const SurfaceSite& /*site*/) const { return Rgb(1.0f); }

  /// Whether emission() may be other than 0.
  virtual bool glows() const { return false; }
  /// Radiance that what is there sends to every side, in the working space.
  virtual Rgb emission(const SurfaceSite& /*site*/) const { return Rgb(0.0f); }

  /// True where f may be above 0 for light from the other side of the surface, wl.z < 0; the cosine is |wl.z|.
  virtual bool transmits() const { return false; }

  /// f in 1/sr without cosine (0 at the horizon and, unless it transmits, below; never negative, never NaN) and the
  /// density of `sample`, per solid angle, of each direction of the batch. The batch is padded.
  virtual void eval(const PreparedBrdf& point, const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const = 0;

  /// Draws a wl for each of up to 64 `u` with the density that `eval` reports as pdf. It may lie below the horizon: a
  /// zero contribution unless it transmits, which gives (0, 0, 0) where a draw has no direction. The batch is not
  /// padded.
  virtual void sample(const PreparedBrdf& point, std::span<const Vec2> u, DirectionBatch& wl) const = 0;

  /// The same of one direction, without the memory of a batch.
  struct Reflection {
    Rgb f;
    float pdf;
  };
  virtual Reflection eval_one(const PreparedBrdf& point, const Vec3& wl) const {
    DirectionBatch batch;
    batch.push(wl);
    batch.pad();
    RgbBatch f;
    ScalarBatch pdf;
    eval(point, batch, f, pdf);
    return {f.get(0), pdf.v[0]};
  }
  virtual Vec3 sample_one(const PreparedBrdf& point, const Vec2& u) const {
    DirectionBatch wl;
    sample(point, {&u, 1}, wl);
    return wl.get(0);
  }

  /// The probability that `wl`, drawn with density `pdf`, is diffuse light, which Cycles calls what a lobe of no
  /// microfacets has drawn. Here the share of the density that a cosine would have, for materials without such lobes.
  virtual float diffuse_share(const PreparedBrdf& /*point*/, const Vec3& wl, float pdf) const {
    return std::min(std::abs(wl.z) / (kPi * pdf), 1.0f);
  }

  /// Few Gaussians in light space that resemble f cos at the prepared `point`: what `product` multiplies with the sky.
  /// They steer sampling alone, so lobes of another space may be given as the nearest Gaussians here. False: the
  /// material has none.
  virtual bool proposal_lobes(const PreparedBrdf& /*point*/, ProposalLobes& /*lobes*/) const { return false; }

  /// Tables that the material draws from itself; null: none, and `table` makes them.
  virtual std::shared_ptr<const TableSampler> tables() const { return nullptr; }

  /// True when f depends on the azimuth difference alone (tables of it need one meridian of views).
  virtual bool isotropic() const = 0;
};

}  // namespace velour
