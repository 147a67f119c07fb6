#include "capture/goniometer/bins.h"

#include <algorithm>
#include <cmath>

namespace velour {

namespace {

void add(std::vector<double>& to, const std::vector<double>& from, double sign) {
  for (size_t i = 0; i < to.size(); ++i) to[i] += sign * from[i];
}

}  // namespace

GoniometerBins::GoniometerBins(const GoniometerOptions& options)
    : slopes(options.surface.roughness, options.surface.roughness / options.surface.anisotropy),
      mirror(options.surface.anisotropy == 1.0 ? PairGrid(24, 12, 0) : PairGrid(12, 9, 24)),
      metal(options.surface.anisotropy == 1.0 ? PairGrid(20, 24, 0) : PairGrid(12, 9, 24)),
      diffuse(options.body && options.body->has_flakes() ? metal
              : options.surface.anisotropy == 1.0        ? PairGrid(14, 9, 0)
                                                         : PairGrid(8, 6, 12)) {}

GoniometerSums::GoniometerSums(const GoniometerBins& bins)
    : metal_facets(bins.slopes.size()),
      tried(bins.mirror.size()),
      clear(bins.mirror.size()),
      metal_flux(3 * bins.metal.size()),
      diffuse_flux(3 * bins.diffuse.size()) {}

GoniometerSums& GoniometerSums::operator+=(const GoniometerSums& other) {
  add(metal_facets, other.metal_facets, 1);
  add(tried, other.tried, 1);
  add(clear, other.clear, 1);
  add(metal_flux, other.metal_flux, 1);
  add(diffuse_flux, other.diffuse_flux, 1);
  facets += other.facets;
  samples += other.samples;
  rays += other.rays;
  lost += other.lost;
  return *this;
}

GoniometerSums& GoniometerSums::operator-=(const GoniometerSums& other) {
  add(metal_facets, other.metal_facets, -1);
  add(tried, other.tried, -1);
  add(clear, other.clear, -1);
  add(metal_flux, other.metal_flux, -1);
  add(diffuse_flux, other.diffuse_flux, -1);
  facets -= other.facets;
  samples -= other.samples;
  rays -= other.rays;
  lost -= other.lost;
  return *this;
}

namespace {
constexpr int kPsiNodes = 5;  // every 22.5 degrees of the quarter turn
}

SlopeBins::SlopeBins(double alpha_x, double alpha_y)
    : alpha_x_(alpha_x), alpha_y_(alpha_y), psis_(alpha_x == alpha_y ? 1 : kPsiNodes) {}

SlopeBins::Stencil SlopeBins::stencil(const Vec2& slope) const {
  const double x = std::abs(static_cast<double>(slope.x)) / alpha_x_;
  const double y = std::abs(static_cast<double>(slope.y)) / alpha_y_;
  const double r = kPerAlpha * std::sqrt(x * x + y * y);
  const int radius = static_cast<int>(std::min(r, 1e6));
  Stencil s{};
  s.inside = radius + 1 < radii();
  if (!s.inside) return s;
  const double psi = psis_ == 1 ? 0.0 : std::atan2(y, x) * (psis_ - 1) / (0.5 * kPiD);
  const int lower = std::clamp(static_cast<int>(psi), 0, std::max(psis_ - 2, 0));
  const int upper = std::min(lower + 1, psis_ - 1);
  const double in_r = r - radius, in_psi = psi - lower;
  const double share[4] = {(1 - in_r) * (1 - in_psi), (1 - in_r) * in_psi, in_r * (1 - in_psi), in_r * in_psi};
  for (int i = 0; i < 4; ++i) {
    s.node[i] = index(radius + i / 2, i % 2 == 0 ? lower : upper);
    s.share[i] = share[i];
  }
  return s;
}

void SlopeBins::deposit(const Vec2& slope, std::span<double> counts) const {
  const Stencil s = stencil(slope);
  if (!s.inside) return;
  for (int i = 0; i < 4; ++i) counts[s.node[i]] += s.share[i];
}

double SlopeBins::look_up(const Vec2& slope, std::span<const double> density) const {
  const Stencil s = stencil(slope);
  double value = 0;
  if (!s.inside) return value;
  for (int i = 0; i < 4; ++i) value += s.share[i] * density[s.node[i]];
  return value;
}

double SlopeBins::bin_area(int radius, int psi) const {
  // The hat of node k > 0 integrates r dr to k step^2, that of node 0 to step^2 / 6; psi folds four quarters into one.
  constexpr double step = 1.0 / kPerAlpha;
  const double ring = step * step * (radius == 0 ? 1.0 / 6.0 : radius);
  const bool end = psi == 0 || psi == psis_ - 1;
  const double turn = psis_ == 1 ? 1.0 : (end ? 0.5 : 1.0) / (psis_ - 1);
  return 2.0 * kPiD * turn * ring * alpha_x_ * alpha_y_;
}

std::vector<double> SlopeBins::density(std::span<const double> counts, double facets) const {
  std::vector<double> density(size());
  for (int radius = 0; radius < radii(); ++radius) {
    for (int psi = 0; psi < psis_; ++psi) {
      double count = 0, area = 0;
      for (int wide = 0; wide <= kMaxWidening; ++wide) {
        count = area = 0;
        for (int r = std::max(radius - wide, 0); r <= std::min(radius + wide, radii() - 1); ++r) {
          // A slope of zero has no azimuth: the innermost bin is shared by all psi.
          for (int p = r == 0 ? 0 : psi; p <= (r == 0 ? psis_ - 1 : psi); ++p) {
            count += counts[index(r, p)];
            area += bin_area(r, p);
          }
        }
        if (count >= kEnoughFacets) break;
      }
      density[index(radius, psi)] = count / (facets * area);
    }
  }
  return density;
}

}  // namespace velour
