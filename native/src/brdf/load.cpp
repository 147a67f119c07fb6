#include <filesystem>

#include "brdf/brdf_table.h"
#include "brdf/cornell.h"
#include "brdf/measurement.h"
#include "brdf/merl.h"
#include "brdf/rgl.h"
#include "file/file.h"
#include "image/exr_tensors.h"
#include "job/error.h"

namespace velour {
namespace {

using Reader = std::shared_ptr<const Measurement> (*)(std::span<const uint8_t>, Provenance);

struct Format {
  bool (*recognise)(std::span<const uint8_t> head);
  Reader read;
};

/// Asked in order; each recognises its own first bytes.
constexpr Format kFormats[] = {{looks_like_merl, read_merl},
                               {looks_like_rgl, read_rgl},
                               {looks_like_exr, read_brdf_table},
                               {looks_like_cornell, read_cornell}};

/// Enough for the comments that open a Cornell file.
constexpr size_t kHeadBytes = 4096;

Reader reader_of(std::span<const uint8_t> head) {
  for (const Format& format : kFormats)
    if (format.recognise(head)) return format.read;
  return nullptr;
}

}  // namespace

std::shared_ptr<const Measurement> load_measurement(const std::string& path) {
  const Reader read = reader_of(read_file_head(path, kHeadBytes));
  if (!read)
    throw Error(Status::unsupported, path +
                                         ": is no measurement that Velour reads; use MERL .binary, RGL .bsdf, "
                                         "Cornell .brdf or a Velour table.");
  const auto bytes = read_file(path);
  Provenance provenance;
  provenance.path = path;
  provenance.name = std::filesystem::path(path).stem().string();
  provenance.sha256 = sha256_hex(bytes);
  provenance.file_bytes = bytes.size();
  return read(bytes, std::move(provenance));
}

bool is_measurement_file(const std::string& path) { return reader_of(read_file_head(path, kHeadBytes)) != nullptr; }

}  // namespace velour
