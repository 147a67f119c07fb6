#include "scene/sky_mixture.h"

#include <chrono>

#include "scene/environment.h"
#include "scene/equirectangular.h"
#include "scene/sky_cache.h"

namespace velour {
namespace {

SkyMixture image_mixture(const EquirectangularImage& image, const SkyFitOptions& options, const std::string& folder,
                         const Progress& progress) {
  if (folder.empty()) return fit_sky(image, options, progress);
  const std::string path = sky_cache_path(folder, image, options);
  if (auto kept = read_sky(path)) return *std::move(kept);
  const SkyMixture sky = fit_sky(image, options, progress);
  write_sky(path, sky);  // on failure, the next render only has to fit again
  return sky;
}

}  // namespace

SkyMixture sky_mixture(const Environment& environment, const SkyFitOptions& options, const std::string& cache_folder,
                       const Progress& progress) {
  if (environment.black()) return {};
  const EquirectangularImage* image = environment.equirectangular();
  if (image == nullptr) {
    SkyMixture sky;
    sky.center = {{0, 0, 1}};
    sky.bandwidth = {0};
    sky.coefficient = {environment.radiance({0, 0, 1})};
    return sky;
  }
  const auto start = std::chrono::steady_clock::now();
  SkyMixture sky = image_mixture(*image, options, cache_folder, progress);
  const EnvironmentPlacement& placement = environment.placement();
  const Mat3 image_to_world = glm::transpose(placement.world_to_image);
  for (Vec3& c : sky.center) c = glm::normalize(image_to_world * c);
  for (Rgb& c : sky.coefficient) c *= placement.strength;
  sky.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return sky;
}

}  // namespace velour
