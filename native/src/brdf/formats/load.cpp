#include <algorithm>
#include <filesystem>
#include <string_view>

#include "base/error.h"
#include "base/file.h"
#include "brdf/formats/cornell.h"
#include "brdf/formats/merl.h"
#include "brdf/formats/rgl.h"
#include "brdf/formats/window_bsdf.h"
#include "brdf/measure/brdf_table.h"
#include "brdf/measure/measurement.h"
#include "image/tensors/exr_tensors.h"

namespace velour {
namespace {

using Reader = std::shared_ptr<const Measurement> (*)(std::span<const uint8_t>, Provenance, const Progress&);

/// The reader of a format that takes too little time to be cancelled.
template <auto read>
std::shared_ptr<const Measurement> read_at_once(std::span<const uint8_t> bytes, Provenance provenance,
                                                const Progress&) {
  return read(bytes, std::move(provenance));
}

struct Format {
  bool (*recognize)(std::span<const uint8_t> head);
  Reader read;
};

/// Tried in order; each recognizes its own first bytes.
constexpr Format kFormats[] = {{looks_like_merl, read_at_once<read_merl>},
                               {looks_like_rgl, read_at_once<read_rgl>},
                               {looks_like_exr, read_at_once<read_brdf_table>},
                               {looks_like_window_bsdf, read_at_once<read_window_bsdf>}};
constexpr size_t kHeadBytes = 4096;

/// The first bytes of a text after a UTF-8 mark and comments, which may be as long as a lab report.
std::vector<uint8_t> head_after_comments(const std::string& path) {
  constexpr uint64_t kBlock = 1 << 16;
  const RandomAccessFile file(path);
  std::vector<uint8_t> block;
  bool in_comment = false;
  for (uint64_t at = 0; at < file.size(); at += block.size()) {
    block.resize(std::min(kBlock, file.size() - at));
    file.read(at, block);
    const bool has_mark = at == 0 && block.size() >= 3 && block[0] == 0xef && block[1] == 0xbb && block[2] == 0xbf;
    for (size_t i = has_mark ? 3 : 0; i < block.size(); ++i) {
      const uint8_t c = block[i];
      if (c == '#') in_comment = true;
      if (c == '\n' || c == '\r') in_comment = false;
      if (in_comment || c == ' ' || (c >= '\t' && c <= '\r')) continue;
      std::vector<uint8_t> head(std::min<uint64_t>(kHeadBytes, file.size() - at - i));
      file.read(at + i, head);
      return head;
    }
  }
  return {};
}

Reader reader_of(const std::string& path) {
  const std::vector<uint8_t> head = read_file_head(path, kHeadBytes);
  for (const Format& format : kFormats)
    if (format.recognize(head)) return format.read;
  return looks_like_cornell(head_after_comments(path)) ? read_cornell : nullptr;
}

/// Unsupported formats that users may try, with advice for each.
struct OtherFormat {
  std::string_view begin;   // first bytes of the file
  std::string_view inside;  // also contained in the file's first kHeadBytes
  const char* sentence;
};

constexpr OtherFormat kOtherFormats[] = {
    {"\x89HDF\r\n\x1a\n", "",
     "is an HDF5 file, for example X-Rite's AxF. Velour cannot read AxF, which requires X-Rite's library; export a "
     "table of BRDF values (MERL), or images per view and light direction, from the software that created it."},
    {"7z\xbc\xaf\x27\x1c", "",
     "is an archive, for example Substance's .sbsar: a procedural material, not a measurement. Export its textures and "
     "use them in a Principled BSDF."},
    {"PK\x03\x04", "",
     "is a ZIP archive. Unpack it and load the file inside. Velour cannot read Chaos's .vrscan, which only Chaos's "
     "library can decode."},
    {"", "<materialx",
     "is a MaterialX document: material parameters, not a measurement. Import it in Blender, or use its values in a "
     "Principled BSDF."},
    {"", "ASTM",
     "looks like an ASTM E1392 file, which Velour cannot read; convert it to a list of directions and values "
     "(Cornell's format, docs/reference/measurement_formats.md)."},
};

[[noreturn]] void refuse_file(const std::string& path) {
  const std::vector<uint8_t> head = read_file_head(path, kHeadBytes);
  const std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
  for (const OtherFormat& other : kOtherFormats) {
    if (text.starts_with(other.begin) && text.find(other.inside) != std::string_view::npos)
      throw Error(Status::unsupported, path + ": " + other.sentence);
  }
  throw Error(Status::unsupported, path +
                                       ": is not a measurement in a supported format; use MERL .binary, RGL .bsdf, "
                                       "Cornell .brdf, BSDF .xml or a Velour table.");
}

}  // namespace

std::shared_ptr<const Measurement> load_measurement(const std::string& path, const Progress& progress) {
  const Reader read = reader_of(path);
  if (!read) refuse_file(path);
  const auto bytes = read_file(path);
  Provenance provenance;
  provenance.path = path;
  provenance.name = std::filesystem::path(path).stem().string();
  provenance.sha256 = sha256_hex(bytes);
  provenance.file_bytes = bytes.size();
  return read(bytes, std::move(provenance), progress);
}

bool is_measurement_file(const std::string& path) { return reader_of(path) != nullptr; }

}  // namespace velour
