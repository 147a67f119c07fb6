#include "btf/fit/fitted_sides.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>

#include "base/error.h"
#include "math/sphere/vec.h"

namespace velour {

namespace {

constexpr char kAxes[] = "colors.axes", kEnergy[] = "colors.energy", kNotFinite[] = "colors.not_finite";

std::optional<ColorAxes> kept(const FitCheckpoint& checkpoint, const PairLayout& layout) {
  const auto axes = checkpoint.matrix(kAxes, 3, 3);
  auto energy = checkpoint.numbers(kEnergy, layout.pairs());
  const auto not_finite = checkpoint.integers(kNotFinite, 1, size_t{1} << 53);
  if (!axes || !energy || energy->size() != layout.pairs() || !not_finite || not_finite->size() != 1) return {};
  const auto negative = [](double e) { return e < 0; };
  if (axes->cwiseAbs().maxCoeff() > 1.001f || std::any_of(energy->begin(), energy->end(), negative)) return {};
  ColorAxes found;
  for (int i = 0; i < 9; ++i) found.axes[i / 3][i % 3] = (*axes)(i / 3, i % 3);
  found.energy = std::move(*energy);
  found.not_finite = (*not_finite)[0];
  return found;
}

void keep(const ColorAxes& found, FitCheckpoint& checkpoint) {
  RowMatrix axes(3, 3);
  for (int i = 0; i < 9; ++i) axes(i / 3, i % 3) = found.axes[i / 3][i % 3];
  checkpoint.keep(kAxes, axes);
  checkpoint.keep_numbers(kEnergy, found.energy);
  checkpoint.keep_integers(kNotFinite, {found.not_finite});
  checkpoint.write();
}

}  // namespace

double ColorAxes::energy_of(const std::vector<uint32_t>& views, const std::vector<uint32_t>& of_lights) const {
  double sum = 0;
  for (const uint32_t v : views) {
    for (const uint32_t l : of_lights) sum += energy[v * lights + l];
  }
  return sum;
}

double ColorAxes::all_energy() const { return std::accumulate(energy.begin(), energy.end(), 0.0); }

size_t ColorAxes::lit_views() const {
  size_t count = 0;
  for (auto view = energy.begin(); view != energy.end(); view += static_cast<ptrdiff_t>(lights)) {
    if (std::any_of(view, view + static_cast<ptrdiff_t>(lights), [](double e) { return e > 0; })) ++count;
  }
  return count;
}

ColorAxes find_colors(CompandedViews& views, const PairLayout& layout, FitCheckpoint& checkpoint) {
  std::optional<ColorAxes> found = kept(checkpoint, layout);
  if (!found) {
    found.emplace();
    found->axes = views.decorrelate();
    found->energy = views.energies();
    found->not_finite = views.not_finite();
    keep(*found, checkpoint);
  }
  found->lights = layout.lights().size();
  views.set_axes(found->axes);
  return std::move(*found);
}

namespace {

constexpr double kUnlike = 0.1;  // relative difference of energies

/// Index of a side that equals this one.
std::optional<size_t> side_like(const BtfMeasurement& measurement, const std::vector<FittedSide>& sides,
                                const SideDirections& side, double energy, const Progress& progress) {
  for (size_t s = 0; s < sides.size(); ++s) {
    if (std::abs(energy - sides[s].energy) > kUnlike * energy) continue;  // without reading their images
    if (sides_are_equal(measurement, sides[s].directions, side, progress)) return s;
  }
  return std::nullopt;
}

}  // namespace

FittedSides fitted_sides(const BtfMeasurement& measurement, const ColorAxes& colors, const Progress& progress) {
  FittedSides found;
  std::vector<SideDirections> sides = sides_of(measurement.layout());
  for (SideDirections& side : sides) {
    const double energy = colors.energy_of(side.view_number, side.light_number);
    if (side.view_below != side.light_below && energy == 0) continue;
    if (const auto same = side_like(measurement, found.sides, side, energy, progress)) {
      found.sides[*same].energy += energy;
      found.shared.push_back({side.view_below, side.light_below, static_cast<uint32_t>(*same)});
      continue;
    }
    found.sides.push_back({std::move(side), energy});
  }
  if (found.sides.empty()) found.sides.push_back({std::move(sides.front()), 0});  // a model has at least one side
  return found;
}

void require_complete(const PairLayout& layout) {
  if (layout.complete()) return;
  throw Error(Status::unsupported,
              "The BTF has only " + std::to_string(layout.pairs()) +
                  " view-light pairs, but a model requires every view under every light. Use a BTF with all pairs.");
}

namespace {

constexpr float kSameDirection = 1e-4f;
constexpr float kHalfRounding = 1.0f / 2048;  // maximum relative rounding error
// Maximum ratio of squared differences to noise that counts as chance: in one view, in all views.
constexpr double kOneView = 4, kAllViews = 1.1;

/// For each direction of `a`, the index of the same direction in `b`.
std::optional<std::vector<size_t>> places(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  if (a.size() != b.size()) return std::nullopt;
  std::vector<size_t> places;
  for (const Vec3& w : a) {
    size_t j = 0;
    while (j < b.size() && glm::length(b[j] - w) > kSameDirection) ++j;
    if (j == b.size()) return std::nullopt;
    places.push_back(j);
  }
  return places;
}

/// Squared differences, and their expected value for noise alone.
struct Difference {
  double squares = 0, noise = 0;
  void add(const Difference& d) {
    squares += d.squares;
    noise += d.noise;
  }
  bool is_noise(double times) const { return squares <= times * noise; }
};

/// Reads the image of a pair and the standard errors of its luminance.
class PairReader {
 public:
  explicit PairReader(const BtfMeasurement& measurement)
      : measurement_(measurement), texels_(measurement.grid().texels()), halves_(texels_ * 3), errors_(texels_) {}

