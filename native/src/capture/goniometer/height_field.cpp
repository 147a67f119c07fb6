#include "capture/goniometer/height_field.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <unsupported/Eigen/FFT>

#include "math/sphere/random.h"

namespace velour {
namespace {

using Complex = std::complex<double>;

/// Real and imaginary part: two independent standard normal numbers (Box and Muller 1958).
Complex normal_pair(RandomStream& random) {
  const double radius = std::sqrt(-2.0 * std::log1p(-static_cast<double>(random.next())));
  return std::polar(radius, 2.0 * kPiD * static_cast<double>(random.next()));
}

/// Amplitudes of one axis: the square root of the power spectrum exp(-(k correlation)^2 / 4), scaled so that the
/// variances of all modes add up to 1 (the two axes multiply).
std::vector<double> mode_amplitudes(int cells, double correlation) {
  std::vector<double> amplitude(static_cast<size_t>(cells));
  double variance = 0;
  for (int i = 0; i < cells; ++i) {
    const double k = 2.0 * kPiD * std::min(i, cells - i) / cells;
    const double power = std::exp(-0.25 * k * k * correlation * correlation);
    amplitude[static_cast<size_t>(i)] = std::sqrt(power);
    variance += power;
  }
  for (double& a : amplitude) a /= std::sqrt(variance);
  return amplitude;
}

/// Inverse-transforms every row without scaling, then transposes.
void transform_rows(int cells, std::vector<Complex>& grid, Eigen::FFT<double>& fft) {
  const auto n = static_cast<size_t>(cells);
  std::vector<Complex> row(n), out(n), transposed(grid.size());
  for (size_t y = 0; y < n; ++y) {
    std::copy_n(grid.begin() + static_cast<ptrdiff_t>(y * n), n, row.begin());
    fft.inv(out, row);
    for (size_t x = 0; x < n; ++x) transposed[x * n + y] = out[x];
  }
  grid.swap(transposed);
}

}  // namespace

std::vector<double> gaussian_field(int cells, double correlation, uint64_t seed, uint64_t stream) {
  const auto n = static_cast<size_t>(cells);
  const std::vector<double> amplitude = mode_amplitudes(cells, correlation);
  std::vector<Complex> grid(n * n);
  for (size_t y = 0; y < n; ++y) {
    for (size_t x = 0; x < n; ++x) {
      RandomStream random(seed, stream, y * n + x);
      grid[y * n + x] = amplitude[x] * amplitude[y] * normal_pair(random);
    }
  }
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::Unscaled);
  transform_rows(cells, grid, fft);
  transform_rows(cells, grid, fft);
  // The modes lack Hermitian symmetry; the real part alone has the desired autocorrelation.
  std::vector<double> field(n * n);
  std::transform(grid.begin(), grid.end(), field.begin(), [](const Complex& c) { return c.real(); });
  return field;
}

HeightField make_height_field(const HeightFieldOptions& options, uint64_t seed, uint64_t stream) {
  const std::vector<double> field = gaussian_field(options.cells, options.correlation, seed, stream);
  HeightField surface{options.cells, options.anisotropy, std::vector<float>(field.begin(), field.end())};
  double sum_sq = 0;
  for (int y = 0; y < options.cells; ++y) {
    for (int x = 0; x < options.cells; ++x) {
      const float along_x = surface.at(x + 1, y) - surface.at(x, y), along_y = surface.at(x, y + 1) - surface.at(x, y);
      sum_sq += static_cast<double>(along_x * along_x + along_y * along_y);
    }
  }
  // Makes the average of the two mean squares alpha^2 / 2.
  const auto scale = static_cast<float>(options.roughness * std::sqrt(static_cast<double>(field.size()) / sum_sq));
  for (float& h : surface.height) h *= scale;
  return surface;
}

std::vector<uint8_t> make_patches(int cells, double correlation, double share, uint64_t seed, uint64_t stream) {
  const std::vector<double> field = gaussian_field(cells, correlation, seed, stream);
  std::vector<uint32_t> order(field.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto marked = static_cast<ptrdiff_t>(std::lround(share * static_cast<double>(field.size())));
  std::nth_element(order.begin(), order.begin() + marked, order.end(),
                   [&field](uint32_t a, uint32_t b) { return field[a] != field[b] ? field[a] > field[b] : a < b; });
  std::vector<uint8_t> patches(field.size(), 0);
  for (ptrdiff_t i = 0; i < marked; ++i) patches[order[static_cast<size_t>(i)]] = 1;
  return patches;
}

}  // namespace velour
