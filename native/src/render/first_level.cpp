#include "render/first_level.h"

namespace velour {
namespace {

/// Pixels at most of what a picture begins with, and of the coarsest level.
constexpr int kFirstPixels = 16000;
constexpr int kCoarsestPixels = 1000;
/// Of the first level. A change is seen in the redraw at hand if it is ready within the add-on's patience (40 ms), in
/// which the hierarchy and the lights are made anew as well.
constexpr double kLateSeconds = 0.015;
/// A level finer takes four times as long; twice that is left, lest pictures go to and fro.
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
