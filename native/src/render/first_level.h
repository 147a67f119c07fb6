// Resolution of the first image after a change: as fine as this machine renders at once.
#pragma once

namespace velour {

/// Each level halves the pixel size: level 0 is the coarsest, last() has the image's own pixels. An image begins at
/// first().
class FirstLevel {
 public:
  FirstLevel(int width, int height);

  int first() const { return first_; }
  int last() const { return last_; }
  /// Divisor of the sides of the image.
  int divisor(int level) const { return 1 << (last_ - level); }
  /// `seconds`: time taken by the first level, or by a part of it. The next image begins one level coarser or finer if
  /// that fits better.
  void took(double seconds, bool is_whole = true);

 private:
  int last_;
  int finest_;  // finest level that an image may begin at
  int first_;
};

/// Pixels along one side of a level.
constexpr int divided(int side, int divisor) { return (side + divisor - 1) / divisor; }

}  // namespace velour
