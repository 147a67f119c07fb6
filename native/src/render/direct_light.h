// Light that reaches a vertex straight from lamps and environment: the estimator of every strategy.
#pragma once

#include <optional>

#include "render/combination.h"
#include "render/direction_sampling.h"
#include "render/lighting.h"
#include "render/path_numbers.h"
#include "render/shadow_queue.h"
#include "render/sky_proposals.h"

namespace velour {

/// What is gathered for.
struct Receiver {
  uint32_t sample;  // number of the camera sample
  Rgb throughput;
};

/// One a thread: owns the scratch batches of the vertex in work. Call prepare(), then the others for that vertex.
class DirectLight {
 public:
  /// `sky` serves `product` and is null for the others.
  DirectLight(const Scene& scene, const Lighting& lighting, const RenderOptions& options, const SkyProposals* sky)
      : working_space_(scene.rec709_to_working()),
        lighting_(lighting),
        options_(options),
        sampling_(surface_sampling(options.strategy)),
        sky_(sky) {}

  void prepare(const Vertex& vertex) {
    vertex.surface->material->prepare(vertex.wv, prepared_);
    prepare_surface(sampling_, vertex, prepared_);
  }

  /// Draws `directions` light directions, estimates
  ///   throughput / n  sum_i f(wl_i) L(wl_i) cos(wl_i) / d(wl_i)
  /// with d the density of the strategy (combination.h), and queues every term that is not zero. `full`: directions of
  /// a camera ray that is not the last of its pixel. `product` has a third density beside surface and lights: the
  /// products of the material's lobes with those of the sky; a vertex without products is lit as by `mis`.
  ///
  /// Sharp lamps, which no drawn direction can meet, are added under every strategy: each once when there are at most
  /// kSharpLamps, else that many drawn in proportion to power.
  struct Draws {
    int count, full;
  };
  void gather(const Vertex& vertex, Draws draws, PathNumbers& numbers, const Receiver& receiver, ShadowQueue& shadows,
              std::vector<CameraSample>& samples);

  struct Continuation {
    Ray ray;
    Rgb throughput;
  };
  /// One more ray, drawn from the surface side alone: what it meets on surfaces was in no term of gather(), and what it
  /// meets beyond them (lamps, environment) was in all, so only surfaces may be counted at its end.
  std::optional<Continuation> extend(const Vertex& vertex, PathNumbers& numbers, const Rgb& throughput);

  /// Directions left out so far because their term was not finite.
  uint64_t nan_samples() const { return nan_samples_; }

  static constexpr int kSharpLamps = 4;

 private:
  void draw(const Vertex& vertex, Draws draws, PathNumbers& numbers);
  void keep_if_lit(const Vertex& vertex, const Vec3& wl, const Vec3& wl_world);
  void draw_from_product(const Vertex& vertex, PathNumbers::Run run, PathNumbers& numbers);
  void draw_from_surface(const Vertex& vertex, PathNumbers::Run run, PathNumbers& numbers);
  void draw_from_lights(const Vertex& vertex, PathNumbers::Run run, PathNumbers& numbers);
  /// Makes the products of the vertex, if it has any; the share of directions that they draw.
  float product_share(const Vertex& vertex);
  void draw_sharp(const Vertex& vertex, PathNumbers& numbers);
  void weigh(const Vertex& vertex, int directions);
  void queue(const Vertex& vertex, const Receiver& receiver, int direction, Rgb light, float far, bool casts_shadow,
             ShadowQueue& shadows, std::vector<CameraSample>& samples);
  Rgb reflectance(const Vertex& vertex, int direction) const;

  const std::optional<Mat3>& working_space_;
  const Lighting& lighting_;
  const RenderOptions& options_;
  const SurfaceSampling sampling_;
  const SkyProposals* sky_;

  struct Sharp {
    const Lamp* lamp;
    float distance;
    Rgb irradiance;  // perpendicular, over the probability of having been chosen
  };

  PreparedBrdf prepared_;
  // Those drawn directions that can bring light: above both the shading horizon and the surface itself. local_ goes on
  // with the directions of sharp lamps.
  DirectionBatch local_, world_;
  int end_[2] = {0, 0};  // where those drawn from products end, and those from the surface; the lights drew the rest
  DirectionBatch towards_light_;
  LobeProducts products_;
  LobeMixture product_;      // world frame
  Combination combination_;  // of the vertex in work
  RgbBatch f_, environment_;
  ScalarBatch material_pdf_, light_pdf_, surface_pdf_, product_pdf_;
  float weight_[DirectionBatch::kCapacity];  // cos / (n d)
  std::vector<LampHit> lamp_hits_;
  Sharp sharp_[kSharpLamps];
  int sharp_count_ = 0;
  uint64_t nan_samples_ = 0;
};

}  // namespace velour