  void read(uint64_t pair, std::vector<float>& f, std::vector<float>& error) {
    f.resize(texels_ * 3);
    error.assign(texels_, 0.0f);
    measurement_.read_pairs(pair, 1, halves_);
    halves_to_floats(halves_, f);
    if (measurement_.read_errors(pair, 1, errors_)) halves_to_floats(errors_, error);
  }

 private:
  const BtfMeasurement& measurement_;
  uint64_t texels_;
  std::vector<HalfBits> halves_, errors_;
};

/// Differences between two sides for one pair of directions, per texel and of the mean.
class PairDifference {
 public:
  explicit PairDifference(const BtfMeasurement& measurement) : reader_(measurement) {}

  void add(uint64_t pair_a, uint64_t pair_b, Difference& by_texel, Difference& by_mean) {
    reader_.read(pair_a, f_[0], error_[0]);
    reader_.read(pair_b, f_[1], error_[1]);
    Vec3d mean(0.0), mean_noise(0.0);
    for (size_t t = 0; t < error_[0].size(); ++t) {
      const Vec3 a = color(f_[0], t), b = color(f_[1], t);
      const Vec3 noise = noise_of(a, b, t);
      if (!std::isfinite(glm::dot(a + b + noise, Vec3(1.0f)))) continue;
      const Vec3d difference(a - b);
      by_texel.add({glm::dot(difference, difference), static_cast<double>(glm::dot(noise, Vec3(1.0f)))});
      mean += difference;
      mean_noise += Vec3d(noise);
    }
    by_mean.add({glm::dot(mean, mean), mean_noise.x + mean_noise.y + mean_noise.z});
  }

 private:
  static Vec3 color(const std::vector<float>& f, size_t t) { return {f[3 * t], f[3 * t + 1], f[3 * t + 2]}; }

  /// Variances of the channels' difference. A channel's noise is assumed to be proportional to its value.
  Vec3 noise_of(const Vec3& a, const Vec3& b, size_t t) const {
    const float brightness = luminance(a + b);
    const float variance = error_[0][t] * error_[0][t] + error_[1][t] * error_[1][t];
    const Vec3 ratio = brightness > 0 ? (a + b) / brightness : Vec3(1.0f);
    return ratio * ratio * variance + (a * a + b * b) * (kHalfRounding * kHalfRounding);
  }

  PairReader reader_;
  std::vector<float> f_[2], error_[2];
};

}  // namespace

bool sides_are_equal(const BtfMeasurement& measurement, const SideDirections& a, const SideDirections& b,
                     const Progress& progress) {
  const auto view = places(a.view, b.view), light = places(a.light, b.light);
  if (!view || !light) return false;
  const PairLayout& layout = measurement.layout();
  PairDifference difference(measurement);
  Difference all_by_texel, all_by_mean;
  for (size_t v = 0; v < a.view.size(); ++v) {
    progress.check();
    Difference by_texel, by_mean;
    for (size_t l = 0; l < a.light.size(); ++l) {
      difference.add(layout.first(a.view_number[v]) + a.light_number[l],
                     layout.first(b.view_number[(*view)[v]]) + b.light_number[(*light)[l]], by_texel, by_mean);
    }
    if (!by_texel.is_noise(kOneView) || !by_mean.is_noise(kOneView)) return false;
    all_by_texel.add(by_texel);
    all_by_mean.add(by_mean);
  }
  return all_by_texel.is_noise(kAllViews) && all_by_mean.is_noise(kAllViews);
}

}  // namespace velour
