// The parts of a BSDF XML document (schema windows.lbl.gov/BSDF-v1.4), and the bases of its directions.
#pragma once

#include <array>
#include <charconv>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>
#include "math/sphere/vec.h"

namespace velour {

// A hemisphere of directions divided into rings of patches: the bases of Klems ([Kle94]) and others in BSDF XML files.

class KlemsBasis {
 public:
  /// Patches of a ring have the same size; the first is centered at azimuth 0.
  struct Ring {
    double least_theta, most_theta;  // degrees from the normal
    uint32_t patches;
  };
  struct Weighed {
    uint32_t patch;
    float weight;
  };

  /// Rings from the normal to the horizon, without gaps; at least one patch each.
  explicit KlemsBasis(const std::vector<Ring>& rings);

  /// Klems Full, Half or Quarter by its name in files ("LBNL/Klems Full"); nullptr for other names.
  static const KlemsBasis* standard(const std::string& name);

  uint32_t patches() const { return patches_; }

  /// Up to four patches whose centers surround a unit direction of the upper hemisphere, with weights that add up to 1:
  /// linear in the angle from the normal between rings, and in azimuth along each ring.
  std::array<Weighed, 4> around(const Vec3& w) const;

 private:
  struct Placed {
    float center;  // radians from the normal
    uint32_t first, patches;
  };
  std::vector<Placed> rings_;
  uint32_t patches_ = 0;
};

/// Every fault throws Error(bad_data, unsupported) and names the path and the field.
class BsdfXml {
 public:
  enum class Structure { columns, rows, tree3, tree4 };

  BsdfXml(std::span<const uint8_t> bytes, const std::string& path);

  /// Storage of the incident directions of ScatteringData.
  Structure structure() const { return structure_; }
  std::string name() const;

  /// The block of a wavelength ("Visible") and a side ("Reflection Front"); empty if there is none.
  pugi::xml_node block(std::string_view wavelength, std::string_view side) const;

  /// The basis that `field` (ColumnAngleBasis, RowAngleBasis) of a matrix's block names.
  const KlemsBasis& basis(const pugi::xml_node& block, const char* field) const;
  /// The values of a matrix's block.
  std::vector<float> numbers(const pugi::xml_node& block, size_t count) const;
  /// The text of a tree's block.
  std::string_view tree(const pugi::xml_node& block) const;

  [[noreturn]] void fail(const std::string& what) const;

 private:
  void read_structure();
  void read_bases();
  pugi::xml_node definition() const { return layer_.child("DataDefinition"); }

  std::string path_;
  pugi::xml_document xml_;
  pugi::xml_node layer_;
  Structure structure_ = Structure::columns;
  std::map<std::string, KlemsBasis> bases_;
};

// Reads numbers separated by commas or white space from a text.

inline void skip_separators(std::string_view& rest) {
  const size_t next = rest.find_first_not_of(", \t\n\v\f\r");
  rest.remove_prefix(next == std::string_view::npos ? rest.size() : next);
}

/// Removes the next number from `rest`. A number too small for a float becomes 0, one too large infinity. Nothing if no
/// number follows.
inline std::optional<float> next_number(std::string_view& rest) {
  skip_separators(rest);
  double value = 0;
  const auto [stop, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  const auto length = static_cast<size_t>(stop - rest.data());
  if (length == 0) return std::nullopt;
  if (error != std::errc()) {
    const bool is_tiny = rest.substr(0, length).find("e-") != std::string_view::npos ||
                         rest.substr(0, length).find("E-") != std::string_view::npos;
    value = is_tiny ? 0 : std::numeric_limits<double>::infinity();
  }
  rest.remove_prefix(length);
  return static_cast<float>(value);
}

}  // namespace velour
