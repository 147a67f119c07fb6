#include "capture/goniometer/microsurface.h"

#include <tbb/parallel_for.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numeric>
#include "base/error.h"
#include "base/parallel.h"
#include "brdf/formats/merl.h"
#include "brdf/measure/brdf_table.h"
#include "capture/goniometer/goniometer.h"

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

namespace {

struct Metal {
  const char* name;
  std::span<const double> wavelengths;  // nanometers, over the visible range
  std::span<const RefractiveIndex> indices;
};

// Gold, copper, silver: [JC72]; nickel, iron, chromium, titanium: [JC74], at the same photon energies. Evaporated films
// at room temperature, taken from the refractiveindex.info database [Pol24], which is in the public domain.
constexpr double kJohnsonChristy[] = {354.2, 367.9, 381.5, 397.4, 413.3, 430.5, 450.9, 471.4, 495.9,
                                      520.9, 548.6, 582.1, 616.8, 659.5, 704.5, 756.0, 821.1, 892.0};
constexpr RefractiveIndex kGold[] = {{1.5, 1.866},  {1.48, 1.895}, {1.46, 1.933}, {1.47, 1.952}, {1.46, 1.958},
                                     {1.45, 1.948}, {1.38, 1.914}, {1.31, 1.849}, {1.04, 1.833}, {0.62, 2.081},
                                     {0.43, 2.455}, {0.29, 2.863}, {0.21, 3.272}, {0.14, 3.697}, {0.13, 4.103},
                                     {0.14, 4.542}, {0.16, 5.083}, {0.17, 5.663}};
constexpr RefractiveIndex kCopper[] = {{1.37, 1.916}, {1.36, 1.975}, {1.33, 2.045}, {1.32, 2.116}, {1.28, 2.207},
                                       {1.25, 2.305}, {1.24, 2.397}, {1.25, 2.483}, {1.22, 2.564}, {1.18, 2.608},
                                       {1.02, 2.577}, {0.7, 2.704},  {0.3, 3.205},  {0.22, 3.747}, {0.21, 4.205},
                                       {0.24, 4.665}, {0.26, 5.18},  {0.3, 5.768}};
constexpr RefractiveIndex kSilver[] = {{0.1, 1.419},  {0.07, 1.657}, {0.05, 1.864}, {0.05, 2.07},  {0.05, 2.275},
                                       {0.04, 2.462}, {0.04, 2.657}, {0.05, 2.869}, {0.05, 3.093}, {0.05, 3.324},
                                       {0.06, 3.586}, {0.05, 3.858}, {0.06, 4.152}, {0.05, 4.483}, {0.04, 4.838},
                                       {0.03, 5.242}, {0.04, 5.727}, {0.04, 6.312}};
constexpr RefractiveIndex kNickel[] = {{1.74, 2.32}, {1.7, 2.4},   {1.72, 2.48}, {1.72, 2.57}, {1.7, 2.69},
                                       {1.71, 2.82}, {1.73, 2.95}, {1.78, 3.09}, {1.82, 3.25}, {1.85, 3.42},
                                       {1.92, 3.61}, {1.96, 3.8},  {1.99, 4.02}, {1.99, 4.26}, {2.06, 4.5},
                                       {2.13, 4.73}, {2.26, 4.97}, {2.4, 5.23}};
constexpr RefractiveIndex kIron[] = {{1.93, 2.35}, {2.02, 2.43}, {2.12, 2.5},  {2.24, 2.58}, {2.35, 2.65},
                                     {2.48, 2.71}, {2.59, 2.77}, {2.67, 2.82}, {2.74, 2.88}, {2.86, 2.91},
                                     {2.95, 2.93}, {2.94, 2.99}, {2.88, 3.05}, {2.92, 3.1},  {2.86, 3.19},
                                     {2.87, 3.28}, {2.94, 3.39}, {2.96, 3.56}};
constexpr RefractiveIndex kChromium[] = {{1.84, 2.64}, {1.87, 2.69}, {1.92, 2.74}, {2.0, 2.83},  {2.08, 2.93},
                                         {2.19, 3.04}, {2.33, 3.14}, {2.51, 3.24}, {2.75, 3.3},  {2.94, 3.33},
                                         {3.18, 3.33}, {3.22, 3.3},  {3.17, 3.3},  {3.09, 3.34}, {3.05, 3.39},
                                         {3.08, 3.42}, {3.2, 3.48},  {3.3, 3.52}};
constexpr RefractiveIndex kTitanium[] = {{1.82, 2.87}, {1.9, 2.9},   {1.99, 2.93}, {2.08, 2.95}, {2.14, 2.98},
                                         {2.21, 3.01}, {2.27, 3.04}, {2.32, 3.1},  {2.36, 3.19}, {2.44, 3.3},
                                         {2.54, 3.43}, {2.6, 3.58},  {2.67, 3.72}, {2.76, 3.84}, {2.86, 3.96},
                                         {3.0, 4.01},  {3.21, 4.01}, {3.29, 3.96}};

// [Rak95], at wavelengths of its own.
constexpr double kRakic[] = {326.28, 364.66, 413.28, 442.8,  476.87, 516.6,  563.57, 619.93,
                             652.25, 688.81, 729.32, 774.91, 794.78, 815.69, 837.74};
constexpr RefractiveIndex kAluminum[] = {{0.31474, 3.9165}, {0.39877, 4.3957}, {0.52135, 5.0008}, {0.6079, 5.3676},
                                         {0.7278, 5.7781},  {0.8734, 6.2418},  {1.0728, 6.7839},  {1.366, 7.4052},
                                         {1.5724, 7.7354},  {1.8301, 8.0601},  {2.1606, 8.3565},  {2.6154, 8.4914},
                                         {2.7675, 8.3866},  {2.7668, 8.2573},  {2.6945, 8.1878}};

// Yellow brass. Not a measurement: rounded values of the usual shape for copper with a third of zinc, which give a
// normal reflectance near linear Rec. 709 (0.87, 0.70, 0.41).
constexpr double kBrassWavelengths[] = {380, 450, 500, 550, 600, 650, 700, 780};
constexpr RefractiveIndex kBrass[] = {{1.45, 1.7},  {1.45, 1.85}, {1.0, 1.95},  {0.55, 2.45},
                                      {0.42, 3.05}, {0.42, 3.55}, {0.42, 3.95}, {0.43, 4.55}};

constexpr Metal kMetals[] = {
    {"nickel", kJohnsonChristy, kNickel},     {"gold", kJohnsonChristy, kGold},
    {"copper", kJohnsonChristy, kCopper},     {"aluminium", kRakic, kAluminum},
    {"silver", kJohnsonChristy, kSilver},     {"iron", kJohnsonChristy, kIron},
    {"chromium", kJohnsonChristy, kChromium}, {"titanium", kJohnsonChristy, kTitanium},
    {"brass", kBrassWavelengths, kBrass},
};

const Metal& metal_named(const std::string& name) {
  for (const Metal& metal : kMetals) {
    if (name == metal.name) return metal;
  }
  std::string known;
  for (const std::string& n : metal_names()) known += (known.empty() ? "" : ", ") + n;
  throw Error(Status::invalid_argument, "Unknown metal \"" + name + "\"; use one of " + known + ".");
}

}  // namespace

std::vector<std::string> metal_names() {
  std::vector<std::string> names;
  for (const Metal& metal : kMetals) names.emplace_back(metal.name);
  return names;
}

Reflectance metal_reflectance(const std::string& name, double outside) {
  const Metal& metal = metal_named(name);
  std::vector<RefractiveIndex> relative;
  for (const RefractiveIndex& index : metal.indices) relative.push_back({index.n / outside, index.k / outside});
  return {metal.wavelengths, relative};
}

}  // namespace velour
