// Direct light at vertices, from lights and the environment: the estimator of every strategy.
#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <vector>
#include "math/sphere/directions.h"
#include "math/srbf/lobe_mixture.h"
#include "render/lights/lighting.h"
#include "render/path/direction_sampling.h"
#include "render/path/path_numbers.h"
#include "render/path/shadow_queue.h"
#include "render/scene_samplers.h"

namespace velour {

// Directions of several vertices whose light is looked up together.

/// Each direction contributes  reflected x radiance / d,  with d the density of direction_sampling.h. Light is looked
/// up for a whole batch, so that all fetches of environment texels are in flight together and vectors are full.
///
/// Directions aimed at emissive meshes carry the light of these alone, other light-sampled directions carry none of it,
/// and the remaining ones carry both. Each kind of light is weighted with the densities of the techniques that carry
/// it: the environment by the chosen `heuristic`, lights and meshes by kLampHeuristic.
struct alignas(64) LightTerms {
  DirectionBatch world;
  RgbBatch reflected;            // throughput f cos / n of n directions
  ScalarBatch product, surface;  // share of a technique times its density
  ScalarBatch light_share;
  Technique technique[DirectionBatch::kCapacity];  // technique that sampled it
  uint8_t receiver[DirectionBatch::kCapacity];     // index of the vertex in the batch
  uint8_t aim[DirectionBatch::kCapacity];          // 0: none; otherwise 1 + index among the aims (Lighting::sample)

  // Results of look_up().
  RgbBatch environment;             // radiance
  ScalarBatch weight, lamp_weight;  // 1 / d: for the environment, and for lights where one is hit
  ScalarBatch light_pdf;            // of Lighting::sample, without directions aimed at emissive meshes
  std::vector<LampHit> lamp_hits;
  struct EmissiveTerm {
    int direction;
    Hit hit;
    float weight;  // 1 / d
    float pdf;     // of Lighting::sample aiming there; 0 unless lights are sampled
  };
  std::vector<EmissiveTerm> emissive;

  void clear() {
    world.count = 0;
    lamp_hits.clear();
    emissive.clear();
  }
  /// `views`: by index of the vertex.
  void look_up(const Lighting& lighting, std::span<const LightView> views, Heuristic heuristic);
  /// `rays`: along the directions, starting at their vertices. `kinds`: theirs, bits of `hidden`.
  void look_up_emissive(const Lighting& lighting, std::span<const LightView> views, std::span<const Hit> aims,
                        std::span<const Ray> rays, std::span<const uint8_t> kinds);

 private:
  /// 1 / d; `pdf`: of the technique that samples the light.
  float weighed(Heuristic heuristic, int direction, float pdf) const;
  void find_emissive(const EmissiveMeshes& surfaces, std::span<const Hit> aims, std::span<const Ray> rays,
                     std::span<const uint8_t> kinds);
  std::vector<EmissiveHit> found_;
};

/// A vertex that gathers light.
struct Receiver {
  Vertex vertex;
  PathNumbers* numbers;
  Rgb throughput;
  uint32_t sample;  // index of the camera sample
  int directions;   // number of directions to sample
  int full;         // number of directions of a camera ray other than the last of its pixel
  PathPast past{};
  float limit = std::numeric_limits<float>::infinity();  // LightPathOptions::limit
  const Mixing* mixing = nullptr;                        // null: that of the strategy
};

/// Light that arrives if the continuation ray of a vertex hits nothing closer than `far`.
struct AwaitedLight {
  size_t place;  // index of the vertex among the receivers, later of the path among those that continue
  Rgb light;
  float limit;  // maximum sum of its channels
  float far;
};

/// Light that arrives at a vertex, direction by direction: the terms of DirectLight without f.
struct IncidentLight {
  struct Term {
    uint32_t direction;  // several terms may have the same one
    Vec3 wl;             // local
    Rgb light;           // radiance |cos| / (n d), as if nothing were in the way
    float density;       // of Lighting::sample in that direction
    Ray shadow_ray;
    bool casts_shadow;
  };
  std::vector<Term> terms;
  /// Along a direction sampled from the surface, with a throughput of |cos| / (their number times the density): the
  /// surface that it hits reflects more light. Its emission is in the terms where DirectLight::counts_emissive().
  struct Path {
    uint32_t direction;
    Continuation along;
  };
  std::vector<Path> paths;
};

/// One per thread: owns the scratch memory of the vertices being processed. They are processed together, as many as fit
/// in a batch of directions: all share memory and vectors while their lobes stay in the cache.
class DirectLight {
 public:
  /// `sky` is needed for products; null: there are none.
  DirectLight(const Scene& scene, const Lighting& lighting, const RenderOptions& options,
              const EnvironmentProductSampler* sky)
      : working_space_(scene.rec709_to_working()),
        materials_(scene.materials()),
        lighting_(lighting),
        options_(options),
        sampling_(surface_sampling(options.strategy)),
        mixing_(mixing_of(options)),
        shares_rays_(VisibleRays(scene).plain()),
        environment_hidden_(scene.environment_hidden()),
        even_sky_(!lighting.environment().black() && lighting.environment().equirectangular() == nullptr),
        sky_(sky) {}

