// Error of images reconstructed over a relief, whatever the texels' model.
#pragma once

#include <vector>

#include "compress/direction_bases.h"

namespace velour {

/// Reconstructs images from the values of the relief's texels in them (shown_texels): where a view ray hits the relief,
/// from those of the four texels there that the view shows. The difference from the images is lost by interpolating
/// twice between texels, and near edges, where some of the four are hidden. Pixels whose four texels are all hidden do
/// not count.
class ReliefGap {
 public:
  /// Uses `pixels` random pixels of each view.
  ReliefGap(const TensorSource& source, size_t pixels, const Progress& progress);

  /// Call once per view, with its finest level.
  void add_view(Index view, const LevelImages& images);
  /// Squares of the difference relative to those of the images; 0 on the plane.
  double share() const;

 private:
  struct Squares {
    double difference = 0, image = 0;
  };
  const TensorSource& source_;
  const Progress& progress_;
  std::vector<uint32_t> pixel_;
  std::vector<Squares> squares_;  // per pixel
};

}  // namespace velour
