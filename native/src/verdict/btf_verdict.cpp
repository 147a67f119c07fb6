#include "verdict/btf_verdict.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "btf/measure/half_floats.h"

namespace velour {

namespace {

constexpr std::array<double, 5> kViews{0, 20, 40, 60, 75};  // degrees; the azimuths are even
constexpr std::array<double, 3> kLights{15, 45, 65};        // degrees
constexpr std::array<double, 3> kLightTurns{40, 160, 280};  // degrees, from the azimuth of the view
constexpr double kViewTurn = 360.0 / static_cast<double>(kViews.size());

/// The direction of a set above the plane that is nearest to `wanted`; none: the set has none there.
std::optional<uint32_t> nearest(const std::vector<PolarAngles>& set, const Vec3& wanted) {
  std::optional<uint32_t> best;
  float closest = -1;
  for (uint32_t i = 0; i < set.size(); ++i) {
    const Vec3 w = unit_direction(set[i]);
    if (w.z <= 0 || glm::dot(w, wanted) <= closest) continue;
    closest = glm::dot(w, wanted);
    best = i;
  }
  return best;
}

/// Numbers of the pairs that are shown, ascending.
std::vector<uint64_t> chosen_pairs(const PairLayout& layout) {
  std::vector<uint64_t> pairs;
  for (size_t v = 0; v < kViews.size(); ++v) {
    const double azimuth = kViewTurn * static_cast<double>(v);
    const auto view = nearest(layout.views(), unit_direction({kViews[v], azimuth}));
    for (size_t l = 0; l < kLights.size() && view; ++l) {
      const auto light = nearest(layout.lights(), unit_direction({kLights[l], azimuth + kLightTurns[l]}));
      for (uint64_t pair = layout.first(*view); light && pair < layout.first(*view + 1); ++pair) {
        if (layout.light_of(pair) == *light) pairs.push_back(pair);
      }
    }
  }
  std::ranges::sort(pairs);
  pairs.erase(std::ranges::unique(pairs).begin(), pairs.end());
  return pairs;
}

PicturePair exposed(const TexelGrid& grid, std::span<const float> measured, std::span<const float> shown, float theta) {
  const auto side = [](uint32_t texels) { return static_cast<int>(std::min(2 * texels, kMaxPixels)); };
  PicturePair out;
  out.measured = out.shown = {side(grid.width), side(grid.height), {}};
  double sum = 0, shown_sum = 0;
  const auto color = [](std::span<const float> f, size_t at) {
    return glm::max(Rgb(f[at], f[at + 1], f[at + 2]), 0.0f);
  };
  for (int row = 0; row < out.measured.height; ++row) {
    for (int column = 0; column < out.measured.width; ++column) {
      const size_t x = static_cast<uint32_t>(column) % grid.width, y = static_cast<uint32_t>(row) % grid.height;
      const size_t at = 3 * (y * grid.width + x);
      const Rgb model = color(shown, at), truth = color(measured, at);
      out.shown.pixels.push_back(model);
      out.measured.pixels.push_back(std::isfinite(truth.r + truth.g + truth.b) ? truth : model);
      sum += static_cast<double>(luminance(out.measured.pixels.back()));
      shown_sum += static_cast<double>(luminance(model));
    }
  }
  const size_t count = out.shown.pixels.size();
  if (sum > 0) {
    out.exposure = static_cast<double>(kPhotographicGray) * static_cast<double>(count) / sum;
    out.luminance_ratio = shown_sum / sum;
  }
  for (LinearPicture* picture : {&out.measured, &out.shown}) {
    for (Rgb& c : picture->pixels) c *= static_cast<float>(out.exposure);
  }
  for (uint32_t i = 0; i < count; ++i) out.object.push_back(i);
  out.view_angle.assign(count, theta);
  return out;
}

}  // namespace

std::vector<PicturePair> tile_pictures(const BtfMeasurement& measurement, const BtfImages& images,
                                       const Progress& progress) {
  const PairLayout& layout = measurement.layout();
  std::vector<HalfBits> halves(measurement.grid().texels() * 3);
  std::vector<float> measured(halves.size()), shown;
  std::vector<PicturePair> pictures;
  for (const uint64_t pair : chosen_pairs(layout)) {
    progress.check();
    measurement.read_pairs(pair, 1, halves);
    halves_to_floats(halves, measured);
    const DirectionPair directions = layout.directions(pair);
    images(directions, shown);
    pictures.push_back(exposed(measurement.grid(), measured, shown, std::acos(std::min(directions.wv.z, 1.0f))));
  }
  return pictures;
}

std::optional<Verdict> judge_btf(const BtfMeasurement& measurement, const BtfImages& images, const Progress& progress) {
  const std::vector<PicturePair> pictures = tile_pictures(measurement, images, progress);
  std::optional<Verdict> verdict = verdict_of(pictures, progress);
  if (verdict && verdict->quality != LookQuality::good) explain_look(pictures, progress, *verdict);
  return verdict;
}

}  // namespace velour
