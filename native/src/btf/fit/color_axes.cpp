#include "btf/fit/color_axes.h"

#include <algorithm>
#include <numeric>

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

}  // namespace velour
