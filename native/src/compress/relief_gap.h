// What a relief leaves of the images, whatever its texels are made of.
#pragma once

#include <vector>

#include "compress/direction_bases.h"

namespace velour {

/// Puts images together from what the texels of the relief show in them (shown_texels): where a view's ray meets the
/// relief, the four texels there, of those the ones that the view shows. What that differs by from the images is lost
/// by looking up twice between texels, and about edges, where some of the four hide. Pixels whose four all hide do not
/// count.
class ReliefGap {
 public:
  /// Judges by `pixels` random ones, of each view.
  ReliefGap(const TensorSource& source, size_t pixels, const Progress& progress);

  /// The finest level of every view once.
  void add_view(Index view, const LevelImages& images);
  /// Squares of the difference over those of the images; 0 on the plane.
  double share() const;

 private:
  struct Squares {
    double difference = 0, image = 0;
  };
  const TensorSource& source_;
  const Progress& progress_;
  std::vector<uint32_t> pixel_;
  std::vector<Squares> squares_;  // of each pixel
};

}  // namespace velour
