#include "brdf/formats/bsdf_xml.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"

namespace velour {

namespace {

using Ring = KlemsBasis::Ring;

/// The two patches of a ring of `patches` around an azimuth, with weights that add up to `weight`.
void along_ring(uint32_t first, uint32_t patches, float azimuth, float weight, KlemsBasis::Weighed* out) {
  const float place = azimuth / (2 * kPi) * static_cast<float>(patches);
  const float below = std::floor(place), share = place - below;
  const auto lower = static_cast<uint32_t>(below) % patches;
  out[0] = {first + lower, weight * (1 - share)};
  out[1] = {first + (lower + 1) % patches, weight * share};
}

}  // namespace

KlemsBasis::KlemsBasis(const std::vector<Ring>& rings) {
  for (const Ring& ring : rings) {
    const bool is_cap = ring.least_theta == 0 && ring.patches == 1;  // its center is the normal
    const double center = is_cap ? 0.0 : (ring.least_theta + ring.most_theta) / 2;
    rings_.push_back({static_cast<float>(radians_from(center)), patches_, ring.patches});
    patches_ += ring.patches;
  }
}

const KlemsBasis* KlemsBasis::standard(const std::string& name) {
  static const std::pair<const char*, KlemsBasis> kBases[] = {
      {"LBNL/Klems Full", KlemsBasis({{0, 5, 1},
                                      {5, 15, 8},
                                      {15, 25, 16},
                                      {25, 35, 20},
                                      {35, 45, 24},
                                      {45, 55, 24},
                                      {55, 65, 24},
                                      {65, 75, 16},
                                      {75, 90, 12}})},
      {"LBNL/Klems Half", KlemsBasis({{0, 6.5, 1},
                                      {6.5, 19.5, 8},
                                      {19.5, 32.5, 12},
                                      {32.5, 46.5, 16},
                                      {46.5, 61.5, 20},
                                      {61.5, 76.5, 12},
                                      {76.5, 90, 4}})},
      {"LBNL/Klems Quarter", KlemsBasis({{0, 9, 1}, {9, 27, 8}, {27, 46, 12}, {46, 66, 12}, {66, 90, 8}})}};
  for (const auto& [known, basis] : kBases) {
    if (name == known) return &basis;
  }
  return nullptr;
}

std::array<KlemsBasis::Weighed, 4> KlemsBasis::around(const Vec3& w) const {
  const float theta = std::acos(std::clamp(w.z, -1.0f, 1.0f));
  float azimuth = std::atan2(w.y, w.x);
  if (azimuth < 0) azimuth += 2 * kPi;
  const auto above = std::upper_bound(rings_.begin(), rings_.end(), theta,
                                      [](float angle, const Placed& ring) { return angle < ring.center; });
  const Placed& lower = above == rings_.begin() ? *above : *std::prev(above);
  const Placed& upper = above == rings_.end() ? lower : *above;
  const float gap = upper.center - lower.center;
  const float share = gap > 0 ? std::clamp((theta - lower.center) / gap, 0.0f, 1.0f) : 0.0f;
  std::array<Weighed, 4> found;
  along_ring(lower.first, lower.patches, azimuth, 1 - share, &found[0]);
  along_ring(upper.first, upper.patches, azimuth, share, &found[2]);
  return found;
}

namespace {

constexpr double kMaxPatches = 4096;  // per basis; Klems Full has 145
constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// Elements are known by their local names; the prefix of their namespace is up to the file.
void remove_prefixes(pugi::xml_document& document) {
  struct Walker : pugi::xml_tree_walker {
    bool for_each(pugi::xml_node& node) override {
      const std::string_view name = node.name();
      const size_t colon = name.find(':');
      if (colon != std::string_view::npos) node.set_name(std::string(name.substr(colon + 1)).c_str());
      return true;
    }
  } walker;
  document.traverse(walker);
}

std::string text_of(const pugi::xml_node& node) {
  const std::string_view all = node.text().get();
  const size_t first = all.find_first_not_of(" \t\r\n"), last = all.find_last_not_of(" \t\r\n");
  return first == std::string_view::npos ? "" : std::string(all.substr(first, last - first + 1));
}

}  // namespace

BsdfXml::BsdfXml(std::span<const uint8_t> bytes, const std::string& path) : path_(path) {
  const pugi::xml_parse_result parsed = xml_.load_buffer(bytes.data(), bytes.size());
  if (!parsed) {
    fail("is not a valid XML document: " + std::string(parsed.description()) + " at byte " +
         std::to_string(parsed.offset) + "; it may be truncated. Download or export it again.");
  }
  remove_prefixes(xml_);
  layer_ = xml_.child("WindowElement").child("Optical").child("Layer");
  if (!layer_) fail("has no WindowElement/Optical/Layer element; it is not a BSDF file.");
  read_structure();
  read_bases();
}

std::string BsdfXml::name() const { return text_of(layer_.child("Material").child("Name")); }

pugi::xml_node BsdfXml::block(std::string_view wavelength, std::string_view side) const {
  for (const pugi::xml_node data : layer_.children("WavelengthData")) {
    if (text_of(data.child("Wavelength")) != wavelength) continue;
    for (const pugi::xml_node block : data.children("WavelengthDataBlock")) {
      if (text_of(block.child("WavelengthDataDirection")) == side) return block;
    }
  }
  return {};
}

const KlemsBasis& BsdfXml::basis(const pugi::xml_node& block, const char* field) const {
  const std::string name = text_of(block.child(field));
  const auto own = bases_.find(name);
  if (own != bases_.end()) return own->second;
  const KlemsBasis* known = KlemsBasis::standard(name);
  if (known == nullptr)
    fail(std::string(field) + " '" + name + "' is neither defined in the file nor a standard basis of LBNL.");
  return *known;
}

std::vector<float> BsdfXml::numbers(const pugi::xml_node& block, size_t count) const {
  std::string_view rest = block.child("ScatteringData").text().get();
  std::vector<float> values;
  values.reserve(std::min(count, rest.size() / 2 + 1));
  while (const auto value = next_number(rest)) values.push_back(*value);
  const std::string where = "ScatteringData of " + text_of(block.child("WavelengthDataDirection")) + ", " +
                            text_of(block.parent().child("Wavelength")) + ", has ";
  if (!rest.empty()) {
    fail(where + "'" + next_word(rest) + "' where value " + std::to_string(values.size() + 1) +
         " is expected; write numbers as 0.17 or 1.7e-1, separated by commas or blanks.");
  }
  if (values.size() != count) {
    fail(where + std::to_string(values.size()) + " values, but its angle bases require " + std::to_string(count) + ".");
  }
  return values;
}

std::string_view BsdfXml::tree(const pugi::xml_node& block) const {
  const std::string basis = text_of(block.child("AngleBasis"));
  if (basis != "LBNL/Shirley-Chiu") {
    throw Error(Status::unsupported,
                path_ + ": AngleBasis '" + basis + "' of a tensor tree is not supported; use LBNL/Shirley-Chiu.");
  }
  return block.child("ScatteringData").text().get();
}

void BsdfXml::fail(const std::string& what) const { throw Error(Status::bad_data, path_ + ": " + what); }

void BsdfXml::read_structure() {
  const std::string name = text_of(definition().child("IncidentDataStructure"));
  const std::pair<const char*, Structure> known[] = {{"Columns", Structure::columns},
                                                     {"Rows", Structure::rows},
                                                     {"TensorTree3", Structure::tree3},
                                                     {"TensorTree4", Structure::tree4}};
  const auto found = std::ranges::find(known, name, [](const auto& one) { return one.first; });
  if (found == std::end(known)) {
    fail("IncidentDataStructure is '" + name + "'; it must be Columns, Rows, TensorTree3 or TensorTree4.");
  }
  structure_ = found->second;
}

void BsdfXml::read_bases() {
  for (const pugi::xml_node basis : definition().children("AngleBasis")) {
    std::vector<KlemsBasis::Ring> rings;
    double patches = 0;
    for (const pugi::xml_node block : basis.children("AngleBasisBlock")) {
      const pugi::xml_node bounds = block.child("ThetaBounds");
      const std::string lower = text_of(bounds.child("LowerTheta")), upper = text_of(bounds.child("UpperTheta")),
                        phis = text_of(block.child("nPhis"));
      const double least = number_from(lower).value_or(kMissing), most = number_from(upper).value_or(kMissing),
                   count = number_from(phis).value_or(kMissing);
      const double expected = rings.empty() ? 0 : rings.back().most_theta;
      if (!(std::abs(least - expected) < 1e-3 && most > least && most < 90.001) ||
          !(count >= 1 && count == std::floor(count) && (patches += count) <= kMaxPatches)) {
        fail("AngleBasis '" + text_of(basis.child("AngleBasisName")) + "': ring " + std::to_string(rings.size() + 1) +
             " spans '" + lower + "' to '" + upper + "' degrees with '" + phis +
             "' patches; rings must follow each other up to 90 degrees and have at most 4096 patches in all.");
      }
      rings.push_back({expected, most, static_cast<uint32_t>(count)});
    }
    if (rings.empty()) continue;  // a standard basis
    if (rings.back().most_theta < 89.999) {
      fail("AngleBasis '" + text_of(basis.child("AngleBasisName")) + "' ends at " +
           std::to_string(rings.back().most_theta) + " degrees; its rings must reach 90 degrees.");
    }
    bases_.emplace(text_of(basis.child("AngleBasisName")), KlemsBasis(rings));
  }
}

}  // namespace velour
