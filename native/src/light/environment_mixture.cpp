#include "light/environment_mixture.h"

#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include "base/file.h"
#include "image/tensors/exr_tensors.h"
#include "light/environment.h"
#include "light/equirectangular.h"
#include "math/sphere/random.h"
#include "math/srbf/lobe_mixture.h"

namespace velour {

namespace {

constexpr char kKind[] = "sky";
constexpr char kVersion[] = "2";  // also of the fit: another fitting method must not read this one's mixtures
constexpr uint64_t kMaxBytes = uint64_t{1} << 24;
constexpr size_t kMaxLobes = 4096;

template <typename T>
void append(std::vector<uint8_t>& bytes, const T* first, size_t count) {
  const size_t at = bytes.size();
  bytes.resize(at + count * sizeof(T));
  std::memcpy(bytes.data() + at, first, count * sizeof(T));
}

const Tensor* part(const TensorFile& file, const char* name, size_t rows, size_t columns) {
  const auto found = file.tensors.find(name);
  return found != file.tensors.end() && found->second.data.size() == rows * columns ? &found->second : nullptr;
}

bool sound(const EnvironmentMixture& sky) {
  for (size_t k = 0; k < sky.size(); ++k) {
    const Rgb& c = sky.coefficient[k];
    if (!(std::abs(glm::length(sky.center[k]) - 1) < 1e-3f)) return false;
    if (!(sky.bandwidth[k] >= 0 && sky.bandwidth[k] < 1e9f)) return false;
    if (!(c.r >= 0 && c.g >= 0 && c.b >= 0 && std::isfinite(c.r + c.g + c.b))) return false;
  }
  return std::isfinite(sky.relative_l2) && sky.relative_l2 >= 0;
}

std::optional<EnvironmentMixture> mixture_of(const TensorFile& file) {
  const auto kind = file.attributes.find("velour.kind"), version = file.attributes.find("velour.format_version");
  if (kind == file.attributes.end() || kind->second != kKind) return std::nullopt;
  if (version == file.attributes.end() || version->second != kVersion) return std::nullopt;
  const auto widths = file.tensors.find("lobes.bandwidth");
  if (widths == file.tensors.end()) return std::nullopt;
  const size_t n = widths->second.data.size();
  const Tensor* centers = part(file, "lobes.center", n, 3);
  const Tensor* colors = part(file, "lobes.coefficient", n, 3);
  const Tensor* error = part(file, "fit.relative_l2", 1, 1);
  if (n == 0 || n > kMaxLobes || centers == nullptr || colors == nullptr || error == nullptr) return std::nullopt;
  EnvironmentMixture sky;
  sky.bandwidth = widths->second.data;
  for (size_t k = 0; k < n; ++k) {
    const float *c = &centers->data[3 * k], *v = &colors->data[3 * k];
    sky.center.emplace_back(c[0], c[1], c[2]);
    sky.coefficient.emplace_back(v[0], v[1], v[2]);
  }
  sky.relative_l2 = error->data[0];
  sky.cached = true;
  return sound(sky) ? std::optional(sky) : std::nullopt;
}

/// "FOLDER/sky-<SHA-256 of size, texels and options>.exr". The texels do not include the placement, so one file serves
/// every strength and rotation.
std::string mixture_cache_path(const std::string& folder, const EquirectangularImage& image,
                               const EnvironmentFitOptions& options) {
  std::vector<uint8_t> key;
  const int32_t numbers[] = {image.width(), image.height(), options.max_lobes};
  append(key, numbers, 3);
  append(key, &options.tolerance, 1);
  for (int y = 0; y < image.height(); ++y) append(key, image.row(y) + 1, static_cast<size_t>(image.width()));
  return (std::filesystem::path(folder) / ("sky-" + sha256_hex(key) + ".exr")).string();
}

/// Empty if the file is missing or any of its entries is invalid; the caller then fits again.
std::optional<EnvironmentMixture> read_mixture(const std::string& path) {
  try {
    return mixture_of(decode_tensors(read_file(path, kMaxBytes), path, {{"lobes.", "fit."}, kMaxBytes}));
  } catch (const Error&) {  // missing, truncated, or another format
    return std::nullopt;
  }
}

/// Writes atomically. Returns false if the file cannot be written.
bool write_mixture(const std::string& path, const EnvironmentMixture& sky) {
  TensorFile file;
  file.attributes.emplace("velour.kind", kKind);
  file.attributes.emplace("velour.format_version", kVersion);
  Tensor centers{{sky.size(), 3}, {}}, colors{{sky.size(), 3}, {}};
  for (const Vec3& c : sky.center) centers.data.insert(centers.data.end(), {c.x, c.y, c.z});
  for (const Rgb& c : sky.coefficient) colors.data.insert(colors.data.end(), {c.r, c.g, c.b});
  file.tensors["lobes.center"] = std::move(centers);
  file.tensors["lobes.coefficient"] = std::move(colors);
  file.tensors["lobes.bandwidth"] = {{sky.size()}, sky.bandwidth};
  file.tensors["fit.relative_l2"] = {{1}, {sky.relative_l2}};
  try {
    std::filesystem::create_directories(std::filesystem::path(path).parent_path());
    write_file(path, encode_tensors(file));
  } catch (const Error&) {
    return false;
  } catch (const std::filesystem::filesystem_error&) {
    return false;
  }
  return true;
}

EnvironmentMixture image_mixture(const EquirectangularImage& image, const EnvironmentFitOptions& options,
                                 const std::string& folder, const Progress& progress) {
  if (folder.empty()) return fit_environment(image, options, progress);
  const std::string path = mixture_cache_path(folder, image, options);
  if (auto kept = read_mixture(path)) return *std::move(kept);
  const EnvironmentMixture sky = fit_environment(image, options, progress);
  write_mixture(path, sky);  // on failure, the next render only has to fit again
  return sky;
}

}  // namespace

EnvironmentMixture mixture_of_environment(const Environment& environment, const EnvironmentFitOptions& options,
                                          const std::string& cache_folder, const Progress& progress) {
  if (environment.black()) return {};
  const EquirectangularImage* image = environment.equirectangular();
  if (image == nullptr) {
    EnvironmentMixture sky;
    sky.center = {{0, 0, 1}};
    sky.bandwidth = {0};
    sky.coefficient = {environment.radiance({0, 0, 1})};
    return sky;
  }
  const auto start = std::chrono::steady_clock::now();
  EnvironmentMixture sky = image_mixture(*image, options, cache_folder, progress);
  const EnvironmentPlacement& placement = environment.placement();
  const Mat3 image_to_world = glm::transpose(placement.world_to_image);
  for (Vec3& c : sky.center) c = glm::normalize(image_to_world * c);
  for (Rgb& c : sky.coefficient) c *= placement.strength;
  sky.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return sky;
}

namespace {

constexpr uint32_t kDraws = 1024, kDrawBatch = DirectionBatch::kCapacity;
static_assert(kDraws % kDrawBatch == 0);

std::unique_ptr<const LobeMixture> density_of(const EnvironmentMixture& sky) {
  auto mixture = std::make_unique<LobeMixture>();
  mixture->clear(Kernel::gaussian);
  for (size_t k = 0; k < sky.size(); ++k) mixture->add(sky.center[k], sky.bandwidth[k], sky.coefficient[k]);
  mixture->finish(0);
  return mixture;
}

}  // namespace

double misfit_of_environment(const Environment& environment, const EnvironmentMixture& sky) {
  const auto mixture = density_of(sky);
  double sum = 0;
  for (uint32_t first = 0; first < kDraws; first += kDrawBatch) {
    Vec2 u[kDrawBatch];
    sobol_points(0, first, u);
    DirectionBatch world;
    environment.sample(u, world);
    world.pad();
    RgbBatch radiance;
    ScalarBatch own, lobes;
    environment.look_up(world, radiance, own);
    eval_density(*mixture, world, lobes);
    for (uint32_t i = 0; i < kDrawBatch; ++i) sum += static_cast<double>(own.v[i]) / static_cast<double>(lobes.v[i]);
  }
  return sum / kDraws - 1;
}

}  // namespace velour
