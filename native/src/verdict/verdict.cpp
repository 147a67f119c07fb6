#include "verdict/verdict.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/parallel.h"
#include "brdf/fit/direction_tree.h"
#include "brdf/fit/error/evaluate.h"
#include "brdf/measure/irregular_samples.h"
#include "math/sphere/frame.h"
#include "verdict/surroundings.h"

namespace velour {

namespace {

// The shapes that a verdict looks at: their normals and tangents, pixel by pixel.

/// World: +x right, +y up, +z towards the viewer, who is infinitely far away.
struct Shape {
  struct Pixel {
    uint32_t index;  // in the picture, row by row from the top
    Frame frame;     // in the world; z: the normal, which faces the viewer; x: the tangent, along the brushing
  };
  std::vector<Pixel> pixels;  // those that show the shape
};

/// A ring seen obliquely: hollow parts, and surfaces that turn quickly and slowly.
Shape ring_shape(int side);

constexpr float kBallRadius = 0.94f;  // half the picture is 1
constexpr float kRingRadius = 0.64f, kTubeRadius = 0.3f;
constexpr float kRingTilt = 0.9f;  // radians, of the ring's axis against the view

Frame surface_frame(const Vec3& normal, const Vec3& along) {
  const Vec3 sideways = glm::cross(normal, along);
  const float length = glm::length(sideways);
  if (length < 1e-4f) return Frame::about(normal);
  const Vec3 y = sideways / length;
  return {glm::cross(y, normal), y, normal};
}

/// `frame_at(x, y)`: the surface at a point of the picture, or nothing.
template <class FrameAt>
Shape drawn(int side, const FrameAt& frame_at) {
  Shape shape;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const auto at = [&](int i) { return 2 * (static_cast<float>(i) + 0.5f) / static_cast<float>(side) - 1; };
      const std::optional<Frame> frame = frame_at(at(column), -at(row));
      if (frame) shape.pixels.push_back({static_cast<uint32_t>(row * side + column), *frame});
    }
  }
  return shape;
}

std::optional<Frame> ball_frame(float x, float y) {
  const float distance_sq = x * x + y * y;
  if (distance_sq >= kBallRadius * kBallRadius) return std::nullopt;
  const Vec3 normal = Vec3(x, y, std::sqrt(kBallRadius * kBallRadius - distance_sq)) / kBallRadius;
  return surface_frame(normal, {normal.z, 0, -normal.x});  // along the circles of latitude
}

/// Sphere tracing of the torus.
std::optional<Frame> ring_frame(float x, float y) {
  constexpr int kSteps = 96;
  constexpr float kClose = 1e-5f;
  const Vec3 axis(0, std::sin(kRingTilt), std::cos(kRingTilt));
  Vec3 p(x, y, 1);
  for (int i = 0; i < kSteps; ++i) {
    const float height = glm::dot(p, axis);
    const Vec3 outwards = p - height * axis;
    const float radius = std::max(glm::length(outwards), 1e-6f);
    const Vec3 from_tube = p - outwards * (kRingRadius / radius);
    const float distance = glm::length(from_tube) - kTubeRadius;
    if (distance < kClose) {
      const Vec3 normal = glm::normalize(from_tube);
      if (normal.z <= 0) return std::nullopt;
      return surface_frame(normal, glm::cross(axis, outwards));
    }
    p.z -= distance;
    if (p.z < -1) break;
  }
  return std::nullopt;
}

/// A picture of `side` x `side` pixels of a ball, which shows every angle between view and surface evenly.
Shape ball_shape(int side) { return drawn(side, ball_frame); }
Shape ring_shape(int side) { return drawn(side, ring_frame); }

constexpr int kPictureSide = 80;
constexpr int kParts = 256, kOwnLights = 256;  // of the tree of light directions; of the material's own sampler
constexpr float kBackdrop = 0.1f;              // of exposed pictures

/// Views that stand for all: polar angles in equal steps, and azimuths unless all materials are isotropic.
class ViewBins {
 public:
  explicit ViewBins(bool isotropic) : polar_(isotropic ? 48 : 24), azimuths_(isotropic ? 1 : 48) {}

  size_t count() const { return static_cast<size_t>(polar_ * azimuths_); }
  size_t of(const Vec3& wv) const {
    const float theta = std::acos(std::clamp(wv.z, 0.0f, 1.0f));
    const int polar = std::min(static_cast<int>(theta / (0.5f * kPi) * static_cast<float>(polar_)), polar_ - 1);
    const float turn = std::atan2(wv.y, wv.x) / (2 * kPi) + 1;
    const int azimuth = static_cast<int>(std::lround(turn * static_cast<float>(azimuths_))) % azimuths_;
    return static_cast<size_t>(polar * azimuths_ + azimuth);
  }
  float theta(size_t bin) const {
    return (static_cast<float>(bin / static_cast<size_t>(azimuths_)) + 0.5f) * 0.5f * kPi / static_cast<float>(polar_);
  }
  float phi(size_t bin) const {
    return 2 * kPi * static_cast<float>(bin % static_cast<size_t>(azimuths_)) / static_cast<float>(azimuths_);
  }

