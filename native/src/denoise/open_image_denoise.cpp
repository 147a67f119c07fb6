#include "denoise/open_image_denoise.h"

#include <memory>
#include <mutex>

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

}  // namespace velour
