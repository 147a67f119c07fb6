// The parts of a BSDF XML document (schema windows.lbl.gov/BSDF-v1.4), and the bases of its directions.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>
#include "base/text_number.h"
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

inline constexpr std::string_view kEndsOfNumbers = ", \t\n\v\f\r{}", kSeparators = kEndsOfNumbers.substr(0, 7);

inline void skip_separators(std::string_view& rest) {
  rest.remove_prefix(std::min(rest.find_first_not_of(kSeparators), rest.size()));
}

/// The next word of `rest`, shortened for a message.
inline std::string next_word(std::string_view rest) {
  skip_separators(rest);
  const std::string_view begin = rest.substr(0, 12);
  return std::string(begin.substr(0, begin.find_first_of(kSeparators)));
}

/// Removes the next number from `rest`. Nothing if no number follows, or one that does not end at a separator or brace.
inline std::optional<float> next_number(std::string_view& rest) {
  skip_separators(rest);
  const auto number = leading_number(rest);
  if (!number) return std::nullopt;
  const std::string_view after = rest.substr(number->length);
  if (!after.empty() && kEndsOfNumbers.find(after[0]) == std::string_view::npos) return std::nullopt;
  rest = after;
  return static_cast<float>(number->value);
}

}  // namespace velour