  /// Number of vertices with up to `directions` directions each that gather() takes.
  static size_t receivers_of(int directions) {
    return static_cast<size_t>(std::clamp(DirectionBatch::kCapacity / directions, 1, kReceivers));
  }

  /// For each receiver, samples its light directions, estimates
  ///   throughput / n  sum_i f(wl_i) L(wl_i) cos(wl_i) / d(wl_i)
  /// with d the density of the strategy (direction_sampling.h), and queues every nonzero term. `product` has a third
  /// density beside surface and lights: the products of the material's lobes with those of the environment. A vertex
  /// without products is lit as by `mis`.
  ///
  /// Emissive meshes are lights like the others (see counts_emissive()). Directions hit them behind whatever shadow
  /// rays pass through.
  ///
  /// Delta lights, which no sampled direction can hit, are added under every strategy: each once if there are at most
  /// kDeltaLights, otherwise that many sampled by contribution (Lighting::sharp_view).
  ///
  /// Contributions are clamped like Cycles' samples, each of which has one direction from the lights and one from the
  /// surface. For strategies that are not mixed, one direction is a sample; a delta light is one as well.
  ///
  /// Lobes without width (DeltaLobes) are added one by one, along a ray each, without other techniques.
  ///
  /// If paths `go_on` from the vertices, a path with a single surface-sampled direction continues along it: the ray of
  /// extend() then also serves as its shadow ray, and the light is in awaited().
  void gather(std::span<const Receiver> receivers, bool go_on, ShadowQueue& shadows,
              std::vector<CameraSample>& samples);

  /// Replaces `incident` by terms of up to `directions` (at most 64) directions at one vertex, and by paths if they may
  /// `go_on`. The same estimator as gather(), except that delta lights are left to find_sharp_light().
  /// Without lights that directions can hit, all are sampled from the surface.
  void gather_incident(const Vertex& vertex, PathNumbers& numbers, int directions, bool go_on, IncidentLight& incident);

  /// Light of the last gather() that depends on rays of extend().
  std::span<const AwaitedLight> awaited() const { return awaited_; }

  /// Whether the terms of vertex `place` of the last gather() include the light of all emitters. Otherwise they include
  /// that of light-sampled emitters alone, since the vertex samples no directions from the surface.
  bool counts_all_emissive(size_t place) const { return work_[place].counts_all_emissive; }
  /// The same for all vertices of gather_incident().
  bool counts_all_emissive() const { return shares(mixing_).surface > 0.0f; }
  /// Whether the terms of a vertex include the emission of the surface hit by a ray from there. Otherwise extend() must
  /// add it. `all`: counts_all_emissive() of the vertex.
  bool counts_emissive(const Hit& hit, bool all) const {
    return all ? lighting_.emissive().holds(hit) : lighting_.emissive().draws(hit);
  }

  /// Whether light is finite; otherwise it must be dropped, and is counted in nan_samples().
  bool keeps(const Rgb& light);

  /// Continuation ray of vertex `place` of the last gather(), sampled from the surface alone, or along one of its lobes
  /// without width, by their shares of the light. gather() included no
  /// light reflected by surfaces, but all light from lights and the environment, so only surfaces may be counted at the
  /// end of the ray.
  std::optional<Continuation> extend(const Receiver& receiver, size_t place);

  /// PathPast of the path that continues from that vertex with the ray of extend().
  PathPast past_after(const Receiver& receiver, size_t place, const Continuation& continuation) const;

  /// Number of directions and emissions dropped so far because their light was not finite.
  uint64_t nan_samples() const { return nan_samples_; }

  static constexpr int kDeltaLights = 4;
  static constexpr int kReceivers = 8;  // maximum number of vertices in a batch

 private:
  /// State of a vertex until its batch is done.
  struct Work {
    PreparedSurface prepared;       // in arena_
    const PreparedBrdf* under_sky;  // in arena_; replaces `prepared` under an environment of one color if not null
    LobeMixture product;            // world frame
    Shares shares;
    bool counts_all_emissive;
    PathNumbers::Run from_product, from_surface, from_lights;
    int product_point, surface_point, light_point;  // index of the first of each in points_
    int product_direction;                          // index of the first in towards_products_
    bool goes_on_drawn;                             // continues along its only surface-sampled direction
    bool goes_on_along_all;                         // along all of them, for incident light
    DeltaLobes deltas;
    int along_delta;                           // the lobe that the path continues along; -1: none
    float along_share;                         // probability of continuing so
    std::optional<Continuation> continuation;  // the ray along it
    int shared_term;                           // index of the term waiting for `continuation`; -1: none
  };
  /// Either shadow rays for camera samples, or incident light.
  struct Output {
    ShadowQueue* shadows;
    std::vector<CameraSample>* samples;
    IncidentLight* incident;
    bool is_incident() const { return incident != nullptr; }
  };

