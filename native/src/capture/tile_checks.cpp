#include "capture/tile_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "file/file.h"
#include "material/material.h"
#include "sphere/directions.h"
#include "sphere/sobol.h"

namespace velour {
namespace {

/// Heights of the first hits of vertical rays from above; the tile's bottom for rays that hit nothing.
class Heights {
 public:
  explicit Heights(const RepeatedTile& tile) : tile_(tile), rays_(tile) {}

  const std::vector<float>& at(std::span<const Vec2> places) {
    std::vector<Ray> down;
    for (const Vec2& p : places) down.push_back({Vec3(tile_.into_cell(p), tile_.top() + reach()), 0, {0, 0, -1}});
    hits_.resize(down.size());
    rays_.intersect(down, hits_, nullptr);
    heights_.clear();
    for (const Hit& hit : hits_) {
      heights_.push_back(hit.instance == kNoHit ? tile_.bottom() : tile_.surface(tile_.of_scene(hit)).position.z);
    }
    return heights_;
  }
  bool missed_any() const {
    return std::any_of(hits_.begin(), hits_.end(), [](const Hit& hit) { return hit.instance == kNoHit; });
  }

 private:
  float reach() const { return 1e-5f * (tile_.thickness() + tile_.period().x); }
  const RepeatedTile& tile_;
  TileRays rays_;
  std::vector<Hit> hits_;
  std::vector<float> heights_;
};

struct Jumps {
  double share = 0;  // of places where the surface jumps by more than kJump of the thickness
  double rms = 0;    // of all places
};
constexpr double kJump = 0.02, kRounding = 1e-5;  // relative to the thickness; to the period

/// Jumps across the line x (axis 0) or y (axis 1) = `at` periods.
Jumps jumps_across(Heights& heights, const RepeatedTile& tile, int axis, float at) {
  constexpr int kPlaces = 256;
  constexpr float kAside = 1e-4f;  // periods
  std::vector<Vec2> before, after;
  for (int i = 0; i < kPlaces; ++i) {
    Vec2 p(0);
    p[1 - axis] = (static_cast<float>(i) + 0.5f) / kPlaces;
    p[axis] = at - kAside;
    before.push_back(p * tile.period());
    p[axis] = at + kAside;
    after.push_back(p * tile.period());
  }
  const std::vector<float> a = heights.at(before), b = heights.at(after);
  const double least =
      std::max(kJump * static_cast<double>(tile.thickness()), kRounding * static_cast<double>(tile.period()[axis]));
  Jumps jumps;
  for (size_t i = 0; i < a.size(); ++i) {
    const double jump = std::abs(static_cast<double>(a[i] - b[i]));
    jumps.share += (jump > least ? 1.0 : 0.0) / kPlaces;
    jumps.rms += jump * jump / kPlaces;
  }
  jumps.rms = std::sqrt(jumps.rms);
  return jumps;
}

template <typename T>
std::span<const uint8_t> bytes_of(std::span<const T> values) {
  return {reinterpret_cast<const uint8_t*>(values.data()), values.size_bytes()};
}

/// f for a few pairs of directions, which serves as the identity of a material.
std::vector<Rgb> probe(const Material& material) {
  std::vector<Rgb> values;
  PreparedBrdf point;
  for (const Vec3& wv : hemisphere_fibonacci(5)) {
    material.prepare(wv, point);
    for (const Vec3& wl : hemisphere_fibonacci(7)) values.push_back(material.eval_one(point, wl).f);
  }
  return values;
}

}  // namespace

bool is_open(const RepeatedTile& tile) {
  std::vector<Vec2> places(4096);
  sobol_points(0, 0, places);
  for (Vec2& p : places) p *= tile.period();
  Heights heights(tile);
  heights.at(places);
  return heights.missed_any();
}

std::optional<std::string> seam_warning(const RepeatedTile& tile) {
  Heights heights(tile);
  for (int axis = 0; axis < 2; ++axis) {
    const Jumps border = jumps_across(heights, tile, axis, 0);
    double inside = 0;
    for (const float at : {0.13f, 0.29f, 0.41f, 0.53f, 0.67f, 0.79f, 0.91f}) {
      inside = std::max(inside, jumps_across(heights, tile, axis, at).share);
    }
    if (border.share <= inside + 0.1) continue;
    std::array<char, 320> text{};
    std::snprintf(text.data(), text.size(),
                  "The tile does not repeat seamlessly along %c: its surface jumps by more than %g %% of its thickness "
                  "across %.0f %% of its border (RMS %.3g of a thickness of %.3g), but across %.0f %% or less of lines "
                  "inside. The seam will be visible. Set the period, or make the borders match.",
                  axis == 0 ? 'x' : 'y', 100 * kJump, 100 * border.share, border.rms,
                  static_cast<double>(tile.thickness()), 100 * inside);
    return text.data();
  }
  return std::nullopt;
}

std::string tile_hash(const Scene& scene, const Progress& progress) {
  constexpr size_t kPiece = 1 << 23;
  std::string parts;
  const auto add = [&](std::span<const uint8_t> bytes) {
    for (size_t done = 0; done < bytes.size(); done += kPiece) {
      progress.check();
      parts += sha256_hex(bytes.subspan(done, std::min(kPiece, bytes.size() - done)));
    }
  };
  for (const Mesh& mesh : scene.meshes()) {
    add(bytes_of(mesh.positions()));
    add(bytes_of(mesh.triangles()));
  }
  for (const Scene::Instance& i : scene.instances()) {
    add(bytes_of(std::span<const float>(i.object_to_world.m)));
    add(bytes_of(std::span<const uint32_t>(i.materials)));
  }
  for (const SurfaceMaterial& m : scene.materials()) add(bytes_of(std::span<const Rgb>(probe(*m.material))));
  return sha256_hex({reinterpret_cast<const uint8_t*>(parts.data()), parts.size()});
}

}  // namespace velour