 private:
  int polar_, azimuths_;
};

/// The mean of each f with that of the exchanged pair, where that is covered.
void make_reciprocal(const Measurement& measurement, const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f) {
  for (size_t i = 0; i < wl.size(); ++i) {
    Rgb value;
    uint8_t covered = 0;
    measurement.eval(wl[i], {&wv, 1}, {&value, 1}, {&covered, 1});
    if (covered) f[i] = 0.5f * (f[i] + value);
  }
}

/// A direction in each leaf of the measurement's tree and directions from the material's own sampler, which find its
/// narrow lobes anywhere, joined by the balance heuristic [VG95] as a quadrature.
WeightedLights lights_of(const Measurement& measurement, const Material& material, const Vec3& wv) {
  const DirectionTree tree(reader_of(measurement, wv), wv, kParts);
  ScratchArena arena;
  const PreparedBrdf* const point = material.prepare(wv, arena);
  std::vector<Vec3> all;
  for (const uint32_t leaf : tree.leaves()) all.push_back(tree.cell(leaf).wl);
  const size_t leaves = all.size();
  for (int i = 0; i < kOwnLights; ++i) {
    const double v = kGoldenRatio * i;
    all.push_back(point->sample_one(Vec2((i + 0.5) / kOwnLights, v - std::floor(v))));
  }
  std::vector<float> own(all.size());
  evaluate(material, wv, all, {}, own);
  WeightedLights lights;
  for (size_t i = 0; i < all.size(); ++i) {
    const bool sampled = i < leaves || own[i] > 0.0f;
    if (all[i].z <= 0 || !sampled) continue;
    lights.wl.push_back(all[i]);
    lights.weight.push_back(1 / (1 / tree.leaf_at(all[i]).solid_angle() + kOwnLights * static_cast<double>(own[i])));
  }
  return lights;
}

/// The lights of a view, and what the measurement and the material reflect from each.
Surroundings::Lights lights_in(const Measurement& measurement, const Material& material, Against against,
                               const Vec3& wv, const Surroundings& surroundings) {
  const WeightedLights lights = lights_of(measurement, material, wv);
  const size_t count = lights.wl.size();
  std::vector<Rgb> measured(count), shown(count);
  std::vector<uint8_t> covered(count);
  measurement.eval(wv, lights.wl, measured, covered);
  if (against == Against::reciprocal_mean) make_reciprocal(measurement, wv, lights.wl, measured);
  evaluate(material, wv, lights.wl, shown);
  Surroundings::Lights out;
  for (size_t i = 0; i < count; ++i) {
    if (!covered[i]) continue;
    const float weight = static_cast<float>(lights.weight[i]) * lights.wl[i].z;
    // Colors outside Rec. 709 as renders of a measurement show them (measured_values).
    out.add(surroundings, lights.wl[i], lights.weight[i],
            {weight * glm::max(measured[i], 0.0f), weight * glm::max(shown[i], 0.0f)});
  }
  return out;
}

/// The frame of `surface` turned about its normal so that the viewer, at +z, has the azimuth of the bin.
Frame frame_in_bin(const Frame& surface, float phi) {
  const Vec3 towards(-surface.z.z * surface.z.x, -surface.z.z * surface.z.y, 1 - surface.z.z * surface.z.z);
  const float length = glm::length(towards);
  const Vec3 p = length > 1e-4f ? towards / length : surface.x, q = glm::cross(surface.z, p);
  return {std::cos(phi) * p - std::sin(phi) * q, std::sin(phi) * p + std::cos(phi) * q, surface.z};
}

/// Radiance of one pixel in each environment.
struct PixelRadiance {
  Rgb measured[Surroundings::kCount]{}, shown[Surroundings::kCount]{};
};

PixelRadiance lit(const Frame& frame, const Surroundings::Lights& lights, const Surroundings& surroundings) {
  const auto [measured, shown] = surroundings.reflected(frame, lights);
  PixelRadiance out;
  for (size_t e = 0; e < Surroundings::kCount; ++e) {
    out.measured[e] = {measured[4 * e], measured[4 * e + 1], measured[4 * e + 2]};
    out.shown[e] = {shown[4 * e], shown[4 * e + 1], shown[4 * e + 2]};
  }
  return out;
}

/// The pixels of a shape whose views are measured, with their radiances.
struct LitShape {
  std::vector<uint32_t> object;
  std::vector<float> view_angle;
  std::vector<PixelRadiance> radiance;
};