  void prepare(const Receiver& receiver, bool go_on, Output output, Work& work, const LightView& view);
  void gather(std::span<const Receiver> receivers, bool go_on, Output output);
  /// Requests the points of all vertices; those for the lights come first, contiguously.
  void make_points(std::span<const Receiver> receivers);
  /// Computes the products of the vertex, if it has any.
  Shares shares_at(const Receiver& receiver, const LightView& view, Work& work);
  float lights_part(const Vertex& vertex) const {
    return sky_->lights_part[static_cast<size_t>(vertex.surface - materials_.data())];
  }
  void draw_towards_lights(std::span<const Receiver> receivers);
  void draw_towards_products(std::span<const Receiver> receivers);
  void draw_from_surface(const Receiver& receiver, const Work& work);
  void draw_sharp(const Receiver& receiver);
  /// Chooses between continuing along a lobe without width and along what eval() describes.
  void choose_continuation(const Receiver& receiver, bool go_on, Work& work);
  void gather_deltas(std::span<const Receiver> receivers, Output output);
  void add_deltas(const Receiver& receiver, uint8_t place);
  void keep_if_lit(const Vertex& vertex, const Vec3& wl, const Vec3& wl_world, Technique technique, uint8_t aim = 0);
  void keep_world(const Vertex& vertex, const DirectionBatch& drawn, int first, int count, Technique technique);
  /// Samples and reflects at one vertex.
  void shade(const Receiver& receiver, uint8_t place, Output output);
  void add_terms(const Receiver& receiver, uint8_t place, Output output);
  /// Adds continuations along the directions of the vertex that were sampled from the surface.
  void add_continuations(const Vertex& vertex, const Work& work, IncidentLight& incident);
  /// Continues the path along direction `i` of the vertex, which is term `term`.
  void go_on_along(const Receiver& receiver, int i, int term, Work& work);
  void settle(std::span<const Receiver> receivers, Output output);
  /// Throughput times f cos of a term over the number of directions, for the environment.
  Rgb reflected_sky(std::span<const Receiver> receivers, int term) const;
  void settle_emissive(std::span<const Receiver> receivers, Output output);
  struct Contribution {
    Vec3 wl_world;
    Rgb light;
    float limit;  // maximum sum of the channels
    float far;    // distance of the light
    bool casts_shadow;
    float density;          // of Lighting::sample; infinite for delta lights
    bool of_smooth = true;  // its shadow ray is Vertex::shadow_ray(), not ray()
    /// Cycles finds it only by continued rays: what these pass through does not block it.
    bool by_bounces = false;
  };
  /// Queues the contribution of term `term`, makes it wait for the ray of its path, or adds it to the incident light.
  void settle_term(std::span<const Receiver> receivers, int term, const Contribution& contribution, Output output);
  /// Whether the contribution is nonzero and needs a shadow ray. Light that casts no shadow is added at once.
  bool waits(const Receiver& receiver, const Contribution& contribution, Output output);
  void queue(const Receiver& receiver, const Contribution& contribution, Output output);
  /// Clamping limit for the contribution of one direction.
  float limit_of_term(const Receiver& receiver) const {
    if (along_deltas_) return receiver.limit;
    return receiver.limit * (is_mixed(options_.strategy) ? 2.0f : 1.0f) / static_cast<float>(receiver.directions);
  }
  Rgb reflectance(const Vertex& vertex, int direction) const;
  void add_incident(const Vertex& vertex, int term, const Contribution& contribution, IncidentLight& incident);

  const std::optional<Mat3>& working_space_;
  const std::vector<SurfaceMaterial>& materials_;
  const Lighting& lighting_;
  const RenderOptions& options_;
  const SurfaceSampling sampling_;
  const Mixing mixing_;     // of the strategy
  const bool shares_rays_;  // whether a continuation ray may also serve as a shadow ray
  const uint8_t environment_hidden_;
  const bool even_sky_;  // the environment has one color
  const EnvironmentProductSampler* sky_;

  ScratchArena arena_;  // for the points of a batch, until the next gather()
  Work work_[kReceivers];
  LightView views_[kReceivers];
  // For all vertices of the batch.
  PointBatch points_;
  LobeDraws product_draws_;
  DirectionBatch towards_lights_, towards_products_;  // world
  Hit aims_[DirectionBatch::kCapacity];               // targets of towards_lights_, if any mesh emits
  LightTerms terms_;
  std::vector<AwaitedLight> awaited_;

  // For one vertex: the sampled directions that can carry light, above both the shading horizon and the surface itself.
  // local_ additionally holds the directions of delta lights at its end.
  DirectionBatch drawn_, local_, world_;
  Technique technique_[DirectionBatch::kCapacity];
  uint8_t aim_[DirectionBatch::kCapacity];  // see LightTerms::aim
  RgbBatch f_;
  ScalarBatch material_pdf_, surface_pdf_, product_pdf_;
  LobeProducts products_;
  bool along_deltas_ = false;  // whether terms_ are those of lobes without width
  SharpLight sharp_[kDeltaLights];
  int sharp_count_ = 0;
  uint64_t nan_samples_ = 0;
};

}  // namespace velour
