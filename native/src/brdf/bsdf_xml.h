// The parts of a BSDF XML document (schema windows.lbl.gov/BSDF-v1.4).
#pragma once

#include <map>
#include <pugixml.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "brdf/klems_basis.h"

namespace velour {

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

}  // namespace velour
