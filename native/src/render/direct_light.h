// Light that reaches vertices straight from lamps and environment: the estimator of every strategy.
#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <span>

#include "render/light_terms.h"
#include "render/onward.h"
#include "render/path_numbers.h"
#include "render/scene_samplers.h"
#include "render/shadow_queue.h"
#include "render/sharp_lamps.h"
#include "srbf/lobe_draws.h"

namespace velour {

/// A vertex that gathers light.
struct Receiver {
  Vertex vertex;
  PathNumbers* numbers;
  Rgb throughput;
  uint32_t sample;  // number of the camera sample
  int directions;   // how many to draw
  int full;         // how many a camera ray draws that is not the last of its pixel
  PathPast past{};
  float limit = std::numeric_limits<float>::infinity();  // LightPathOptions::limit
};

/// Light that arrives if the ray with which the path of a vertex goes on meets nothing nearer than `far`.
struct AwaitedLight {
  size_t place;  // of the vertex among the receivers; then of the path among those that go on
  Rgb light;
  float limit;  // of the sum of its channels
  float far;
};

/// One a thread: owns the scratch memory of the vertices in work. They go through together, in as many as fit a batch
/// of directions: memory and vectors serve all of them, while their lobes stay in the cache.
class DirectLight {
 public:
  /// `sky` serves `product`; null for the others.
  DirectLight(const Scene& scene, const Lighting& lighting, const RenderOptions& options, const SkySampler* sky)
      : working_space_(scene.rec709_to_working()),
        materials_(scene.materials()),
        lighting_(lighting),
        options_(options),
        sampling_(surface_sampling(options.strategy)),
        meets_surfaces_(shares(options, 0.0f).surface > 0.0f),
        shares_rays_(VisibleRays(scene).plain()),
        sky_(sky) {}

  /// How many vertices of up to `directions` each gather() takes.
  static size_t receivers_of(int directions) {
    return static_cast<size_t>(std::clamp(DirectionBatch::kCapacity / directions, 1, kReceivers));
  }

  /// For each receiver draws its light directions, estimates
  ///   throughput / n  sum_i f(wl_i) L(wl_i) cos(wl_i) / d(wl_i)
  /// with d the density of the strategy (combination.h), and queues every term that is not zero. `product` has a third
  /// density beside surface and lights: the products of the material's lobes with those of the sky; a vertex without
  /// products is lit as by `mis`.
  ///
  /// Surfaces that glow are lights like the others (counts_glow() says which), and directions meet them behind whatever
  /// shadow rays pass.
  ///
  /// Sharp lamps, which no drawn direction can meet, are added under every strategy: each once when there are at most
  /// kSharpLamps, else that many drawn by what they bring (Lighting::sharp_view).
  ///
  /// Contributions are clamped as those of Cycles' samples, each of which has one direction from the lights and one
  /// from the surface; where the strategy does not mix, one direction is a sample, and a sharp lamp is one, too.
  ///
  /// Where paths `go_on` from the vertices, one that drew a single direction from the surface side goes on along it:
  /// one ray, that of extend(), then serves as its shadow ray, too, and what it brings is in awaited().
  void gather(std::span<const Receiver> receivers, bool go_on, ShadowQueue& shadows,
              std::vector<CameraSample>& samples);

  /// What the last gather() left to rays of extend().
  std::span<const AwaitedLight> awaited() const { return awaited_; }

  /// Whether gather() has in its terms what the surface emits that a ray from its vertex has hit. Where it has not,
  /// the ray of extend() is who counts it: of surfaces that no rays are drawn to, under a strategy that draws none from
  /// the surface side.
  bool counts_glow(const Hit& hit) const {
    const GlowingSurfaces& glow = lighting_.glow();
    return meets_surfaces_ ? glow.holds(hit) : glow.draws(hit);
  }

  /// The ray with which the path goes on from the vertex that was number `place` of the last gather(), drawn from the
  /// surface side alone: what surfaces reflect was in no term of gather(), and what it meets beyond them (lamps,
  /// environment) was in all, so only surfaces may be counted at its end.
  std::optional<Continuation> extend(const Receiver& receiver, size_t place);

  /// The past of a path that goes on from that vertex with the ray of extend().
  PathPast past_after(const Receiver& receiver, size_t place, const Continuation& onward) const;

  /// Directions left out so far because their term was not finite.
  uint64_t nan_samples() const { return nan_samples_; }

  static constexpr int kSharpLamps = 4;
  static constexpr int kReceivers = 8;  // at most

