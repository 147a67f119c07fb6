#include "capture/reference_plane.h"

#include <cmath>
#include <vector>

#include "capture/view_capture.h"

namespace velour {
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

double variance_at(float height, const RepeatedTile& tile, const PairLayout& layout, Progress& progress) {
  const TexelGrid grid{kSide, kSide};
  ViewCapture capture(tile, grid, height, {.samples = kSamples, .bounces = 0, .seed = kSeed});
  const size_t lights = layout.lights().size(), values = lights * grid.texels();
  VarianceOverViews sides[2] = {VarianceOverViews(values), VarianceOverViews(values)};
  std::vector<HalfBits> bits(3 * values);
  std::vector<float> floats(3 * values);
  const std::vector<float> none(grid.texels());
  for (uint32_t v = 0; v < layout.views().size(); ++v) {
    const ViewSetup view(tile, layout, v);
    ViewImages images{bits, {}, {none, none, none}};
    capture.run(view, images, 0, 0, nullptr, progress);
    halves_to_floats(bits, floats);
    sides[view.wv.z < 0].add(view, floats);
  }
  const bool both = layout.views().back().theta > 90;
  return sides[0].mean() + (both ? sides[1].mean() : 0.0);
}

}  // namespace

float least_variance_height(const RepeatedTile& tile, bool two_sided, Progress& progress) {
  if (tile.thickness() <= 0) return tile.bottom();
  const PairLayout layout = pilot_layout(two_sided);
  float best = tile.bottom();
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kReferenceHeights; ++i) {
    const float share = static_cast<float>(i) / (kReferenceHeights - 1);
    const float height = tile.bottom() + share * tile.thickness();
    const double variance = variance_at(height, tile, layout, progress);
    progress.update((i + 1.0) / kReferenceHeights);
    if (variance < least) {
      least = variance;
      best = height;
    }
  }
  return best;
}

}  // namespace velour
