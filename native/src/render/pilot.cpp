#include "render/pilot.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace velour {
namespace {

constexpr size_t kMaxPixels = 2048, kMinPixels = 512;
constexpr int kDirections[] = {64, 256};  // a pixel, unless a camera ray has more; few if the image has few
constexpr double kPart = 0.04;            // of the directions of the image
constexpr double kForProducts = 3e7;      // directions of an image that repay a fit of the environment
constexpr int kRun = 4;                   // neighboring pixels, traced together
constexpr size_t kRarePixels = 64;        // fewer say too little about a material
constexpr int kLikelySpp = 256;           // of images that may end before all samples are taken
constexpr size_t kMixings = 3, kSeeds = 2;

/// Time a sample, measured (docs/results/performance.md); the strategy's own mixing, the first, wins near ties.
constexpr std::array<double, kMixings> kCost = {0.95, 1.0, 1.4};

std::array<Mixing, kMixings> mixings(const RenderOptions& options) {
  return {mixing_of(options), {false, 0.75f}, {true, options.light_share}};
}

struct Plan {
  bool products;
  int camera_rays;  // per pixel
  size_t pixels;
  size_t mixings() const { return products ? kMixings : kMixings - 1; }
};

Plan plan_of(const RenderContext& context) {
  const RenderOptions& o = context.options;
  const Environment& environment = context.lighting->environment();
  const bool may_end_early = o.noise > 0.0 || o.time_limit > 0.0;
  const int spp = may_end_early ? std::min(o.spp, kLikelySpp) : o.spp;
  const double image = static_cast<double>(o.width) * o.height * spp;
  Plan plan{};
  plan.products = environment.equirectangular() != nullptr && !environment.black() && image >= kForProducts;
  const double part = kPart * image / static_cast<double>(kSeeds * plan.mixings());  // directions of a trial
  const int directions = static_cast<int>(std::clamp<double>(part / (kMaxPixels / 2), kDirections[0], kDirections[1]));
  plan.camera_rays = std::min(context.camera_rays(), std::max(directions / o.split, 1));
  const double pixels = part / static_cast<double>(std::min(plan.camera_rays * o.split, o.spp));
  plan.pixels = static_cast<size_t>(std::min(pixels, static_cast<double>(kMaxPixels))) / kRun * kRun;
  return plan;
}

class Pilot {
 public:
  Pilot(const RenderContext& context, const Plan& plan, const Progress& progress)
      : plan_(plan), progress_(progress), options_(context.options), trial_(context, options_) {
    options_.noise = 0.0;
    options_.denoise = false;  // neither halves the sequences, then
    place_runs();
  }

  /// Renders everything.
  void run() {
    const auto tried = mixings(options_);
    const uint64_t seed = options_.seed;
    for (size_t s = 0; s < kSeeds; ++s) {
      options_.seed = mix64(seed + 1 + s);
      for (size_t m = 0; m < plan_.mixings(); ++m) {
        trial_.mixing.assign(trial_.scene.materials().size(), tried[m]);
        render(luminance_[m][s]);
      }
    }
  }

  /// Chooses by the variances. Sums run over the pixels in order, so the bits do not depend on threads.
  RenderReport::Pilot choose(std::vector<Mixing>& by_material) const {
    const std::vector<double> weight = weights();
    Errors all{};
    std::vector<Errors> of_material(trial_.scene.materials().size());
    for (size_t p = 0; p < plan_.pixels; ++p) {
      if (material_[p] == kNone) continue;
      for (Errors* errors : {&all, &of_material[material_[p]]}) add(p, weight[p], *errors);
    }
    const auto tried = mixings(options_);
    const size_t common = best(all);
    RenderReport::Pilot report{all.pixels, 0.0, 0.0};
    for (const Errors& errors : of_material) {
      const Mixing& chosen = tried[errors.pixels < kRarePixels ? common : best(errors)];
      by_material.push_back(chosen);
      const double part = static_cast<double>(errors.pixels) / static_cast<double>(std::max<size_t>(all.pixels, 1));
      report.products += chosen.products ? part : 0.0;
      report.light_share += part * static_cast<double>(chosen.light_share);
    }
    return report;
  }

 private:
  static constexpr size_t kNone = static_cast<size_t>(-1);
  struct Errors {
    size_t pixels = 0;
    std::array<double, kMixings> sum{};
  };

