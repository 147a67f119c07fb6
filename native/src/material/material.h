// Run-time evaluator: eval and sample at a prepared point, one virtual call per batch of directions.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>
#include "btf/measure/half_floats.h"
#include "btf/model/srbf_evaluator.h"
#include "btf/model/tensor_evaluator.h"
#include "material/footprint_taps.h"
#include "material/microfacet/ggx_sampler.h"
#include "material/principled/principled_point.h"
#include "material/surface_site.h"
#include "math/sphere/directions.h"
#include "math/sphere/frame.h"
#include "math/sphere/vec.h"
#include "math/srbf/lobe_mixture.h"
#include "math/srbf/lobe_products.h"
#include "math/srbf/warped_mixture.h"

namespace velour {

// Rows of an uncompressed BTF at a hit.

/// Rows of lights of an uncompressed BTF to blend for a site and a view, and their weights.
struct BtfTablePoint {
  /// Maximum number of rows: footprint taps, two levels, four texels, three views.
  static constexpr int kMost = FootprintTaps::kMost * 2 * 4 * 3;
  struct Row {
    const HalfBits* lights;  // [light][channel]
    float weight;
  };
  std::array<Row, kMost> row;
  int count;
  bool back;  // a two-sided BTF seen from below
};

// Per-view state of table sampling.

/// Partition of the sphere about an axis: rows of d = 1 - cos of the angle to it, with edges at 2 (k / kRows)^4, and
/// columns of equal length along the square |x| + |y| = 1 in azimuth.
struct TableGrid {
  static constexpr int kColumnBits = 5;
  static constexpr int kRows = 64, kColumns = 1 << kColumnBits;  // multiples of 16
  static constexpr int kRowsPadded = kRows + 16;

  static constexpr float row_edge(int row) {
    const float s = static_cast<float>(row) / kRows;
    return 2 * (s * s) * (s * s);
  }
};

/// The tables of two or four nodes, their weights in the mixture, and their frame.
struct TablePoint {
  const float* table[4];
  float weight[4];
  int count = 0;
  float mass;  // integral of the tables: luminance of f cos and the defensive share
  Vec3 tangent, bitangent, axis;
};

// Coefficients of a factored BTF at a hit, and the views around the direction of view.

/// What site and view decide of a factored BTF: the coefficients of its components, interpolated between texels.
struct FactoredPoint {
  static constexpr int kMost = 512 + 16;  // components, and what vectors read beyond them
  alignas(64) float value[kMost];         // of all components, or of those of each view in turn, times its weight
  std::array<uint32_t, 3> view;           // numbers of views
  std::array<float, 3> weight;            // barycentric; 0 everywhere: the BTF has no view on this side
  bool back;                              // seen from below, in a BTF of two sides
};

struct PreparedBrdf;
class TableSampler;

/// A layer of a mixed material at a point.
struct PreparedLayer {
  std::unique_ptr<PreparedBrdf> point;
  Rgb weight{0.0f};  // factor of its f; black: the layer is absent and `point` is not prepared
  float share = 0;   // probability of sampling this layer; all sum to 1

  bool is_there() const { return weight != Rgb(0.0f); }
};

/// State that a material prepares once per hit and uses for all its light directions. A material fills only what it
/// needs; the struct is per-thread scratch memory, reused from hit to hit.
struct PreparedBrdf {
  Vec3 wv;                               // local, unit, wv.z > 0
  LobeMixture lobes;                     // SRBF materials: the value
  TablePoint table;                      // materials sampled from tables: those of the view
  LobeMixture draws;                     // per-view models without tables or with `interpolated_draws`: density
  WarpedMixture warped;                  // parametric models: value and density; sided BTFs: density
  float parameter[8];                    // analytic materials: values derived from wv
  GgxPoint ggx;                          // the fitted GGX lobe, as the material or as its proposal
  PrincipledPoint principled;            // Principled materials: values at the site and view
  FactoredPoint factored;                // factored BTFs: values at the site and view
  SrbfPoint srbf;                        // BTFs of multivariate SRBFs: values at the site and view
  TensorPoint tensor;                    // BTFs of clustered tensors: values at the site and view
  std::unique_ptr<PreparedBrdf> beyond;  // HoledBtfMaterial: the point beyond the silhouette, if `folded`
  bool value_only = false;               // set before prepare(): no sampling; densities are 0
  bool interpolated_draws = false;       // set before prepare(): per-view models sample as in [T09]
  LobeFilter filter;                     // set before prepare()
  bool folded = false;
  BtfTablePoint btf_table;                // uncompressed BTFs: rows to blend at the site and view
  std::unique_ptr<PreparedBrdf> through;  // ThroughMaterial: the point for light from the other side
  float through_share = 0;                // probability of sampling `through`
  Frame relief;                           // normal-mapped materials: frame about the mapped normal
  std::vector<PreparedLayer> layers;      // mixed materials
};

/// Directions are in the local shading frame. Thread-safe; no allocation, no lock.
class Material {
 public:
  virtual ~Material() = default;

  /// Must be called before the other members with this `point`. Requires wv.z > 0.
  virtual void prepare(const Vec3& wv, const SurfaceSite& site, PreparedBrdf& point) const = 0;
  /// Prepares the average over the whole surface, which is exact for a uniform material.
  void prepare(const Vec3& wv, PreparedBrdf& point) const { prepare(wv, SurfaceSite::everywhere(), point); }

  /// False for a uniform material, which ignores the site, so callers need not determine it.
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

  /// f in 1/sr without cosine (0 at the horizon and, unless it transmits, below; never negative, never NaN) and the
  /// density of `sample`, per solid angle, of each direction of the batch. The batch is padded.
  virtual void eval(const PreparedBrdf& point, const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const = 0;

  /// Samples a wl for each of up to 64 `u` with the density that `eval` reports as pdf. A wl may lie below the horizon,
  /// with zero contribution unless the material transmits; a transmitting material gives (0, 0, 0) for a sample without
  /// a direction. The batch is not padded.
  virtual void sample(const PreparedBrdf& point, std::span<const Vec2> u, DirectionBatch& wl) const = 0;

  /// Result of eval_one(), which evaluates one direction without the memory of a batch.
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

  /// Probability that `wl`, sampled with density `pdf`, counts as diffuse, Cycles' term for samples of lobes without
  /// microfacets. The default suits materials without microfacet lobes: the cosine density over `pdf`.
  virtual float diffuse_share(const PreparedBrdf& /*point*/, const Vec3& wl, float pdf) const {
    return std::min(std::abs(wl.z) / (kPi * pdf), 1.0f);
  }

  /// A few Gaussians over light directions that approximate f cos at the prepared `point`; `product` sampling
  /// multiplies them with the environment. They only steer sampling, so lobes of another space may be approximated.
  /// False: the material has none.
  virtual bool proposal_lobes(const PreparedBrdf& /*point*/, ProposalLobes& /*lobes*/) const { return false; }

  /// Tables that the material itself samples from; null: none, and `table` sampling makes them.
  virtual std::shared_ptr<const TableSampler> tables() const { return nullptr; }

  /// True when f depends on the azimuth difference alone (tables of it need one meridian of views).
  virtual bool isotropic() const = 0;
};

// Which side of the surface a BTF material is lit from.

/// f is given for light from one side of the surface. For other_side, light directions are mirrored (z > 0).
enum class BtfLight { viewers_side, other_side };

// Share of samples reserved for directions that tables and lobes miss.

/// Probability of plain cosine sampling, so that the density is positive wherever f may be.
inline constexpr float kDefensiveShare = 0.05f;

}  // namespace velour
