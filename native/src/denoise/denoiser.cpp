#include "denoise/denoiser.h"

#include <tbb/info.h>

#include <vector>

namespace velour {
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

}  // namespace velour
