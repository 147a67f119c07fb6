#include "realtime/lobe_rows.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/error.h"
#include "base/parallel.h"
#include "brdf/eval/per_view_lobes.h"
#include "realtime/light_map.h"
#include "realtime/lobes_of_views.h"

namespace velour {
namespace {

constexpr int kLobeFloats = 8;
constexpr int kRowAngles = 91, kGrid = 49;        // of parametric models, which blend
constexpr int kNearAngles = 361, kNearGrid = 65;  // of per-view models, which do not
constexpr double kSoft = 300;                     // bandwidth among lights below which the broad part corrects a lobe

size_t places_of(const LobeRows& rows) {
  const auto n = static_cast<size_t>(rows.side);
  return rows.isotropic ? n : n * n;
}

Vec3d view_at(const LobeRows& rows, size_t place) {
  const auto n = static_cast<size_t>(rows.side);
  const auto along = [&](size_t i) { return static_cast<double>(i) / static_cast<double>(n - 1); };
  glm::dvec2 disk(along(place), 0);
  if (!rows.isotropic) {
    disk = {2 * along(place % n) - 1, 2 * along(place / n) - 1};
    disk /= std::max(glm::length(disk), 1.0);
  }
  // A view in the plane of the surface sees nothing.
  const double radius = glm::length(disk), theta = std::min(radius * kPiD / 2, 1.5690);
  const double sine = radius > 0 ? std::sin(theta) / radius : 0;
  return {sine * disk.x, sine * disk.y, std::cos(theta)};
}

void write_lobe(const Vec3& center, float level, const Vec3& color, bool is_used, float* to) {
  const float used = is_used ? 1 : 0;
  const float values[kLobeFloats] = {center.x, center.y, center.z, level, color.x, color.y, color.z, used};
  std::copy_n(values, kLobeFloats, to);
}

void write_lobe(const LightGaussian& g, float* to) {
  write_lobe(Vec3(g.center), LightLevels::of(static_cast<float>(g.bandwidth)), Vec3(g.color), g.is_used, to);
}

/// Writes all lobes of a place.
void write_lobes(const BroadPart::Fitted& broad, const std::vector<LightGaussian>& gaussians, float* to) {
  write_lobe({0, 0, 1}, LightLevels::kCosine, Vec3(broad.cosine), true, to);
  for (const LightGaussian& g : broad.gaussians) write_lobe(g, to += kLobeFloats);
  for (const LightGaussian& g : gaussians) write_lobe(g, to += kLobeFloats);
}

/// Pixels of unused lobes: black, with an arbitrary direction.
TablePixels pixels_of(const LobeRows& rows) {
  TablePixels pixels(2 * static_cast<uint32_t>(rows.lobes), static_cast<uint32_t>(places_of(rows)));
  for (size_t i = 0; i < pixels.rgba.size(); i += kLobeFloats) {
    write_lobe({0, 0, 1}, LightLevels::kBroadest, Vec3(0.0f), false, pixels.rgba.data() + i);
  }
  return pixels;
}

/// Number of Gaussians of each lobe, for the view that needs most.
std::vector<size_t> gaussians_of_lobes(const LobesOfViews& material, const LobeRows& rows, int threads,
                                       const Progress& progress) {
  std::vector<std::vector<size_t>> of_place(places_of(rows));
  parallel_pieces(of_place.size(), threads, progress, [&](size_t place) {
    const auto lobes = material.lobes(view_at(rows, place));
    of_place[place].assign(lobes.size(), 1);
    for (size_t j = 0; j < lobes.size(); ++j) {
      const LobeReach& reach = lobes[j].reach;
      if (reach.is_seen) of_place[place][j] = gaussians_for(reach.longer / reach.shorter);
    }
  });
  std::vector<size_t> counts;
  for (const std::vector<size_t>& of : of_place) {
    counts.resize(std::max(counts.size(), of.size()), 1);
    for (size_t j = 0; j < of.size(); ++j) counts[j] = std::max(counts[j], of[j]);
  }
  return counts;
}

/// Computes and writes the lobes of one place.
void write_place(const LobesOfViews& material, const std::vector<size_t>& counts, const BroadPart& broad,
                 const Vec3d& wv, float* to) {
  const auto lobes = material.lobes(wv);
  std::vector<LightGaussian> gaussians, soft_gaussians;
  std::vector<size_t> places;
  std::vector<bool> is_soft(lobes.size());
  for (size_t j = 0; j < lobes.size(); ++j) {
    std::vector<LightGaussian> row(counts[j]);
    light_gaussians(lobes[j], material.of(), wv, row);
    for (LightGaussian& g : row) g.color *= material.growth(lobes, j, g.center, wv);
    is_soft[j] = lobes[j].bandwidth_across() <= kSoft;
    for (const LightGaussian& g : row) {
      if (is_soft[j]) {
        places.push_back(gaussians.size());
        soft_gaussians.push_back(g);
      }
      gaussians.push_back(g);
    }
  }
  const auto slice = [&](const Vec3d& wl) {
    return wl.z > 0 ? wl.z * material.soft_value(is_soft, wl, wv) : Vec3d(0.0);
  };
  const auto fitted = broad.fitted(slice, soft_gaussians);
  for (size_t i = 0; i < places.size(); ++i) gaussians[places[i]] = soft_gaussians[i];
  write_lobes(fitted, gaussians, to);
}

/// The neighbors of a place, those that share a side before those that share a corner.
std::vector<uint32_t> beside(const LobeRows& rows, uint32_t place) {
  constexpr int kSteps[][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
  const int n = rows.side, last = rows.isotropic ? 0 : n - 1;
  const int x = static_cast<int>(place) % n, y = static_cast<int>(place) / n;
  std::vector<uint32_t> places;
  for (const auto& [dx, dy] : kSteps) {
    if (x + dx < 0 || x + dx >= n || y + dy < 0 || y + dy > last) continue;
    places.push_back(static_cast<uint32_t>((y + dy) * n + x + dx));
  }
  return places;
}

/// Gives unused lobes of a place the shape that they have at a neighbor, so that blends do not mix in an arbitrary
/// shape.
void shape_unused_lobes(LobeRows& rows) {
  const TablePixels before = rows.pixels;
  const auto is_used = [&](uint32_t column, uint32_t place) { return before.at(column + 1, place)[3] != 0; };
  for (uint32_t place = 0; place < places_of(rows); ++place) {
    const auto around = beside(rows, place);
    for (int j = 0; j < rows.lobes; ++j) {
      const auto at = static_cast<uint32_t>(2 * j);
      if (is_used(at, place)) continue;
      const auto used = std::find_if(around.begin(), around.end(), [&](uint32_t p) { return is_used(at, p); });
      if (used != around.end()) std::copy_n(before.at(at, *used), 4, rows.pixels.at(at, place));
    }
  }
}

LobeRows blended_rows(bool isotropic, const LobesOfViews& material, int threads, Progress& progress) {
  LobeRows rows{.isotropic = isotropic, .side = isotropic ? kRowAngles : kGrid};
  const auto counts = gaussians_of_lobes(material, rows, threads, progress);
  const BroadPart broad;
  rows.lobes = BroadPart::kLobes;
  for (const size_t count : counts) rows.lobes += static_cast<int>(count);
  rows.pixels = pixels_of(rows);
  parallel_for_each(places_of(rows), threads, progress, [&](size_t place) {
    write_place(material, counts, broad, view_at(rows, place), rows.pixels.at(0, static_cast<uint32_t>(place)));
  });
  shape_unused_lobes(rows);
  return rows;
}

/// The material's mixtures of f cos at all places.
std::vector<LobeMixture> mixtures_of(const PerViewBrdf& brdf, const LobeRows& rows) {
  const PerViewLobes lobes(brdf, 0);
  std::vector<LobeMixture> mixtures(places_of(rows));
  for (size_t place = 0; place < mixtures.size(); ++place) {
    lobes.gather(lobes.place(Vec3(view_at(rows, place))), mixtures[place]);
  }
  return mixtures;
}

/// Gaussians of a mixture; Abel-Poisson kernels become the Gaussians of their mean cosine.
std::vector<LightGaussian> gaussians_of(const LobeMixture& mixture) {
  std::vector<LightGaussian> gaussians;
  for (int j = 0; j < mixture.count; ++j) {
    const auto own = static_cast<double>(mixture.bandwidth[j]), whole = kernel_integral(mixture.kernel, own);
    const bool is_gaussian = mixture.kernel == Kernel::gaussian;
    gaussians.push_back({.center = Vec3d(mixture.x[j], mixture.y[j], mixture.z[j]),
                         .bandwidth = is_gaussian ? own : gaussian_bandwidth_of_mean(1 - own),
                         .color = whole * Vec3d(mixture.r[j], mixture.g[j], mixture.b[j]),
                         .is_used = true});
  }
  return gaussians;
}

/// The material is black below the horizon, so the broad part cancels what soft lobes have there.
void write_mixture(const LobeMixture& mixture, const BroadPart& broad, float* to) {
  const auto gaussians = gaussians_of(mixture);
  std::vector<LightGaussian> soft;
  std::copy_if(gaussians.begin(), gaussians.end(), std::back_inserter(soft),
               [](const LightGaussian& g) { return g.bandwidth < kSoft; });
  auto fitted = broad.fitted([&](const Vec3d& wl) { return wl.z > 0 ? Vec3d(0.0) : -value_of(soft, wl); }, {});
  fitted.cosine += kPiD * Vec3d(mixture.diffuse_r, mixture.diffuse_g, mixture.diffuse_b);
  write_lobes(fitted, gaussians, to);
}

LobeRows rows_of(const PerViewBrdf& brdf, int threads, Progress& progress) {
  LobeRows rows{.isotropic = brdf.isotropic, .side = brdf.isotropic ? kNearAngles : kNearGrid, .blends = false};
  const auto mixtures = mixtures_of(brdf, rows);
  for (const LobeMixture& mixture : mixtures) rows.lobes = std::max(rows.lobes, mixture.count + BroadPart::kLobes);
  rows.pixels = pixels_of(rows);
  const BroadPart broad;
  parallel_for_each(mixtures.size(), threads, progress, [&](size_t place) {
    write_mixture(mixtures[place], broad, rows.pixels.at(0, static_cast<uint32_t>(place)));
  });
  return rows;
}

}  // namespace

LobeRows lobe_rows(const Model& model, int threads, Progress& progress) {
  if (const auto* parametric = std::get_if<ParametricBrdf>(&model.body)) {
    return blended_rows(parametric->isotropic, *lobes_of_views(*parametric), threads, progress);
  }
  if (const auto* per_view = std::get_if<PerViewBrdf>(&model.body)) return rows_of(*per_view, threads, progress);
  throw Error(Status::invalid_argument, "BTF models have no lobe table; only BRDF models do.");
}

LobeRows lobe_rows(const PrincipledParameters& parameters, int threads, Progress& progress) {
  return blended_rows(true, *lobes_of_views(parameters), threads, progress);
}

}  // namespace velour
