#include "verdict/look.h"

#include <algorithm>
#include <cmath>

#include "image/flip.h"

namespace velour {

namespace {

constexpr double kGrazing = 60;     // degrees
constexpr float kBright = 0.5f;     // exposed luminance of highlights
constexpr double kTwice = 2;        // FLIP of a part of the pixels that stands out, relative to the others
constexpr double kLeast = 1e-9;     // FLIP of pixels that do not differ
constexpr double kExplained = 0.5;  // of FLIP remains, at most, if its reason is taken away

/// A mean over some of the pixels.
class Mean {
 public:
  void add(double value) { sum_ += value, ++count_; }
  double value() const { return count_ > 0 ? sum_ / count_ : 0; }

 private:
  double sum_ = 0, count_ = 0;
};

/// FLIP of all pixels of the pictures, and its means over parts of them.
struct Differences {
  std::vector<float> flip;
  Mean all, grazing, facing, bright, dim;
  Mean log_luminance;  // of the ratio of the pictures' means

  double percentile_95() {
    const auto at = flip.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(flip.size() - 1));
    std::nth_element(flip.begin(), at, flip.end());
    return *at;
  }
};

LinearPicture displayed(LinearPicture picture) {
  for (Rgb& c : picture.pixels) c = glm::min(c, 1.0f);
  return picture;
}

void add_pair(const PicturePair& pair, Differences& out) {
  const LinearPicture measured = displayed(pair.measured), shown = displayed(pair.shown);
  const std::vector<float> flip = flip_map(measured, shown);
  for (size_t i = 0; i < pair.object.size(); ++i) {
    const float value = flip[pair.object[i]];
    out.flip.push_back(value);
    out.all.add(value);
    (pair.view_angle[i] > static_cast<float>(radians_from(kGrazing)) ? out.grazing : out.facing).add(value);
    const float brighter =
        std::max(luminance(measured.pixels[pair.object[i]]), luminance(shown.pixels[pair.object[i]]));
    (brighter > kBright ? out.bright : out.dim).add(value);
  }
  out.log_luminance.add(std::log(std::clamp(pair.luminance_ratio, 1e-6, 1e6)));
}

Differences differences_of(const std::vector<PicturePair>& pairs, const Progress& progress) {
  Differences out;
  for (const PicturePair& pair : pairs) {
    progress.check();
    add_pair(pair, out);
  }
  return out;
}

/// Mean FLIP after a change of every pair.
template <class Change>
double flip_after(std::vector<PicturePair> pairs, const Progress& progress, const Change& change) {
  for (PicturePair& pair : pairs) change(pair);
  return differences_of(pairs, progress).all.value();
}

void equal_brightness(PicturePair& pair) {
  const auto scale = static_cast<float>(1 / std::clamp(pair.luminance_ratio, 1e-6, 1e6));
  for (const uint32_t i : pair.object) pair.shown.pixels[i] *= scale;
}

void without_color(PicturePair& pair) {
  for (LinearPicture* picture : {&pair.measured, &pair.shown}) {
    for (Rgb& c : picture->pixels) c = Rgb(luminance(glm::min(c, 1.0f)));
  }
}

}  // namespace

std::optional<Verdict> verdict_of(const std::vector<PicturePair>& pairs, const Progress& progress) {
  Differences found = differences_of(pairs, progress);
  if (found.flip.empty()) return std::nullopt;
  Verdict verdict;
  verdict.flip_mean = found.all.value();
  verdict.flip_95 = found.percentile_95();
  const bool good = verdict.flip_mean <= kGoodMean && verdict.flip_95 <= kGoodPercentile;
  verdict.quality = good ? LookQuality::good : verdict.flip_mean <= kFairMean ? LookQuality::fair : LookQuality::poor;
  return verdict;
}

bool explains(double remaining, const Verdict& verdict) { return remaining < kExplained * verdict.flip_mean; }

void explain_look(const std::vector<PicturePair>& pairs, const Progress& progress, Verdict& verdict) {
  const auto because = [&](LookReason reason, double value = 0) { verdict.reason = reason, verdict.value = value; };
  const Differences found = differences_of(pairs, progress);
  if (explains(flip_after(pairs, progress, equal_brightness), verdict)) {
    return because(LookReason::brightness, std::exp(found.log_luminance.value()));
  }
  if (explains(flip_after(pairs, progress, without_color), verdict)) return because(LookReason::color);
  // A part that differs may also be the brighter one: the reason is what stands out most.
  const double bright = found.bright.value() / std::max(found.dim.value(), kLeast);
  const double grazing = found.grazing.value() / std::max(found.facing.value(), kLeast);
  if (std::max(bright, grazing) <= kTwice) return because(LookReason::everywhere);
  if (bright > grazing) return because(LookReason::highlights);
  because(LookReason::grazing_views, kGrazing);
}

}  // namespace velour
