// A denoised picture out of two independent halves of its samples, and its error.
#pragma once

#include <cstdint>
#include <span>

namespace velour {

/// The two independent halves of a picture's samples: mean colors of each (3 floats a pixel), and each half denoised by
/// itself.
struct DenoisedHalves {
  std::span<const float> noisy[2], denoised[2];
  std::span<const uint32_t> camera_rays;  // of the pixels; the first half has one more where they are odd; at least 2
};

struct DenoisedError {
  double relmse = 0;          // estimate; relative to the denoised picture, as the true one is not known
  double standard_error = 0;  // of that estimate
  double noisy_share = 0;     // what the picture has of the noisy one, 0..1

  /// Upper bound of the error against the true picture (PictureDifference), held in at least 95 of 100 renders. The
  /// factor covers two things that the estimate cannot see: errors count too little where the denoised picture is too
  /// bright, and light that no sample has found is missing in both halves. Rare light, as a caustic of the sun, may
  /// exceed it.
  double bound() const { return kSafety * (relmse + 3 * standard_error); }
  static constexpr double kSafety = 1.5;
};

/// Writes to `picture` the mean P of both denoised halves, with that share of the noisy mean M for which the estimated
/// error is least: what the denoiser loses comes back as M gains samples, and the picture converges.
///
/// With the true picture I, halves A and B, and a and b made of them, these have the expectations
///   S = ((a - B)^2 + (b - A)^2 - (A - B)^2) / 2 - (a - b)^2 / 4     (P - I)^2
///   V = (A - B)^2 n_A n_B / n^2                                     (M - I)^2
/// since A and a are independent of B and b, and A and B have no bias: the error of a, judged by B, is too large by the
/// variance of B, which (A - B)^2 tells. What the denoiser does is of no importance. With Q = (P - M)^2, that of
/// P + s (M - P) is S + s (V - S - Q) + s^2 Q. The standard error takes pixels for independent: their samples are.
DenoisedError combine(const DenoisedHalves& halves, std::span<float> picture);

}  // namespace velour
