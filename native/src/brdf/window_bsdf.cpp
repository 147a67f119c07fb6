#include "brdf/window_bsdf.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <string_view>

#include "brdf/entries.h"
#include "brdf/klems_basis.h"
#include "brdf/spectrum.h"
#include "job/error.h"

namespace velour {
namespace {

constexpr uint32_t kMostPatches = 4096;  // of a basis; Klems's have 145
constexpr const char* kSides[] = {"Reflection Front", "Reflection Back"};

/// f of a light's patch and a viewer's, light by light within each viewer's.
class KlemsMeasurement final : public Measurement {
 public:
  KlemsMeasurement(KlemsBasis light, KlemsBasis view, std::vector<Rgb> f, std::vector<uint8_t> valid,
                   Provenance provenance, const EntryCounts& counts, std::string side)
      : light_(std::move(light)),
        view_(std::move(view)),
        f_(std::move(f)),
        valid_(std::move(valid)),
        side_(std::move(side)) {
    provenance_ = std::move(provenance);
    counts_ = counts;
  }

  void eval(const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f, std::span<uint8_t> valid) const override {
    const auto viewers = view_.around(wv);
    for (size_t i = 0; i < wl.size(); ++i) {
      f[i] = Rgb(0);
      float weights = 0;
      if (wv.z > 0 && wl[i].z > 0) {
        // Incident directions are numbered by where the light goes: what a mirror reflects has one number.
        for (const auto& light : light_.around(Vec3(-wl[i].x, -wl[i].y, wl[i].z))) {
          for (const auto& viewer : viewers) {
            const size_t entry = size_t{viewer.patch} * light_.patches() + light.patch;
            const float weight = light.weight * viewer.weight;
            if (!valid_[entry]) continue;
            f[i] += weight * f_[entry];
            weights += weight;
          }
        }
      }
      valid[i] = weights > 1e-6f;
      if (valid[i]) f[i] /= weights;
    }
  }

  bool isotropic() const override { return false; }
  bool covers_view(float /*theta_v*/) const override { return true; }

  std::vector<std::pair<std::string, std::string>> details() const override {
    return {{"table", std::to_string(light_.patches()) + " directions of light x " + std::to_string(view_.patches()) +
                          " of view, in rings"},
            {"holds", "f without cosine, 1/sr, " + side_},
            {"invalid", "an entry that is not finite or of negative luminance"},
            {"interpolation", "linear between the centres of patches, in the angle from the normal and in azimuth"}};
  }

 private:
  const KlemsBasis light_, view_;
  const std::vector<Rgb> f_;
  const std::vector<uint8_t> valid_;
  const std::string side_;
};

class Document {
 public:
  Document(std::span<const uint8_t> bytes, const std::string& path) : path_(path) {
    const pugi::xml_parse_result parsed = xml_.load_buffer(bytes.data(), bytes.size());
    if (!parsed) {
      fail("is no whole XML document: " + std::string(parsed.description()) + " at byte " +
           std::to_string(parsed.offset) + ".");
    }
    layer_ = xml_.child("WindowElement").child("Optical").child("Layer");
    if (!layer_) fail("has no WindowElement/Optical/Layer; it is no BSDF.");
    read_bases();
  }

  bool has_rows_of_light() const {
    const std::string structure = text(definition().child("IncidentDataStructure"));
    if (structure == "Rows") return true;
    if (structure == "Columns") return false;
    if (structure.starts_with("TensorTree")) {
      throw Error(Status::unsupported, path_ + ": is a BSDF as a tensor tree (" + structure +
                                           "), of which Velour reads matrices alone; convert it with Radiance's "
                                           "bsdf2klems, or to a list of directions and values (docs/formats.md).");
    }
    fail("has the IncidentDataStructure '" + structure + "', neither Columns nor Rows.");
  }

  /// The block of a wavelength ("Visible") and a side; none: empty.
  pugi::xml_node block(std::string_view wavelength, std::string_view side) const {
    for (const pugi::xml_node data : layer_.children("WavelengthData")) {
      if (text(data.child("Wavelength")) != wavelength) continue;
      for (const pugi::xml_node block : data.children("WavelengthDataBlock")) {
        if (text(block.child("WavelengthDataDirection")) == side) return block;
      }
    }
    return {};
  }

  const KlemsBasis& basis(const pugi::xml_node& block, const char* field) const {
    const std::string name = text(block.child(field));
    const auto own = bases_.find(name);
    if (own != bases_.end()) return own->second;
    const KlemsBasis* known = KlemsBasis::standard(name);
    if (known == nullptr) fail(std::string(field) + " '" + name + "' is not defined in it.");
    return *known;
  }

  std::vector<float> numbers(const pugi::xml_node& block, size_t count) const {
    const std::string_view all = block.child("ScatteringData").text().get();
    std::vector<float> values;
    values.reserve(std::min(count, all.size() / 2 + 1));
    const char* at = all.data();
    const char* const end = at + all.size();
    while (true) {
      while (at != end && (*at == ',' || *at == ' ' || (*at >= '\t' && *at <= '\r'))) ++at;
      if (at == end) break;
      float value = 0;
      const auto [stop, error] = std::from_chars(at, end, value);
      if (stop == at)
        fail("ScatteringData has '" + std::string(at, std::min(end, at + 12)) + "' where a number is due.");
      values.push_back(error == std::errc() ? value : NAN);
      at = stop;
    }
    if (values.size() != count) {
      fail("ScatteringData has " + std::to_string(values.size()) + " values, its angle bases make " +
           std::to_string(count) + ".");
    }
    return values;
  }

