#include "capture/btf/tile_checks.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <vector>
#include "base/file.h"
#include "capture/btf/view_capture.h"
#include "math/sphere/random.h"

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

}  // namespace

bool is_open(const RepeatedTile& tile) {
  std::vector<Vec2> places(4096);
  sobol_points(0, 0, places);
  for (Vec2& p : places) p *= tile.period();
  Heights heights(tile);
  heights.at(places);
  return heights.missed_any();
}

std::optional<Warning> seam_warning(const RepeatedTile& tile) {
  Heights heights(tile);
  for (int axis = 0; axis < 2; ++axis) {
    const Jumps border = jumps_across(heights, tile, axis, 0);
    double inside = 0;
    for (const float at : {0.13f, 0.29f, 0.41f, 0.53f, 0.67f, 0.79f, 0.91f}) {
      inside = std::max(inside, jumps_across(heights, tile, axis, at).share);
    }
    if (border.share <= inside + 0.1) continue;
    return warning<WarningCode::tile_seam>({{"axis", axis == 0 ? "x" : "y"},
                                            {"jump", kJump},
                                            {"share", border.share},
                                            {"rms", border.rms},
                                            {"thickness", static_cast<double>(tile.thickness())},
                                            {"inside", inside}});
  }
  return std::nullopt;
}

namespace {

/// Texels along a side and paths per texel of the pilot. Noise is the same at all heights, so few find the minimum.
constexpr uint32_t kSide = 32, kSamples = 4;
constexpr uint64_t kSeed = 0;

PairLayout pilot_layout(bool two_sided) {
  std::vector<PolarAngles> views{{0, 0}}, lights{{0, 0}};
  for (const double theta : {30.0, 60.0}) {
    for (const PolarAngles& d : ring_directions(theta, 6)) views.push_back(d);
  }
  for (const PolarAngles& d : ring_directions(45, 3)) lights.push_back(d);
  if (!two_sided) return {views, lights};
  for (auto* set : {&views, &lights}) {
    const std::vector<PolarAngles> mirrored = below(*set);
    set->insert(set->end(), mirrored.begin(), mirrored.end());
  }
  return {views, lights};
}

/// Variance over views, averaged over pairs of light and texel. Views are compared only with those from the same side:
/// the two sides of a sheet differ at any height.
class VarianceOverViews {
 public:
  explicit VarianceOverViews(size_t values) : sum_(values), sum_sq_(values) {}

  void add(const ViewSetup& view, std::span<const float> values) {
    ++views_;
    for (size_t i = 0; i < values.size() / 3; ++i) {
      const double cosine = 1 / static_cast<double>(view.lights[i / (kSide * kSide)].per_irradiance);
      const double y = cosine * static_cast<double>(luminance({values[3 * i], values[3 * i + 1], values[3 * i + 2]}));
      sum_[i] += y;
      sum_sq_[i] += y * y;
    }
  }
  double mean() const {
    double all = 0;
    for (size_t i = 0; i < sum_.size(); ++i) all += sum_sq_[i] / views_ - (sum_[i] / views_) * (sum_[i] / views_);
    return all / static_cast<double>(sum_.size());
  }

 private:
  int views_ = 0;
  std::vector<double> sum_, sum_sq_;
};

/// Calls use(view, values) with a few coarse images of every view.
template <class Use>
void capture_pilot(const RepeatedTile& tile, float height, uint32_t bounces, const PairLayout& layout,
                   Progress& progress, const Use& use) {
  const TexelGrid grid{kSide, kSide};
  ViewCapture capture(tile, grid, height, {.samples = kSamples, .bounces = bounces, .seed = kSeed});
  std::vector<HalfBits> values(3 * layout.lights().size() * grid.texels());
  const std::vector<float> none(grid.texels());
  for (uint32_t v = 0; v < layout.views().size(); ++v) {
    const ViewSetup view(tile, layout, v);
    ViewImages images{values, {}, {none, none, none}};
    capture.run(view, images, 0, 0, nullptr, progress);
    use(view, values);
  }
}

double variance_at(float height, const RepeatedTile& tile, const PairLayout& layout, Progress& progress) {
  const size_t values = layout.lights().size() * kSide * kSide;
  VarianceOverViews sides[2] = {VarianceOverViews(values), VarianceOverViews(values)};
  std::vector<float> floats(3 * values);
  capture_pilot(tile, height, 0, layout, progress, [&](const ViewSetup& view, std::span<const HalfBits> bits) {
    halves_to_floats(bits, floats);
    sides[view.wv.z < 0].add(view, floats);
  });
  const bool both = layout.views().back().theta > 90;
  return sides[0].mean() + (both ? sides[1].mean() : 0.0);
}

}  // namespace

float least_variance_height(const RepeatedTile& tile, bool two_sided, Progress& progress) {
  if (tile.thickness() <= 0) return tile.bottom();
  const PairLayout layout = pilot_layout(two_sided);
  const auto height_at = [&tile](size_t i) {
    return tile.bottom() + static_cast<float>(i) / (kReferenceHeights - 1) * tile.thickness();
  };
  std::array<double, kReferenceHeights> variance;
  std::atomic<int> done{0};
  tbb::parallel_for(size_t{0}, variance.size(), [&](size_t i) {  // a pilot is too small to occupy all threads
    variance[i] = variance_at(height_at(i), tile, layout, progress);
    progress.update(++done / static_cast<double>(kReferenceHeights));
  });
  return height_at(static_cast<size_t>(std::ranges::min_element(variance) - variance.begin()));
}

std::string tile_hash(const RepeatedTile& tile, Progress& progress) {
  constexpr size_t kPiece = 1 << 23;
  std::string parts;
  const auto add = [&](std::span<const uint8_t> bytes) {
    for (size_t done = 0; done < bytes.size(); done += kPiece) {
      progress.check();
      parts += sha256_hex(bytes.subspan(done, std::min(kPiece, bytes.size() - done)));
    }
  };
  for (const Mesh& mesh : tile.scene().meshes()) {
    add(bytes_of(mesh.positions()));
    add(bytes_of(mesh.triangles()));
  }
  for (const Scene::Instance& i : tile.scene().instances()) {
    add(bytes_of(std::span<const float>(i.object_to_world.m)));
    add(bytes_of(std::span<const uint32_t>(i.materials)));
  }
  capture_pilot(tile, tile.top(), 1, pilot_layout(true), progress,
                [&](const ViewSetup&, std::span<const HalfBits> values) { add(bytes_of(values)); });
  return sha256_hex({reinterpret_cast<const uint8_t*>(parts.data()), parts.size()});
}

}  // namespace velour
