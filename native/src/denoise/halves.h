// A denoised picture from two independent halves of its samples, with an estimate of its error.
#pragma once

#include <cstdint>
#include <span>

namespace velour {

/// The two independent halves of a picture's samples: the mean colors of each half (3 floats per pixel), and each half
/// denoised on its own.
struct DenoisedHalves {
  std::span<const float> noisy[2], denoised[2];
  std::span<const uint32_t> camera_rays;  // per pixel, at least 2; if odd, the first half has one more
};

struct DenoisedError {
  double relmse = 0;          // estimate, relative to the denoised picture because the true one is unknown
  double standard_error = 0;  // of that estimate
  double noisy_share = 0;     // weight of the noisy picture in the result, 0..1

  /// Upper bound of the error against the true picture (PictureDifference); holds in at least 95 of 100 renders. The
  /// factor covers two things that the estimate cannot see: errors weigh too little where the denoised picture is too
  /// bright, and light that no sample has found is missing from both halves. Rare light, such as a caustic of the sun,
  /// may exceed the bound.
  double bound() const { return kSafety * (relmse + 3 * standard_error); }
  static constexpr double kSafety = 1.5;
};

/// Writes to `picture` the mean P of both denoised halves, blended with the share of the noisy mean M that minimizes
/// the estimated error: detail that the denoiser removes returns as M gains samples, and the picture converges.
///
/// For the true picture I, the halves A and B, and a and b denoised from them, these estimates have the expectations
///   S = ((a - B)^2 + (b - A)^2 - (A - B)^2) / 2 - (a - b)^2 / 4     (P - I)^2
///   V = (A - B)^2 n_A n_B / n^2                                     (M - I)^2
/// because A and a are independent of B and b, and A and B are unbiased: measured against B, the error of a is too
/// large by the variance of B, which (A - B)^2 estimates. Nothing is assumed about the denoiser. With Q = (P - M)^2,
/// the error of P + s (M - P) is S + s (V - S - Q) + s^2 Q. The standard error treats pixels as independent, like their
/// samples.
DenoisedError combine(const DenoisedHalves& halves, std::span<float> picture);

}  // namespace velour
