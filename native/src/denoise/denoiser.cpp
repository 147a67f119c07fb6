#include "denoise/denoiser.h"

#include <tbb/info.h>
#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <vector>

namespace velour {

namespace {

constexpr const char* kRemedy =
    "Blender's official builds since 4.0 include it; elsewhere install it with scripts/setup --denoise, or set "
    "VELOUR_OIDN to the path of its library.";

std::mutex mutex;
std::string file;

}  // namespace

OpenImageDenoise::OpenImageDenoise(const std::string& first) : library("libOpenImageDenoise.so.2", kRemedy, first) {}

void set_open_image_denoise_file(const std::string& name) {
  const std::lock_guard lock(mutex);
  file = name;
}

const OpenImageDenoise& open_image_denoise() {
  // Never closed, because its threads may outlive any owner.
  static OpenImageDenoise* opened = nullptr;
  const std::lock_guard lock(mutex);
  if (opened == nullptr) opened = new OpenImageDenoise(file);
  return *opened;
}

namespace {

// Enumerators of oidn.h.
constexpr int kCpu = 1, kFloat3 = 3, kFast = 4, kBalanced = 5, kNoError = 0, kCancelled = 6;
constexpr int kFirstWithFast = 20300;  // 2.3

/// Many versions of oidn do not report a meaningful fraction, but all ask whether to continue.
bool goes_on(void* progress, double /*fraction*/) { return !static_cast<const Progress*>(progress)->cancelled(); }

}  // namespace

class Denoiser::Filter {
 public:
  Filter(const Denoiser& denoiser, const NoisyPicture& picture)
      : oidn_(denoiser.oidn_), picture_(picture), filter_(oidn_.NewFilter(denoiser.device_, "RT")) {
    // High quality takes twice the time for 5 % less error; more samples are a better use of that time.
    const bool fast = denoiser.effort_ == Effort::least && denoiser.number() >= kFirstWithFast;
    oidn_.SetFilterInt(filter_, "quality", fast ? kFast : kBalanced);
  }
  ~Filter() { oidn_.ReleaseFilter(filter_); }
  Filter(const Filter&) = delete;
  Filter& operator=(const Filter&) = delete;

  void input(const char* name, std::span<const float> pixels) {
    output(name, {const_cast<float*>(pixels.data()), pixels.size()});  // inputs are only read
  }
  void output(const char* name, std::span<float> pixels) {
    const auto width = static_cast<size_t>(picture_.width), height = static_cast<size_t>(picture_.height);
    if (pixels.size() != 3 * width * height) {
      throw Error(Status::invalid_argument,
                  std::string("The image to denoise and its ") + name + " must have the same size.");
    }
    oidn_.SetSharedFilterImage(filter_, name, pixels.data(), kFloat3, width, height, 0, 0, 0);
  }
  void set(const char* name) { oidn_.SetFilterBool(filter_, name, true); }

  void run(const Progress& progress) {
    oidn_.SetFilterProgressMonitorFunction(filter_, goes_on, const_cast<Progress*>(&progress));
    oidn_.CommitFilter(filter_);
    oidn_.ExecuteFilter(filter_);
  }

 private:
  const OpenImageDenoise& oidn_;
  const NoisyPicture& picture_;
  OpenImageDenoise::Filter filter_;
};

Denoiser::Denoiser(int threads, Effort effort)
    : oidn_(open_image_denoise()), effort_(effort), device_(oidn_.NewDevice(kCpu)) {
  if (device_ == nullptr) throw Error(Status::unsupported, path() + " does not support this processor.");
  oidn_.SetDeviceInt(device_, "numThreads", threads > 0 ? threads : tbb::info::default_concurrency());
  oidn_.SetDeviceBool(device_, "setAffinity", false);  // the host shares these threads
  oidn_.CommitDevice(device_);
  try {
    check(Progress{});
  } catch (...) {
    oidn_.ReleaseDevice(device_);
    throw;
  }
}

Denoiser::~Denoiser() { oidn_.ReleaseDevice(device_); }

void Denoiser::check(const Progress& progress) const {
  const char* message = nullptr;
  const int error = oidn_.GetDeviceError(device_, &message);
  if (error == kCancelled) progress.check();
  if (error == kNoError || error == kCancelled) return;
  throw Error(Status::unsupported,
              path() + " cannot denoise the image: " + (message != nullptr ? message : "unknown error"));
}

void Denoiser::prefilter(const NoisyPicture& picture, const char* name, std::span<const float> noisy,
                         std::span<float> clean, const Progress& progress) const {
  Filter filter(*this, picture);
  filter.input(name, noisy);
  filter.output("output", clean);
  filter.run(progress);
  check(progress);
}

void Denoiser::run(const NoisyPicture& picture, std::span<float> denoised, const Progress& progress) {
  std::vector<float> albedo, normal;
  NoisyPicture guided = picture;
  if (effort_ == Effort::usual) {
    albedo.resize(picture.albedo.size());
    normal.resize(picture.normal.size());
    prefilter(picture, "albedo", picture.albedo, albedo, progress);
    prefilter(picture, "normal", picture.normal, normal, progress);
    guided.albedo = albedo;
    guided.normal = normal;
  }
  Filter filter(*this, picture);
  filter.input("color", guided.color);
  filter.input("albedo", guided.albedo);
  filter.input("normal", guided.normal);
  filter.output("output", denoised);
  filter.set("hdr");
  if (effort_ == Effort::usual) filter.set("cleanAux");
  filter.run(progress);
  check(progress);
}

std::string Denoiser::version() const {
  const int n = number();
  return std::to_string(n / 10000) + "." + std::to_string(n / 100 % 100) + "." + std::to_string(n % 100);
}

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
