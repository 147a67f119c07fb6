#include "render/first_level.h"

namespace velour {
namespace {

/// Maximum number of pixels of the first level, and of the coarsest one.
constexpr int kFirstPixels = 16000;
constexpr int kCoarsestPixels = 1000;
/// Maximum time of the first level. A change is visible in the current redraw if it is ready within the add-on's
/// patience (40 ms), in which the hierarchy and the lights are rebuilt as well.
constexpr double kLateSeconds = 0.015;
/// The next finer level takes four times as long; the remaining factor of two keeps images from alternating.
constexpr double kEarlySeconds = kLateSeconds / 8;

int halvings(int width, int height, int most_pixels) {
  int n = 0;
  while (divided(width, 1 << n) * divided(height, 1 << n) > most_pixels) ++n;
  return n;
}

}  // namespace

FirstLevel::FirstLevel(int width, int height)
    : last_(halvings(width, height, kCoarsestPixels)),
      finest_(last_ - halvings(width, height, kFirstPixels)),
      first_(finest_) {}

void FirstLevel::took(double seconds, bool is_whole) {
  if (seconds > kLateSeconds && first_ > 0) {
    --first_;
  } else if (is_whole && seconds < kEarlySeconds && first_ < finest_) {
    ++first_;
  }
}

}  // namespace velour