  /// Spreads runs of pixels over the image by the sequence R2 [Rob18].
  void place_runs() {
    const auto at = [](size_t i, double step, int count) {
      const double x = (static_cast<double>(i) + 0.5) * step;
      return std::min(static_cast<int>((x - std::floor(x)) * count), count - 1);
    };
    for (size_t i = 0; i < plan_.pixels / kRun; ++i) {
      const int x = at(i, 0.7548776662466927, options_.width - kRun + 1);
      const int y = at(i, 0.5698402909980532, options_.height);
      runs_.push_back({x, y, x + kRun, y + 1});
    }
    material_.assign(plan_.pixels, kNone);
    for (size_t m = 0; m < plan_.mixings(); ++m) {
      for (size_t s = 0; s < kSeeds; ++s) luminance_[m][s].resize(plan_.pixels);
    }
    for (size_t m = 0; m < trial_.scene.materials().size(); ++m) {
      passes_.materials.push_back({static_cast<float>(m + 1), 0.0f});
    }
    passes_.asked = pass::kMaterialIndex;
  }

  void render(std::vector<double>& luminance) {
    tbb::enumerable_thread_specific<TileRenderer> renderers([this] { return TileRenderer(trial_); });
    tbb::parallel_for(size_t{0}, runs_.size(), [&](size_t r) {
      Film film(runs_[r], passes_);
      renderers.local().render(runs_[r], 0, plan_.camera_rays, film, nullptr, progress_);
      PixelSum sums[kRun];
      float indices[kRun];
      film.load(runs_[r], sums);
      film.read_pass("IndexMA", indices);
      for (size_t k = 0; k < kRun; ++k) {
        luminance[r * kRun + k] = sums[k].mean_luminance();
        if (indices[k] > 0.0f) material_[r * kRun + k] = static_cast<size_t>(indices[k]) - 1;
      }
    });
  }

  /// One over what the squared error of each pixel is divided by: that of relmse (image/picture.h).
  std::vector<double> weights() const {
    std::vector<double> mean(plan_.pixels, 0.0);
    double sum = 0.0;
    for (size_t p = 0; p < plan_.pixels; ++p) {
      for (size_t m = 0; m < plan_.mixings(); ++m) mean[p] += luminance_[m][0][p] + luminance_[m][1][p];
      mean[p] /= static_cast<double>(kSeeds * plan_.mixings());
      sum += mean[p];
    }
    const double least = 0.01 * std::pow(sum / static_cast<double>(plan_.pixels), 2.0) + 1e-30;
    for (double& m : mean) m = 1.0 / (m * m + least);
    return mean;
  }

  void add(size_t p, double weight, Errors& errors) const {
    ++errors.pixels;
    for (size_t m = 0; m < plan_.mixings(); ++m) {
      const double difference = luminance_[m][0][p] - luminance_[m][1][p];
      // A limit, so that a single firefly does not decide.
      errors.sum[m] += std::min(0.5 * difference * difference * weight, 1.0);
    }
  }

  size_t best(const Errors& errors) const {
    size_t best = 0;
    for (size_t m = 1; m < plan_.mixings(); ++m) {
      if (errors.sum[m] * kCost[m] < errors.sum[best] * kCost[best]) best = m;
    }
    return best;
  }

  const Plan plan_;
  const Progress& progress_;
  RenderOptions options_;
  RenderContext trial_;  // refers to options_
  PassOptions passes_;
  std::vector<PixelRect> runs_;
  std::vector<size_t> material_;  // by pixel, at its first camera ray; kNone: nothing was hit
  std::array<std::array<std::vector<double>, kSeeds>, kMixings> luminance_;  // by mixing, seed, pixel
};

}  // namespace

bool pilot_pays(const RenderContext& context) {
  return context.options.strategy == Strategy::automatic && context.options.width >= kRun &&
         context.lighting->has_extended() && plan_of(context).pixels >= kMinPixels;
}

bool pilot_tries_products(const RenderContext& context) { return pilot_pays(context) && plan_of(context).products; }

RenderReport::Pilot choose_mixing(RenderContext& context, const Progress& progress) {
  Pilot pilot(context, plan_of(context), progress);
  pilot.run();
  return pilot.choose(context.mixing);
}

}  // namespace velour