  std::string name() const { return text(layer_.child("Material").child("Name")); }

  [[noreturn]] void fail(const std::string& what) const { throw Error(Status::bad_data, path_ + ": " + what); }

 private:
  static std::string text(const pugi::xml_node& node) {
    const std::string_view all = node.text().get();
    const size_t first = all.find_first_not_of(" \t\r\n"), last = all.find_last_not_of(" \t\r\n");
    return first == std::string_view::npos ? "" : std::string(all.substr(first, last - first + 1));
  }

  pugi::xml_node definition() const { return layer_.child("DataDefinition"); }

  void read_bases() {
    for (const pugi::xml_node basis : definition().children("AngleBasis")) {
      std::vector<KlemsBasis::Ring> rings;
      uint64_t patches = 0;
      for (const pugi::xml_node block : basis.children("AngleBasisBlock")) {
        const pugi::xml_node bounds = block.child("ThetaBounds");
        const double least = bounds.child("LowerTheta").text().as_double(NAN);
        const double most = bounds.child("UpperTheta").text().as_double(NAN);
        const uint32_t count = block.child("nPhis").text().as_uint();
        const double expected = rings.empty() ? 0 : rings.back().most_theta;
        if (!(std::abs(least - expected) < 1e-3 && most > least && most < 90.001) || count == 0 ||
            (patches += count) > kMostPatches) {
          fail("AngleBasis '" + text(basis.child("AngleBasisName")) + "': ring " + std::to_string(rings.size() + 1) +
               " is from " + std::to_string(least) + " to " + std::to_string(most) + " degrees with " +
               std::to_string(count) + " patches; rings follow each other to 90, with 4096 patches at most.");
        }
        rings.push_back({expected, most, count});
      }
      if (rings.empty()) continue;  // one that everybody knows
      if (rings.back().most_theta < 89.999) {
        fail("AngleBasis '" + text(basis.child("AngleBasisName")) + "' ends at " +
             std::to_string(rings.back().most_theta) + " degrees; its rings have to go on to 90.");
      }
      bases_.emplace(text(basis.child("AngleBasisName")), KlemsBasis(rings));
    }
  }

  std::string path_;
  pugi::xml_document xml_;
  pugi::xml_node layer_;
  std::map<std::string, KlemsBasis> bases_;
};

/// By the viewer's patch, then the light's.
std::vector<float> matrix(const Document& in, const pugi::xml_node& block, size_t lights, size_t views) {
  std::vector<float> values = in.numbers(block, lights * views);
  if (!in.has_rows_of_light()) return values;
  std::vector<float> turned(values.size());
  for (size_t light = 0; light < lights; ++light) {
    for (size_t view = 0; view < views; ++view) turned[view * lights + light] = values[light * views + view];
  }
  return turned;
}

}  // namespace

bool looks_like_window_bsdf(std::span<const uint8_t> head) {
  const std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
  const size_t element = text.find("<WindowElement");
  return element != std::string_view::npos && text.find_first_not_of(" \t\r\n\xef\xbb\xbf") == text.find('<');
}

std::shared_ptr<const Measurement> read_window_bsdf(std::span<const uint8_t> bytes, Provenance provenance) {
  const Document in(bytes, provenance.path);
  static_cast<void>(in.has_rows_of_light());  // says first what cannot be read
  const char* side = in.block("Visible", kSides[0]) ? kSides[0] : kSides[1];
  const pugi::xml_node visible = in.block("Visible", side);
  if (!visible) in.fail("has no reflection of visible light; what lets light through alone is no BRDF.");
  const KlemsBasis &light = in.basis(visible, "ColumnAngleBasis"), &view = in.basis(visible, "RowAngleBasis");
  const size_t lights = light.patches(), views = view.patches();
  const std::vector<float> y = matrix(in, visible, lights, views);
  std::vector<Rgb> f(y.size());
  const pugi::xml_node x_block = in.block("CIE-X", side), z_block = in.block("CIE-Z", side);
  if (x_block && z_block) {
    const std::vector<float> x = matrix(in, x_block, lights, views), z = matrix(in, z_block, lights, views);
    for (size_t i = 0; i < f.size(); ++i) f[i] = rec709_of_xyz(Vec3d(x[i], y[i], z[i]));
  } else {
    for (size_t i = 0; i < f.size(); ++i) f[i] = Rgb(y[i]);
  }
  EntryCounts counts;
  std::vector<uint8_t> valid(f.size());
  for (size_t i = 0; i < f.size(); ++i) valid[i] = count_entry(f[i], NegativeRule::luminance, counts);
  provenance.format = "window-bsdf";
  provenance.description = in.name();
  const std::string said = std::string(side == kSides[0] ? "of the front" : "of the back") +
                           (x_block && z_block ? ", in colour" : ", of visible light: grey");
  return std::make_shared<KlemsMeasurement>(light, view, std::move(f), std::move(valid), std::move(provenance), counts,
                                            said);
}

}  // namespace velour
