#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <string_view>

#include "base/error.h"
#include "base/file.h"
#include "base/text_head.h"
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

/// Binary formats, tried in order; each recognizes its own first bytes.
constexpr Format kFormats[] = {{looks_like_merl, read_at_once<read_merl>},
                               {looks_like_rgl, read_at_once<read_rgl>},
                               {looks_like_exr, read_at_once<read_brdf_table>}};
constexpr size_t kHeadBytes = 4096;

/// Name of the first element of an XML file, without the prefix of its namespace; empty for other files.
std::string xml_root(const std::string& path) {
  const std::string head = read_text_head(path, kHeadBytes, Comments::xml);
  if (!head.starts_with('<')) return "";
  const auto begins_name = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  for (size_t at = 0; at < head.size(); at = std::min(head.find('<', at), head.size())) {
    if (++at == head.size() || !begins_name(head[at])) continue;  // a document type comes before the first element
    const std::string name = head.substr(at, head.find_first_of(" \n/>", at) - at);
    return name.substr(name.find(':') + 1);
  }
  return "";
}

Reader reader_of(const std::string& path) {
  const std::vector<uint8_t> head = read_file_head(path, kHeadBytes);
  for (const Format& format : kFormats)
    if (format.recognize(head)) return format.read;
  if (xml_root(path) == "WindowElement") return read_at_once<read_window_bsdf>;
  return looks_like_cornell(read_text_head(path, kHeadBytes, Comments::hash)) ? read_cornell : nullptr;
}

/// The header of ASTM E1392: a line that begins with the standard's number, or the line VARS, which names the columns.
bool looks_like_astm(std::string_view head) {
  while (!head.empty()) {
    std::string line(head.substr(0, head.find_first_of("\r\n")));
    head.remove_prefix(std::min(line.size() + 1, head.size()));
    std::ranges::transform(line, line.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    line.erase(0, line.find_first_not_of(" \t#;%/*\xef\xbb\xbf"));
    if (line.starts_with("ASTM") && line.find("1392") != std::string::npos) return true;
    if (line.starts_with("VARS") && line.find("THETA") != std::string::npos) return true;
  }
  return false;
}

/// Unsupported formats that users may try, with advice for each.
struct OtherFormat {
  bool (*recognize)(std::string_view head, std::string_view root_of_xml);
  const char* sentence;
};

constexpr OtherFormat kOtherFormats[] = {
    {[](auto head, auto) { return head.starts_with("\x89HDF\r\n\x1a\n"); },
     "is an HDF5 file, for example X-Rite's AxF. Velour cannot read AxF, which requires X-Rite's library; export a "
     "table of BRDF values (MERL), or images per view and light direction, from the software that created it."},
    {[](auto head, auto) { return head.starts_with("7z\xbc\xaf\x27\x1c"); },
     "is an archive, for example Substance's .sbsar: a procedural material, not a measurement. Export its textures and "
     "use them in a Principled BSDF."},
    {[](auto head, auto) { return head.starts_with("PK\x03\x04"); },
     "is a ZIP archive. Unpack it and load the file inside. Velour cannot read Chaos's .vrscan, which only Chaos's "
     "library can decode."},
    {[](auto, auto root) { return root == "materialx"; },
     "is a MaterialX document: material parameters, not a measurement. Import it in Blender, or use its values in a "
     "Principled BSDF."},
    {[](auto head, auto root) { return root.empty() && looks_like_astm(head); },
     "looks like an ASTM E1392 file, which Velour cannot read; convert it to a list of directions and values "
     "(Cornell's format, docs/reference/measurement_formats.md)."},
};

[[noreturn]] void refuse_file(const std::string& path) {
  constexpr size_t kSearched = 1 << 16;  // E1392 allows long headers
  const std::vector<uint8_t> bytes = read_file_head(path, kSearched);
  const std::string_view head(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::string root = xml_root(path);
  for (const OtherFormat& other : kOtherFormats)
    if (other.recognize(head, root)) throw Error(Status::unsupported, path + ": " + other.sentence);
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
