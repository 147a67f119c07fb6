#include "usage/btf/seen_pictures.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "btf/fit/btf_compare.h"
#include "image/picture.h"
#include "math/sphere/frame.h"
#include "usage/btf/scene_btf.h"

namespace velour {
namespace {

/// Number of times `grid` must be halved to have `width` texels.
uint32_t halvings_to(const TexelGrid& grid, uint32_t width) {
  uint32_t halvings = 0;
  for (uint32_t w = grid.width; w > width; w /= 2) ++halvings;
  return halvings;
}

/// The squared relative error, from the product of the errors a - b of two independent halves.
double relmse(const std::array<std::vector<float>, 2>& a, const std::array<const std::vector<float>*, 2>& b) {
  const size_t count = a[0].size();
  double error = 0;
  for (size_t c = 0; c < 3; ++c) {
    double mean = 0;
    for (size_t i = c; i < count; i += 3) mean += 0.5 * (static_cast<double>((*b[0])[i]) + (*b[1])[i]);
    mean *= 3 / static_cast<double>(count);
    for (size_t i = c; i < count; i += 3) {
      const double first = static_cast<double>(a[0][i]) - (*b[0])[i],
                   second = static_cast<double>(a[1][i]) - (*b[1])[i];
      const double y = 0.5 * (static_cast<double>((*b[0])[i]) + (*b[1])[i]);
      if (y != 0 || mean != 0) error += first * second / (y * y + relmse_floor(mean));
    }
  }
  return error / static_cast<double>(count);
}

}  // namespace

SeenPictures::SeenPictures(const BtfMeasurement& truth, const SceneObservation& observation, const Progress& progress)
    : truth_(truth), between_(truth.layout()) {
  const bool two_sided = has_lower_side(truth.layout());
  for (const ObservedHit& hit : observation.hits) {
    if (pictures_.size() == kPictures) return;
    const bool mirrored = hit.back && two_sided;
    Picture picture{mirrored ? velour::mirrored(hit.wv) : hit.wv,
                    {half_of_hit(hit, false, observation, mirrored), half_of_hit(hit, true, observation, mirrored)}};
    if (!between_.view(picture.wv) || picture.half[0].light.empty() || picture.half[1].light.empty()) continue;
    for (Half& half : picture.half) half.radiance = true_radiance(picture.wv, half, progress);
    pictures_.push_back(std::move(picture));
  }
}

SeenPictures::Half SeenPictures::half_of_hit(const ObservedHit& hit, bool second, const SceneObservation& observation,
                                             bool mirrored) const {
  Half half;
  for (uint32_t i = second ? hit.middle : hit.first; i < (second ? hit.last : hit.middle); ++i) {
    const Vec3 wl = mirrored ? velour::mirrored(observation.wl[i]) : observation.wl[i];
    const float amount = luminance(observation.light[i]);
    if (amount > 0 && between_.light(wl)) half.light.push_back({wl, amount});
  }
  return half;
}

std::vector<float> SeenPictures::true_radiance(const Vec3& wv, const Half& half, const Progress& progress) const {
  std::map<uint64_t, float> pairs;  // weight of each pair
  const auto views = between_.view(wv);
  for (const Light& light : half.light) {
    const auto lights = between_.light(light.wl);
    for (size_t v = 0; v < 3; ++v) {
      for (size_t l = 0; l < 3; ++l) {
        const float weight = light.amount * views->weight[v] * lights->weight[l];
        if (weight > 0) pairs[truth_.layout().first(views->index[v]) + lights->index[l]] += weight;
      }
    }
  }
  std::vector<HalfBits> halves(truth_.grid().texels() * 3);
  std::vector<float> rgb(halves.size()), sum(halves.size(), 0.0f);
  for (const auto& [pair, weight] : pairs) {
    progress.check();
    truth_.read_pairs(pair, 1, halves);
    halves_to_floats(halves, rgb);
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += weight * rgb[i];
  }
  return halved_image(std::move(sum), truth_.grid(), 3, 1);
}

std::vector<float> SeenPictures::picture_of(const BtfImages& images, const TexelGrid& grid, const Vec3& wv,
                                            const Half& half, const Progress& progress) const {
  std::vector<float> rgb, sum(grid.texels() * 3, 0.0f);
  for (const Light& light : half.light) {
    progress.check();
    images({light.wl, wv}, rgb);
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += light.amount * rgb[i];
  }
  return halved_image(std::move(sum), grid, 3, halvings_to(grid, truth_.grid().width) + 1);
}

double SeenPictures::error(const ModelBody& body, const Progress& progress) const {
  const BtfImages images = images_of(body);
  const TexelGrid grid = with_btf(body, [](const auto& btf) { return btf.grid; });
  std::vector<double> errors(pictures_.size());
  tbb::parallel_for(size_t{0}, pictures_.size(), [&](size_t p) {
    const Picture& picture = pictures_[p];
    const auto& [one, other] = picture.half;
    errors[p] = relmse(
        {picture_of(images, grid, picture.wv, one, progress), picture_of(images, grid, picture.wv, other, progress)},
        {&one.radiance, &other.radiance});
  });
  return std::max(0.0, std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size()));
}

}  // namespace velour