PicturePair exposed(const LitShape& lit_shape, size_t environment) {
  double measured = 0, shown = 0;
  for (const PixelRadiance& r : lit_shape.radiance) {
    measured += luminance(r.measured[environment]);
    shown += luminance(r.shown[environment]);
  }
  const LinearPicture backdrop{kPictureSide, kPictureSide,
                               std::vector<Rgb>(static_cast<size_t>(kPictureSide * kPictureSide), Rgb(kBackdrop))};
  PicturePair out{backdrop, backdrop, 1, lit_shape.object, lit_shape.view_angle, 1};
  if (measured > 0) {
    out.exposure = kPhotographicGray * static_cast<double>(lit_shape.object.size()) / measured;
    out.luminance_ratio = shown / measured;
  }
  const auto scale = static_cast<float>(out.exposure);
  for (size_t i = 0; i < lit_shape.object.size(); ++i) {
    const PixelRadiance& r = lit_shape.radiance[i];
    out.measured.pixels[lit_shape.object[i]] = scale * r.measured[environment];
    out.shown.pixels[lit_shape.object[i]] = scale * r.shown[environment];
  }
  return out;
}

}  // namespace

std::vector<PicturePair> picture_pairs(const Measurement& measurement, const Material& material, Against against,
                                       int threads, Progress& progress) {
  const Surroundings surroundings;
  const ViewBins bins(measurement.isotropic() && material.isotropic());
  const std::vector<Shape> shapes{ball_shape(kPictureSide), ring_shape(kPictureSide)};
  std::vector<uint8_t> needed(bins.count());
  const auto bin_of = [&](const Shape::Pixel& pixel) { return bins.of(pixel.frame.to_local({0, 0, 1})); };
  for (const Shape& shape : shapes) {
    for (const Shape::Pixel& pixel : shape.pixels) needed[bin_of(pixel)] = 1;
  }
  std::vector<Surroundings::Lights> views(bins.count());
  parallel_pieces(bins.count(), threads, progress, [&](size_t bin) {
    if (!needed[bin] || !measurement.covers_view(bins.theta(bin))) return;
    views[bin] = lights_in(measurement, material, against, direction(bins.theta(bin), bins.phi(bin)), surroundings);
  });
  std::vector<PicturePair> pairs;
  for (const Shape& shape : shapes) {
    LitShape lit_shape;
    std::vector<const Shape::Pixel*> pixels;
    for (const Shape::Pixel& pixel : shape.pixels) {
      const size_t bin = bin_of(pixel);
      if (views[bin].empty()) continue;
      pixels.push_back(&pixel);
      lit_shape.object.push_back(pixel.index);
      lit_shape.view_angle.push_back(bins.theta(bin));
    }
    lit_shape.radiance.resize(pixels.size());
    constexpr size_t kRun = 64;  // pixels of a piece of work
    parallel_pieces((pixels.size() + kRun - 1) / kRun, threads, progress, [&](size_t run) {
      for (size_t i = run * kRun; i < std::min(pixels.size(), (run + 1) * kRun); ++i) {
        const size_t bin = bin_of(*pixels[i]);
        lit_shape.radiance[i] = lit(frame_in_bin(pixels[i]->frame, bins.phi(bin)), views[bin], surroundings);
      }
    });
    for (size_t e = 0; e < Surroundings::kCount; ++e) pairs.push_back(exposed(lit_shape, e));
  }
  return pairs;
}

namespace {

constexpr double kMissed = 1.0;  // relative L2 error of held-out samples: no better than black

/// What the measurement itself is to blame for, before what stands out in the pictures.
void explain(const Measurement& measurement, const Material& material, const std::vector<PicturePair>& pairs,
             int threads, Progress& progress, Verdict& verdict) {
  const auto because = [&](LookReason reason, double value) { verdict.reason = reason, verdict.value = value; };
  const auto smooth = picture_pairs(measurement, material, Against::reciprocal_mean, threads, progress);
  const double against_smooth = verdict_of(smooth, progress).value().flip_mean;
  if (explains(against_smooth, verdict)) return because(LookReason::measurement_noise, against_smooth);
  const double gap = gap_of_unresolved_highlights(measurement.samples());
  if (gap > 0) return because(LookReason::unresolved_highlights, gap * 180 / kPiD);
  explain_look(pairs, progress, verdict);
}

}  // namespace

std::optional<Verdict> judge_look(const Measurement& measurement, const Material& material, bool explained, int threads,
                                  Progress& progress) {
  const auto pairs = picture_pairs(measurement, material, Against::measurement, threads, progress);
  std::optional<Verdict> verdict = verdict_of(pairs, progress);
  if (verdict && verdict->quality != LookQuality::good && explained) {
    explain(measurement, material, pairs, threads, progress, *verdict);
  }
  return verdict;
}

void lower_for_samples(const FitRecord& record, Verdict& verdict) {
  const auto lower = [&](LookQuality quality, LookReason reason, double value) {
    if (verdict.quality < quality) verdict.quality = quality, verdict.reason = reason, verdict.value = value;
  };
  const auto is_anisotropic = [](const Warning& w) { return w.code == WarningCode::anisotropic_samples; };
  if (std::ranges::any_of(record.warnings, is_anisotropic)) {
    lower(LookQuality::poor, LookReason::anisotropic_samples, 0);
  }
  double worst = 0;
  for (const auto& [angle, error] : record.by_view_angle) worst = std::max(worst, error.value_or(0));
  if (!record.all_data && worst > kMissed) lower(LookQuality::fair, LookReason::held_out_samples, worst);
}

}  // namespace velour
