// Many independent renders of one picture: means with errors, compared block by block.
#pragma once

#include <span>

#include "support/statistics.h"

namespace velour::test {

/// Luminance of RGBA pictures of one size. Square blocks of `block` pixels and the whole picture are means of their
/// own, so that neighboring pixels may be correlated within one render.
class PictureMeans {
 public:
  PictureMeans(int width, int height, int block);
  void add(std::span<const float> rgba);

  Estimate whole() const { return whole_.estimate(); }
  /// Relative standard error of the whole.
  double relative_error() const { return whole_.standard_error() / whole_.mean(); }

  /// Adds "NAME whole" and "NAME block X Y" to the list. A failed one leaves FOUND, EXPECTED and their z-map as OpenEXR
  /// pictures: artifacts NAME.found.exr, NAME.expected.exr, NAME.z.exr.
  friend void compare(const std::string& name, const PictureMeans& found, const PictureMeans& expected, ZTests& tests);

 private:
  size_t blocks_across() const;
  std::string write_evidence(const std::string& name, const PictureMeans& expected) const;

  int width_, height_, block_;
  std::vector<RunningMean> pixels_, blocks_;
  RunningMean whole_;
};

void compare(const std::string& name, const PictureMeans& found, const PictureMeans& expected, ZTests& tests);

}  // namespace velour::test
