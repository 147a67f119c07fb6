#include "plot/outline_plot.h"

#include <algorithm>
#include <cmath>

#include "job/error.h"
#include "votf/visibility_mask.h"

namespace velour {
namespace {

constexpr int kOutlineStep = 3, kLastOutline = 87;  // degrees
constexpr int kAzimuths = 12;
constexpr uint32_t kTexels = 64;
constexpr float kLongest = 4;  // maximum aspect; longer tiles get no more texels

TileTexels texels_of(const OcclusionVolume& volume) {
  const float rows = std::clamp(kTexels * volume.aspect, 1.0f, kTexels * kLongest);
  return {kTexels, static_cast<uint32_t>(std::lround(rows)), volume.aspect};
}

double covered(const ShellField& field, const TileTexels& texels, const Vec3& wv) {
  const std::vector<uint8_t> mask = visibility_mask(field, texels, wv);
  return static_cast<double>(std::ranges::count(mask, 1)) / static_cast<double>(mask.size());
}

}  // namespace

Plot outline_plot(const Model& model, Progress& progress) {
  if (!model.shell) throw Error(Status::unsupported, "The model has no silhouette (VOTF) to plot. Add one first.");
  const ShellField field(model.shell->volume);
  const TileTexels texels = texels_of(field.volume());
  PlotSeries least{"least", PlotRole::level, PlotMark::dashes}, most{"most", PlotRole::level, PlotMark::dashes};
  PlotSeries mean{"mean", PlotRole::model, PlotMark::line};
  for (int degrees = 0; degrees <= kLastOutline; degrees += kOutlineStep) {
    double low = 1, high = 0, sum = 0;
    for (int i = 0; i < kAzimuths; ++i) {
      progress.check();
      const double share = covered(field, texels,
                                   direction(radians_from(static_cast<float>(degrees)),
                                             2 * kPi * static_cast<float>(i) / static_cast<float>(kAzimuths)));
      low = std::min(low, share), high = std::max(high, share), sum += share;
    }
    const auto angle = static_cast<double>(degrees);
    least.points.push_back({angle, low});
    most.points.push_back({angle, high});
    mean.points.push_back({angle, sum / kAzimuths});
    progress.update(angle / kLastOutline);
  }
  Plot plot{.kind = "outline"};
  plot.x = {"theta_v_degrees", "view angle, degrees", false, 0, 90};
  plot.y = {"covered", "covered share of the tile", false, 0, 1};
  plot.series = {std::move(least), std::move(most), std::move(mean)};
  plot.legend = {{"azimuthal mean", PlotRole::model, PlotMark::line},
                 {"minimum, maximum", PlotRole::level, PlotMark::dashes}};
  return plot;
}

}  // namespace velour
