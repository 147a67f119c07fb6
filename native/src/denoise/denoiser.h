// Denoises pictures with Intel's Open Image Denoise 2, and estimates their error from two halves of the samples.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include "base/private_library.h"
#include "base/progress.h"

namespace velour {

// C interface of Intel's Open Image Denoise 2, bound at run time. Velour builds and runs without the library.

/// Table of the functions in use, declared as in oidn.h 2.0. Enumerator values are defined where they are used.
struct OpenImageDenoise {
  using Device = struct OpaqueDevice*;
  using Filter = struct OpaqueFilter*;
  using Monitor = bool(void* user, double fraction);  // false: cancel

  /// `file`: library file to try first; empty: none.
  explicit OpenImageDenoise(const std::string& file);

  PrivateLibrary library;
#define VELOUR_OIDN(type, name, ...) type (*const name)(__VA_ARGS__) = library.function<type(__VA_ARGS__)>("oidn" #name)
  VELOUR_OIDN(Device, NewDevice, int type);
  VELOUR_OIDN(void, SetDeviceInt, Device, const char* name, int value);
  VELOUR_OIDN(void, SetDeviceBool, Device, const char* name, bool value);
  VELOUR_OIDN(int, GetDeviceInt, Device, const char* name);
  VELOUR_OIDN(void, CommitDevice, Device);
  VELOUR_OIDN(int, GetDeviceError, Device, const char** message);
  VELOUR_OIDN(void, ReleaseDevice, Device);
  VELOUR_OIDN(Filter, NewFilter, Device, const char* type);
  VELOUR_OIDN(void, SetSharedFilterImage, Filter, const char* name, void* pixels, int format, size_t width,
              size_t height, size_t byte_offset, size_t pixel_stride, size_t row_stride);
  VELOUR_OIDN(void, SetFilterBool, Filter, const char* name, bool value);
  VELOUR_OIDN(void, SetFilterInt, Filter, const char* name, int value);
  VELOUR_OIDN(void, SetFilterProgressMonitorFunction, Filter, Monitor* monitor, void* user);
  VELOUR_OIDN(void, CommitFilter, Filter);
  VELOUR_OIDN(void, ExecuteFilter, Filter);
  VELOUR_OIDN(void, ReleaseFilter, Filter);
#undef VELOUR_OIDN
};

/// Sets the file that open_image_denoise() tries first. Empty: only libOpenImageDenoise.so.2 beside our own library and
/// on the system's library path. Has no effect once the library is open. Thread-safe.
void set_open_image_denoise_file(const std::string& file);

/// Opened by the first call and never closed. Throws Error(unsupported) that says what was tried and what to do.
const OpenImageDenoise& open_image_denoise();

/// Row-major pixels of 3 floats each: linear HDR color, and the albedo and normals that guide the filter.
struct NoisyPicture {
  int width, height;
  std::span<const float> color, albedo, normal;
};

/// Not thread-safe: each thread needs its own.
class Denoiser {
 public:
  enum class Effort {
    usual,
    least,  // a quarter of the time, for interactive use: a smaller network and unfiltered guides
  };
  /// Throws Error(unsupported) if Open Image Denoise is missing or does not support the processor. `threads` 0: all.
  explicit Denoiser(int threads, Effort effort = Effort::usual);
  ~Denoiser();
  Denoiser(const Denoiser&) = delete;
  Denoiser& operator=(const Denoiser&) = delete;

  /// Writes the colors to `denoised`. Albedo and normals are first filtered separately, so that their noise from depth
  /// of field or fine structure does not reach the picture, which has at least one pixel. Throws Error(cancelled).
  void run(const NoisyPicture& picture, std::span<float> denoised, const Progress& progress);

  /// "2.5.1"
  std::string version() const;
  const std::string& path() const { return oidn_.library.path(); }

 private:
  class Filter;
  void check(const Progress& progress) const;
  void prefilter(const NoisyPicture& picture, const char* name, std::span<const float> noisy, std::span<float> clean,
                 const Progress& progress) const;
  int number() const { return oidn_.GetDeviceInt(device_, "version"); }

  const OpenImageDenoise& oidn_;
  const Effort effort_;
  OpenImageDenoise::Device device_;
};

// A denoised picture from two independent halves of its samples, with an estimate of its error.

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