 private:
  /// What is kept of a vertex until its batch is done.
  struct Work {
    PreparedBrdf prepared;
    LobeMixture product;  // world frame
    Shares shares;
    PathNumbers::Run from_product, from_surface, from_lights;
    int product_point, surface_point, light_point;  // the first of each in points_
    int product_direction;                          // the first in towards_products_
    bool goes_on_drawn;                             // along the one direction of the surface side
    std::optional<Continuation> continuation;       // along that
    int shared_term;                                // of terms_, which waits for the ray of `continuation`; -1: none
  };
  struct Output {
    ShadowQueue& shadows;
    std::vector<CameraSample>& samples;
  };

  void prepare(const Receiver& receiver, bool go_on, Work& work, const LightView& view);
  /// Asks for the points of all vertices, those of the lights in a row at the front.
  void make_points(std::span<const Receiver> receivers);
  /// Makes the products of the vertex, if it has any.
  Shares shares_at(const Vertex& vertex, const LightView& view, Work& work);
  float lights_part(const Vertex& vertex) const {
    return sky_->lights_part[static_cast<size_t>(vertex.surface - materials_.data())];
  }
  void draw_towards_lights(std::span<const Receiver> receivers);
  void draw_towards_products(std::span<const Receiver> receivers);
  void draw_from_surface(const Receiver& receiver, const Work& work);
  void draw_sharp(const Receiver& receiver);
  void keep_if_lit(const Vertex& vertex, const Vec3& wl, const Vec3& wl_world, Drawer drawer, uint8_t aim = 0);
  void keep_world(const Vertex& vertex, const DirectionBatch& drawn, int first, int count, Drawer drawer);
  /// Draws and reflects at one vertex.
  void shade(const Receiver& receiver, uint8_t place, Output output);
  void add_terms(const Receiver& receiver, uint8_t place);
  /// Has the path go on along direction `i` of the vertex, which is term number `term`.
  void go_on_along(const Receiver& receiver, int i, int term, Work& work);
  void settle(std::span<const Receiver> receivers, Output output);
  void settle_glow(std::span<const Receiver> receivers, Output output);
  struct Contribution {
    Vec3 wl_world;
    Rgb light;
    float limit;  // of the sum of its channels
    float far;    // where it comes from
    bool casts_shadow;
  };
  /// Queues what term number `term` brings, or has it wait for the ray of its path.
  void settle_term(std::span<const Receiver> receivers, int term, const Contribution& contribution, Output output);
  /// Whether it is light to wait for; light that casts no shadow has arrived.
  bool waits(const Receiver& receiver, const Contribution& contribution, Output output);
  void queue(const Receiver& receiver, const Contribution& contribution, Output output);
  /// Clamping limit for the contribution of one direction.
  float limit_of_term(const Receiver& receiver) const {
    return receiver.limit * (is_mixed(options_.strategy) ? 2.0f : 1.0f) / static_cast<float>(receiver.directions);
  }
  Rgb reflectance(const Vertex& vertex, int direction) const;

  const std::optional<Mat3>& working_space_;
  const std::vector<SurfaceMaterial>& materials_;
  const Lighting& lighting_;
  const RenderOptions& options_;
  const SurfaceSampling sampling_;
  const bool meets_surfaces_;  // whether any directions come from the surface side
  const bool shares_rays_;     // whether a shadow ray may be one with which a path goes on
  const SkySampler* sky_;

  Work work_[kReceivers];
  LightView views_[kReceivers];
  // Of all vertices.
  PointBatch points_;
  LobeDraws product_draws_;
  DirectionBatch towards_lights_, towards_products_;  // world
  Hit aims_[DirectionBatch::kCapacity];               // of towards_lights_, where anything glows
  LightTerms terms_;
  std::vector<AwaitedLight> awaited_;

  // Of one vertex: those drawn directions that can bring light, above both the shading horizon and the surface itself.
  // local_ goes on with the directions of sharp lamps.
  DirectionBatch drawn_, local_, world_;
  Drawer drawer_[DirectionBatch::kCapacity];
  uint8_t aim_[DirectionBatch::kCapacity];  // as LightTerms::aim
  RgbBatch f_;
  ScalarBatch material_pdf_, surface_pdf_, product_pdf_;
  LobeProducts products_;
  SharpLight sharp_[kSharpLamps];
  int sharp_count_ = 0;
  uint64_t nan_samples_ = 0;
};

}  // namespace velour
