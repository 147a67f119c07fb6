#include "denoise/halves.h"

#include <algorithm>
#include <cmath>

namespace velour {
namespace {

double sq(double x) { return x * x; }

/// Terms of the estimate for one channel of a pixel.
struct Terms {
  double denoised, noisy;  // P, M
  double s, v, q;

  Terms(const DenoisedHalves& halves, size_t i) {
    const auto first = static_cast<double>(halves.noisy[0][i]), second = static_cast<double>(halves.noisy[1][i]);
    const auto of_first = static_cast<double>(halves.denoised[0][i]);
    const auto of_second = static_cast<double>(halves.denoised[1][i]);
    const uint32_t rays = halves.camera_rays[i / 3];
    const double share = static_cast<double>(rays / 2) / rays;  // of the second half
    denoised = (of_first + of_second) / 2;
    noisy = (1 - share) * first + share * second;
    const double apart = sq(first - second);
    s = (sq(of_first - second) + sq(of_second - first) - apart) / 2 - sq(of_first - of_second) / 4;
    v = apart * share * (1 - share);
    q = sq(denoised - noisy);
  }

  double error(double noisy_share) const { return s + noisy_share * (v - s - q) + sq(noisy_share) * q; }
};

}  // namespace

DenoisedError combine(const DenoisedHalves& halves, std::span<float> picture) {
  const size_t count = picture.size();
  double mean = 0;
  for (size_t i = 0; i < count; ++i) mean += Terms(halves, i).denoised / static_cast<double>(count);
  const double floor = std::max(0.01 * sq(mean), 1e-30);
  const auto weight = [&](const Terms& t) { return 1 / (sq(t.denoised) + floor); };

  double s = 0, v = 0, q = 0;
  for (size_t i = 0; i < count; ++i) {
    const Terms t(halves, i);
    s += weight(t) * t.s;
    v += weight(t) * t.v;
    q += weight(t) * t.q;
  }
  DenoisedError error;
  error.noisy_share = q > 0 ? std::clamp((s + q - v) / (2 * q), 0.0, 1.0) : 0.0;

  double sum = 0, squares = 0;  // over pixels
  for (size_t i = 0; i < count; i += 3) {
    double of_pixel = 0;
    for (size_t c = i; c < i + 3; ++c) {
      const Terms t(halves, c);
      of_pixel += weight(t) * t.error(error.noisy_share) / 3;
      picture[c] = static_cast<float>(t.denoised + error.noisy_share * (t.noisy - t.denoised));
    }
    sum += of_pixel;
    squares += sq(of_pixel);
  }
  const auto pixels = static_cast<double>(count / 3);
  error.relmse = sum / pixels;
  error.standard_error = std::sqrt(std::max(squares / pixels - sq(error.relmse), 0.0) / pixels);
  return error;
}

}  // namespace velour
