// libFuzzer's entry point: passes the bytes as a file to the reader named by the environment variable VELOUR_FUZZ. A
// reader may reject them only with an Error.
#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "brdf/formats/window_bsdf.h"
#include "brdf/measure/measurement.h"
#include "btf/formats/load_btf.h"
#include "btf/formats/picture_index.h"
#include "image/picture.h"
#include "model/file/model_file.h"
#include "scene/mesh_file.h"
#include "usage/observation.h"

namespace velour {
namespace {

void read_btf(const std::string& path) {
  const auto btf = load_btf(path);
  std::vector<HalfBits> values(btf->grid().texels() * 3);
  btf->read_pairs(0, 1, values);
}

/// A reader of its own, because other formats would take most of the time of the common reader.
void read_bsdf_xml(const std::string& path) {
  Provenance provenance;
  provenance.path = path;
  const auto measurement = read_window_bsdf(read_file(path), std::move(provenance));
  const Vec3 wl(0.6f, 0, 0.8f);
  Rgb f;
  uint8_t valid = 0;
  measurement->eval(Vec3(0, 0.6f, 0.8f), {&wl, 1}, {&f, 1}, {&valid, 1});
}

/// Blank pages of faxes have many more pixels than bytes: of such pictures only the headers are read.
bool is_small(const Picture& header) {
  constexpr double kMaxPixels = 16e6;
  return static_cast<double>(header.width) * header.height < kMaxPixels;
}

void read_colors(const std::string& path) {
  if (is_small(read_picture_header(path, {}))) read_picture(path);
}

void read_channels(const std::string& path) {
  if (is_small(read_picture_channels_header(path))) read_picture_channels(path);
}

using Reader = void (*)(const std::string& path);
struct Named {
  const char* name;
  const char* extension;  // if it selects the reader
  Reader read;
};

constexpr Named kReaders[] = {
    {"picture", "", read_colors},
    {"channels", ".exr", read_channels},
    {"measurement", "", [](const std::string& path) { load_measurement(path); }},
    {"bsdf_xml", "", read_bsdf_xml},
    {"btf", ".btf", read_btf},
    {"csv", ".csv", [](const std::string& path) { read_csv_index(path); }},
    {"observation", "", [](const std::string& path) { load_observation(path); }},
    {"model", "", [](const std::string& path) { load_model(path); }},
    {"obj", ".obj", [](const std::string& path) { read_obj(path); }},
    {"ply", ".ply", [](const std::string& path) { read_ply(path); }},
};

const Named& chosen() {
  const char* name = std::getenv("VELOUR_FUZZ");
  for (const Named& reader : kReaders) {
    if (name != nullptr && std::strcmp(name, reader.name) == 0) return reader;
  }
  std::fputs("VELOUR_FUZZ names no reader; there are:", stderr);
  for (const Named& reader : kReaders) std::fprintf(stderr, " %s", reader.name);
  std::fputc('\n', stderr);
  std::exit(2);
}

/// A file in memory whose path stays the same.
class File {
 public:
  explicit File(const char* extension)
      : path_("/dev/shm/velour-fuzz-" + std::to_string(getpid()) + extension),
        file_(open(path_.c_str(), O_CREAT | O_TRUNC | O_RDWR | O_CLOEXEC, 0600)) {
    if (file_ < 0) std::abort();
  }
  ~File() {
    close(file_);
    unlink(path_.c_str());
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  const std::string& with(const uint8_t* bytes, size_t count) {
    if (ftruncate(file_, 0) != 0 || pwrite(file_, bytes, count, 0) != static_cast<ssize_t>(count)) std::abort();
    return path_;
  }

 private:
  const std::string path_;
  const int file_;
};

}  // namespace
}  // namespace velour

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t count) {
  static const velour::Named& reader = velour::chosen();
  static velour::File file(reader.extension);
  try {
    reader.read(file.with(bytes, count));
  } catch (const velour::Error&) {  // the expected way to reject a file
  }
  return 0;
}
