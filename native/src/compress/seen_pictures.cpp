#include "compress/seen_pictures.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "btf/pair_interpolation.h"
#include "compress/model_images.h"
#include "compress/scene_btf.h"

namespace velour {
namespace {

/// kDirections of the hit's terms, as often as their luminance says; none where it tells no light.
std::vector<Vec3> directions_of(const ObservedHit& hit, const SceneObservation& observation) {
  std::vector<double> sum{0};
  for (uint32_t i = hit.first; i < hit.last; ++i) {
    sum.push_back(sum.back() + static_cast<double>(std::max(luminance(observation.light[i]), 0.0f)));
  }
  std::vector<Vec3> directions;
  if (!(sum.back() > 0)) return directions;
  for (size_t k = 0; k < SeenPictures::kDirections; ++k) {
    const double place = sum.back() * (static_cast<double>(k) + 0.5) / SeenPictures::kDirections;
    const auto above = std::ranges::upper_bound(sum, place);
    directions.push_back(observation.wl[hit.first + static_cast<size_t>(above - sum.begin()) - 1]);
  }
  return directions;
}

/// How much each pair of the BTF counts, its values interpolated between views and lights.
std::map<uint64_t, float> pairs_of(const PairInterpolation& between, const PairLayout& layout, const Vec3& wv,
                                   const std::vector<Vec3>& directions) {
  std::map<uint64_t, float> pairs;
  const auto views = between.view(wv);
  for (const Vec3& wl : directions) {
    const auto lights = between.light(wl);
    if (!views || !lights) continue;
    for (size_t v = 0; v < 3; ++v) {
      for (size_t l = 0; l < 3; ++l) {
        const float weight = views->weight[v] * lights->weight[l];
        if (weight > 0) pairs[layout.first(views->index[v]) + lights->index[l]] += weight;
      }
    }
  }
  return pairs;
}

std::vector<float> true_radiance(const BtfMeasurement& truth, const std::map<uint64_t, float>& pairs,
                                 const Progress& progress) {
  std::vector<HalfBits> halves(truth.grid().texels() * 3);
  std::vector<float> rgb(halves.size()), sum(halves.size(), 0.0f);
  for (const auto& [pair, weight] : pairs) {
    progress.check();
    truth.read_pairs(pair, 1, halves);
    halves_to_floats(halves, rgb);
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += weight * rgb[i];
  }
  return halved_image(std::move(sum), truth.grid(), 3, 1);
}

/// How often `grid` must be halved to have `width` texels.
uint32_t halvings_to(const TexelGrid& grid, uint32_t width) {
  uint32_t halvings = 0;
  for (uint32_t w = grid.width; w > width; w /= 2) ++halvings;
  return halvings;
}

double relmse(const std::vector<float>& a, const std::vector<float>& b) {
  double error = 0;
  for (size_t c = 0; c < 3; ++c) {
    double mean = 0;
    for (size_t i = c; i < b.size(); i += 3) mean += static_cast<double>(b[i]);
    mean *= 3 / static_cast<double>(b.size());
    for (size_t i = c; i < b.size(); i += 3) {
      const auto x = static_cast<double>(a[i]), y = static_cast<double>(b[i]), floor = 0.01 * mean * mean;
      if (y * y + floor > 0) error += (x - y) * (x - y) / (y * y + floor);
    }
  }
  return error / static_cast<double>(b.size());
}

}  // namespace

SeenPictures::SeenPictures(const BtfMeasurement& truth, const SceneObservation& observation, const Progress& progress)
    : width_(truth.grid().width) {
  const PairInterpolation between(truth.layout());
  for (const ObservedHit& hit : observation.hits) {
    if (pictures_.size() == kPictures) return;
    const std::vector<Vec3> wl = directions_of(hit, observation);
    const auto pairs = pairs_of(between, truth.layout(), hit.wv, wl);
    if (!pairs.empty()) pictures_.push_back({hit.wv, wl, true_radiance(truth, pairs, progress)});
  }
}

double SeenPictures::error(const ModelBody& body, const Progress& progress) const {
  const BtfImages images = images_of(body);
  const TexelGrid grid = with_btf(body, [](const auto& btf) { return btf.grid; });
  std::vector<double> errors(pictures_.size());
  tbb::parallel_for(size_t{0}, pictures_.size(), [&](size_t p) {
    const Picture& picture = pictures_[p];
    std::vector<float> rgb, sum(grid.texels() * 3, 0.0f);
    for (const Vec3& wl : picture.wl) {
      progress.check();
      images({wl, picture.wv}, rgb);
      for (size_t i = 0; i < sum.size(); ++i) sum[i] += rgb[i];
    }
    const auto pixels = halved_image(std::move(sum), grid, 3, halvings_to(grid, width_) + 1);
    errors[p] = relmse(pixels, picture.radiance);
  });
  return std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size());
}

}  // namespace velour
