#include "capture/microsurface.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numeric>

#include "brdf/brdf_table.h"
#include "brdf/merl.h"
#include "capture/metals.h"
#include "capture/microsurface_brdf.h"
#include "job/threads.h"

namespace velour {
namespace {

constexpr uint64_t kDefaultRays = 12'000'000;
constexpr uint64_t kMaxRays = 100'000'000'000;
constexpr uint64_t kSamplesPerTile = 187'500;
constexpr uint64_t kMinBatches = 8, kMaxBatches = 32;  // few batches estimate errors poorly
constexpr uint64_t kSamplesPerBatch = 100'000;         // for fewer than kMaxBatches batches

std::string number(double x) {
  std::string text = std::to_string(x);
  text.erase(text.find_last_not_of('0') + 1);
  return text.back() == '.' ? text.substr(0, text.size() - 1) : text;
}

void check_range(const char* name, double value, double lowest, double highest) {
  if (value >= lowest && value <= highest) return;
  throw Error(Status::invalid_argument, std::string("The microsurface's ") + name + " is " + number(value) +
                                            "; it must be " + number(lowest) + " to " + number(highest) + ".");
}

void put_below_clear_surface(const MicrosurfaceOptions& options, GoniometerOptions& goniometer) {
  check_range("refractive index", options.ior, 1.05, 3.0);
  check_range("flake roughness", options.flake_roughness, 0.01, 0.4);
  goniometer.body = CoatedBody{options.ior, metal_reflectance(options.metal, options.ior), options.flake_roughness,
                               options.base_albedo, options.base_share};
  goniometer.facets = interface_of(*goniometer.body);
  goniometer.base_share = 0.0;
}

GoniometerOptions goniometer_options(const MicrosurfaceOptions& options) {
  check_range("roughness", options.roughness, 0.01, 1.0);
  check_range("anisotropy", options.anisotropy, 1.0, 10.0);
  check_range("base share", options.base_share, 0.0, 1.0);
  for (int c = 0; c < 3; ++c) check_range("base albedo", static_cast<double>(options.base_albedo[c]), 0.0, 1.0);
  check_range("number of threads", options.threads, 0, 4096);
  if (options.rays > kMaxRays) {
    throw Error(Status::invalid_argument, "The microsurface's number of rays is " + std::to_string(options.rays) +
                                              "; at most " + std::to_string(kMaxRays) + " are supported.");
  }
  GoniometerOptions goniometer;
  goniometer.surface.roughness = options.roughness;
  goniometer.surface.anisotropy = options.anisotropy;
  goniometer.facets = metal_reflectance(options.metal);
  goniometer.base_albedo = options.base_albedo;
  goniometer.base_share = options.base_share;
  if (options.ior != 0.0) put_below_clear_surface(options, goniometer);
  goniometer.seed = options.seed;
  goniometer.threads = options.threads;
  const uint64_t rays = options.rays != 0 ? options.rays : kDefaultRays;
  const uint64_t batches = std::clamp(rays / kSamplesPerBatch, kMinBatches, kMaxBatches);
  const uint64_t per_batch = std::max<uint64_t>(1, rays / batches);
  const uint64_t tiles = std::max<uint64_t>(1, (per_batch + kSamplesPerTile / 2) / kSamplesPerTile);
  goniometer.batches = static_cast<int>(batches);
  goniometer.tiles_per_batch = static_cast<int>(tiles);
  goniometer.samples_per_tile = std::max<uint64_t>(1, per_batch / tiles);
  return goniometer;
}

/// Calls `row` for 0 <= i < rows on `threads` threads, checking for cancellation before each call.
void for_each_row(int rows, int threads, const Progress& progress, const std::function<void(int)>& row) {
  tbb::task_arena arena(arena_concurrency(threads));
  arena.execute([&] {
    tbb::parallel_for(0, rows, [&](int i) {
      progress.check();
      row(i);
    });
  });
}

bool above_horizon(const DirectionPair& pair) { return pair.wl.z > 0.0f && pair.wv.z > 0.0f; }

void write_isotropic(const MicrosurfaceBrdf& brdf, int threads, const std::string& path, const Progress& progress) {
  std::vector<double> planes(3 * MerlGrid::size, -1.0);
  for_each_row(MerlGrid::theta_h * MerlGrid::theta_d, threads, progress, [&](int row) {
    const int i = row / MerlGrid::theta_d, j = row % MerlGrid::theta_d;
    for (int k = 0; k < MerlGrid::phi_d; ++k) {
      const DirectionPair pair = MerlGrid::pair(i, j, k);
      if (!above_horizon(pair)) continue;
      const Rgb f = brdf.f(pair);
      for (size_t c = 0; c < 3; ++c) {
        planes[c * MerlGrid::size + MerlGrid::index(i, j, k)] = static_cast<double>(f[static_cast<int>(c)]);
      }
    }
  });
  write_merl(path, planes);
}

std::string describe(const MicrosurfaceOptions& options) {
  const std::string clear = options.ior == 0.0
                                ? ""
                                : " The roughness is that of a clear coat of refractive index " + number(options.ior) +
                                      "; the flakes below it have roughness " + number(options.flake_roughness) + ".";
  return "Ray-traced Gaussian random surface of " + options.metal + ": roughness " + number(options.roughness) +
         " along x, anisotropy " + number(options.anisotropy) + ", diffuse base over a share of " +
         number(options.base_share) + "." + clear;
}

void write_anisotropic(const MicrosurfaceBrdf& brdf, const MicrosurfaceOptions& options, const std::string& path,
                       const Progress& progress) {
  BrdfTable table;
  table.layout.folds = 2;  // the bins were pooled over both mirror planes
  // Across its long axis, a stretched highlight is as wide as 1 / anisotropy of its radius.
  table.layout.phi_h = std::clamp(static_cast<int>(9.0 * options.anisotropy), 18, 72);
  table.layout.theta_d = 45;
  table.f.assign(table.layout.size(), Rgb(std::numeric_limits<float>::quiet_NaN()));
  table.description = describe(options);
  const BrdfTableLayout& layout = table.layout;
  for_each_row(layout.theta_h * layout.phi_h, options.threads, progress, [&](int row) {
    const int i = row / layout.phi_h, j = row % layout.phi_h;
    for (int k = 0; k < layout.theta_d; ++k) {
      for (int l = 0; l < layout.phi_d; ++l) {
        const DirectionPair pair = layout.pair(i, j, k, l);
        if (above_horizon(pair)) table.f[layout.index(i, j, k, l)] = brdf.f(pair);
      }
    }
  });
  write_brdf_table(path, table);
}

/// A bin of the finished table, weighted for the report.
struct Bin {
  DirectionPair pair;
  double energy;  // f cos(theta_l) cos(theta_v) d omega_l d omega_v
  double f;       // luminance
};

/// A regular subset of the MERL nodes, rotated to `azimuths` azimuths of the half vector.
std::vector<Bin> bins_for_report(const MicrosurfaceBrdf& brdf, int azimuths) {
  std::vector<Bin> bins;
  for (int i = 1; i < MerlGrid::theta_h; ++i) {
    for (int j = 1; j < MerlGrid::theta_d; j += 3) {
      for (int k = 0; k < MerlGrid::phi_d * azimuths; k += 15) {
        DirectionPair pair = MerlGrid::pair(i, j, k % MerlGrid::phi_d);
        if (!above_horizon(pair)) continue;
        const int turn = k / MerlGrid::phi_d;
        const float angle = 0.5f * kPi * static_cast<float>(turn) / static_cast<float>(std::max(azimuths - 1, 1));
        const Mat3 about_z({std::cos(angle), std::sin(angle), 0}, {-std::sin(angle), std::cos(angle), 0}, {0, 0, 1});
        pair = {about_z * pair.wl, about_z * pair.wv};
        const double theta_h = radians_from(i * i / 90.0), theta_d = radians_from(static_cast<double>(j));
        const double measure = i * std::sin(theta_h) * std::sin(theta_d) * std::cos(theta_d);
        const double f = static_cast<double>(luminance(brdf.f(pair)));
        if (f > 0.0) bins.push_back({pair, f * measure * static_cast<double>(pair.wl.z * pair.wv.z), f});
      }
    }
  }
  return bins;
}

/// The brightest bins, which together hold 90 % of the energy.
std::vector<Bin> bright_bins(std::vector<Bin> bins) {
  std::stable_sort(bins.begin(), bins.end(), [](const Bin& a, const Bin& b) { return a.energy > b.energy; });
  const double all =
      std::accumulate(bins.begin(), bins.end(), 0.0, [](double s, const Bin& b) { return s + b.energy; });
  double held = 0;
  size_t count = 0;
  while (count < bins.size() && held < 0.9 * all) held += bins[count++].energy;
  bins.resize(count);
  return bins;
}

/// Median over `bins` of standard error / f, by the jackknife that leaves out one batch at a time.
double median_relative_error(const GoniometerOptions& options, const GoniometerBins& goniometer_bins,
                             const std::vector<GoniometerSums>& batches, const GoniometerSums& total,
                             const std::vector<Bin>& bins, const Progress& progress) {
  const size_t n = batches.size();
  std::vector<double> left_out(n * bins.size());
  for_each_row(static_cast<int>(n), options.threads, progress, [&](int row) {
    const auto b = static_cast<size_t>(row);
    GoniometerSums sums = total;
    sums -= batches[b];
    const MicrosurfaceBrdf brdf(options, goniometer_bins, sums);
    for (size_t i = 0; i < bins.size(); ++i) {
      left_out[b * bins.size() + i] = static_cast<double>(luminance(brdf.f(bins[i].pair)));
    }
  });
  std::vector<double> errors(bins.size());
  for (size_t i = 0; i < bins.size(); ++i) {
    double mean = 0, sum_sq = 0;
    for (size_t b = 0; b < n; ++b) mean += left_out[b * bins.size() + i] / static_cast<double>(n);
    for (size_t b = 0; b < n; ++b) sum_sq += std::pow(left_out[b * bins.size() + i] - mean, 2);
    errors[i] = std::sqrt(sum_sq * static_cast<double>(n - 1) / static_cast<double>(n)) / bins[i].f;
  }
  if (errors.empty()) return 0.0;
  const auto middle = errors.begin() + static_cast<ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  return *middle;
}

}  // namespace

MicrosurfaceReport capture_microsurface(const MicrosurfaceOptions& options, const std::string& path,
                                        Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const GoniometerOptions goniometer = goniometer_options(options);
  const GoniometerBins bins(goniometer);
  progress.stage("tracing", 0.0, 0.9);
  const std::vector<GoniometerSums> batches = run_goniometer(goniometer, progress);
  GoniometerSums total(bins);
  for (const GoniometerSums& batch : batches) total += batch;
  const MicrosurfaceBrdf brdf(goniometer, bins, total);

  progress.stage("estimating errors", 0.9, 0.95);
  MicrosurfaceReport report;
  const auto bright = bright_bins(bins_for_report(brdf, options.anisotropy == 1.0 ? 1 : 4));
  report.relative_standard_error = median_relative_error(goniometer, bins, batches, total, bright, progress);
  const Rgb at_normal = albedo(brdf, &MicrosurfaceBrdf::f, {0, 0, 1}, 20'000);
  for (int c = 0; c < 3; ++c) report.albedo[c] = static_cast<double>(at_normal[c]);
  report.resolution_degrees = std::atan(options.roughness / SlopeBins::kPerAlpha) * 180.0 / kPiD;
  report.rays = total.rays;

  progress.stage("writing", 0.95, 1.0);
  if (options.anisotropy == 1.0) {
    write_isotropic(brdf, options.threads, path, progress);
  } else {
    write_anisotropic(brdf, options, path, progress);
  }
  report.bytes = std::filesystem::file_size(path);
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  report.rays_per_second = static_cast<double>(report.rays) / report.seconds;
  progress.update(1.0);
  return report;
}

}  // namespace velour
