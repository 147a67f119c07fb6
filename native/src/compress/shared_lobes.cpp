#include "compress/shared_lobes.h"

#include <algorithm>
#include <numeric>

#include "btf/srbf_btf.h"
#include "compress/lobe_pursuit.h"
#include "compress/lobe_refinement.h"
#include "compress/lobe_values.h"
#include "job/parallel.h"
#include "sphere/random.h"

namespace velour {
namespace {

constexpr uint32_t kCandidates = 2048;                    // lobes to choose from
constexpr size_t kSearchPoints = 64, kSearchPairs = 400;  // that they are chosen by
constexpr size_t kColorPoints = 128, kColorPairs = 500;   // that the weaker colour axes choose by

/// Candidates, those of the tile's frame first.
struct Candidates {
  std::vector<MultivariateLobe> lobes;
  uint32_t tile_lobes;
};

/// A direction with z in [least_z, 1] times a bandwidth, evenly distributed by area and logarithm.
Vec3 random_vector(RandomStream& random, float least_z, float narrowest, float widest) {
  const float z = std::lerp(least_z, 1.0f, random.next()), phi = 2 * kPi * random.next(), s = std::sqrt(1 - z * z);
  return Vec3(s * std::cos(phi), s * std::sin(phi), z) * (narrowest * std::pow(widest / narrowest, random.next()));
}

MultivariateLobe random_lobe(RandomStream& random, bool texel) {
  MultivariateLobe lobe;
  const int kind = static_cast<int>(random.next() * 8);
  // Highlights of texels stand about their normals.
  const float half_z = texel ? 0.97f : 0.2f;
  if (kind < 3) {
    lobe.light = random_vector(random, 0, 0.7f, 60);
  } else if (kind < 5) {
    lobe.light = random_vector(random, 0, 0.7f, 40);
    lobe.view = random_vector(random, 0.1f, 0.5f, 20);
  } else if (kind == 5) {
    lobe.half = random_vector(random, half_z, 2, 400);
  } else if (kind == 6) {
    lobe.half = random_vector(random, half_z, 4, 400);
    lobe.light = random_vector(random, 0, 0.7f, 20);
  } else {
    lobe.view = random_vector(random, 0.1f, 0.5f, 20);
  }
  return lobe;
}

Candidates random_candidates(uint64_t seed) {
  Candidates candidates{{MultivariateLobe{}}, kCandidates / 2};  // the first is the constant
  for (uint32_t i = 1; i < kCandidates; ++i) {
    RandomStream random(seed, i, 2);
    candidates.lobes.push_back(random_lobe(random, i >= candidates.tile_lobes));
  }
  return candidates;
}

/// Values of an axis and of all lobes at the first points.
std::vector<PursuitPoint> pursuit_points(const std::vector<SurfacePoint>& points, const LobeValues& lobes, size_t axis,
                                         size_t most_points, size_t most_pairs, int threads, const Progress& progress) {
  std::vector<PursuitPoint> out(std::min(most_points, points.size()));
  parallel_pieces(out.size(), threads, progress, [&](size_t i) {
    out[i].column = lobes.at(points[i], most_pairs);
    out[i].value = Eigen::Map<const Eigen::VectorXf>(points[i].value[axis].data(), out[i].column.rows());
  });
  return out;
}

/// How many coefficients each axis gets when `count` go, one by one, to the axis whose next one explains the most.
std::array<size_t, 3> share_out(const std::array<PursuitChoice, 3>& choice, size_t count) {
  std::array<size_t, 3> share{};
  const auto left = [&](size_t a, size_t n) { return n == 0 ? choice[a].all : choice[a].left[n - 1]; };
  for (size_t i = 0; i < count; ++i) {
    double most = -1;
    size_t to = 3;
    for (size_t a = 0; a < 3; ++a) {
      if (share[a] >= choice[a].order.size()) continue;
      const double gain = left(a, share[a]) - left(a, share[a] + 1);
      if (gain > most) {
        most = gain;
        to = a;
      }
    }
    if (to == 3) break;
    ++share[to];
  }
  return share;
}

/// Nothing to explain, as in what is black, takes the constant: a model has a lobe.
void need_one(PursuitChoice& choice) {
  if (choice.order.empty()) choice = {{0}, {choice.all}, choice.all};
}

}  // namespace

SharedLobes choose_lobes(const std::vector<SurfacePoint>& points, const SharedLobeOptions& options,
                         Progress& progress) {
  const Candidates candidates = random_candidates(options.seed);
  std::array<PursuitChoice, 3> choice;
  {
    const LobeValues values(candidates.lobes, candidates.tile_lobes);
    for (size_t a = 0; a < 3; ++a) {
      auto search = pursuit_points(points, values, a, kSearchPoints, kSearchPairs, options.threads, progress);
      choice[a] = pursue(search, std::min(options.coefficients, SrbfBtf::kMaxLobes), options.threads, progress);
    }
  }
  need_one(choice[0]);
  const std::array<size_t, 3> share = share_out(choice, options.coefficients);
  SharedLobes shared;
  std::vector<size_t> chosen(choice[0].order.begin(), choice[0].order.begin() + static_cast<ptrdiff_t>(share[0]));
  std::sort(chosen.begin(), chosen.end());
  for (const size_t i : chosen) {
    shared.lobes.push_back(candidates.lobes[i]);
    shared.tile_lobes += i < candidates.tile_lobes;
  }
  shared.lobe[0].resize(share[0]);
  std::iota(shared.lobe[0].begin(), shared.lobe[0].end(), uint16_t{0});
  const RefinementOptions refinement{shared.tile_lobes, options.refinements, options.threads};
  shared.lobes = refine_lobes(points, std::move(shared.lobes), refinement, progress);
  const LobeValues values(shared.lobes, shared.tile_lobes);
  for (size_t a = 1; a < 3; ++a) {
    auto search = pursuit_points(points, values, a, kColorPoints, kColorPairs, options.threads, progress);
    const auto order = pursue(search, std::min(share[a], share[0]), options.threads, progress).order;
    for (const size_t i : order) shared.lobe[a].push_back(static_cast<uint16_t>(i));
  }
  return shared;
}

}  // namespace velour
