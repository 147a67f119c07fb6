// How coarse the first picture of a change is: as fine as is there at once on this machine.
#pragma once

namespace velour {

/// Levels halve the pixels' size: level 0 is the coarsest that there is, last() has the picture's own pixels. A picture
/// begins at first().
class FirstLevel {
 public:
  FirstLevel(int width, int height);

  int first() const { return first_; }
  int last() const { return last_; }
  /// What the picture's sides are divided by.
  int divisor(int level) const { return 1 << (last_ - level); }
  /// `seconds`: of rendering the first level, or a part of it. The next picture begins a level coarser or finer where
  /// that suits better.
  void took(double seconds, bool is_whole = true);

 private:
  int last_;
  int finest_;  // that a picture may begin at
  int first_;
};

/// Pixels of one side of a level.
constexpr int divided(int side, int divisor) { return (side + divisor - 1) / divisor; }

}  // namespace velour
