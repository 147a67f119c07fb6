#include "occlusion_candidates.h"

#include <algorithm>
#include <cmath>

#include "math/tensor/cluster_fit.h"
#include "votf/eval/shell_trace.h"

namespace velour {
namespace {

constexpr float kUnits = 127;  // of a byte

int8_t rounded(float share) { return static_cast<int8_t>(std::lround(kUnits * std::clamp(share, -1.0f, 1.0f))); }

template <typename T>
void append(std::vector<uint8_t>& bytes, const std::vector<T>& numbers) {
  const auto* const first = reinterpret_cast<const uint8_t*>(numbers.data());
  bytes.insert(bytes.end(), first, first + numbers.size() * sizeof(T));
}

/// One with a number for every texel and stored view.
template <typename Levels>
class OfTable : public OcclusionCandidate {
 public:
  OfTable(const std::vector<Vec3>& views, Levels levels) : mesh_(views), levels_(std::move(levels)) {}

  bool covered(size_t texel, uint32_t view) const override { return levels_.at(texel, view) > 0; }
  bool covered(size_t texel, const Vec3& wv) const override {
    const DirectionMesh::Weights at = mesh_.at(wv);
    float sum = 0;
    for (size_t k = 0; k < 3; ++k) sum += at.weight[k] * levels_.at(texel, at.index[k]);
    return sum > 0;
  }

 private:
  const DirectionMesh mesh_;
  const Levels levels_;
};

struct WholeLevels {
  size_t views;
  std::vector<int8_t> level;
  float at(size_t texel, uint32_t view) const { return level[texel * views + view]; }
};

struct ClusteredLevels {
  size_t views, rank, members;
  std::vector<int8_t> basis;        // [cluster][view][rank]
  std::vector<float> unit;          // [cluster][rank], of both
  std::vector<uint8_t> member;      // [texel][member]
  std::vector<int8_t> coefficient;  // [texel][member][rank]

  float at(size_t texel, uint32_t view) const {
    float sum = 0;
    for (size_t m = 0; m < members; ++m) {
      const size_t cluster = member[texel * members + m];
      const int8_t* const b = basis.data() + (cluster * views + view) * rank;
      const int8_t* const c = coefficient.data() + (texel * members + m) * rank;
      const float* const u = unit.data() + cluster * rank;
      for (size_t r = 0; r < rank; ++r) sum += u[r] * static_cast<float>(b[r] * c[r]);
    }
    return sum;
  }
};

ClusteredLevels in_bytes(const ClusteredTensor& tensor, size_t views) {
  const auto rank = static_cast<size_t>(tensor.rank()), members = static_cast<size_t>(tensor.members);
  const size_t clusters = tensor.cluster.size(), texels = static_cast<size_t>(tensor.slices());
  ClusteredLevels levels{views, rank, members, std::vector<int8_t>(clusters * views * rank), {}, {}, {}};
  std::vector<float> most(clusters * rank, 1e-12f);
  const auto coefficient = [&](size_t t, size_t k) {
    return tensor.coefficient(static_cast<Index>(t), static_cast<Index>(k));
  };
  for (size_t i = 0; i < texels * members; ++i) {
    for (size_t r = 0; r < rank; ++r) {
      float& m = most[tensor.member[i] * rank + r];
      m = std::max(m, std::abs(coefficient(i / members, i % members * rank + r)));
    }
  }
  for (size_t c = 0; c < clusters; ++c) {
    const RowMatrix basis = tensor.cluster[c].basis({}, Progress());
    for (size_t r = 0; r < rank; ++r) {
      const float largest = basis.row(static_cast<Index>(r)).cwiseAbs().maxCoeff() + 1e-12f;
      for (size_t v = 0; v < views; ++v) {
        levels.basis[(c * views + v) * rank + r] =
            rounded(basis(static_cast<Index>(r), static_cast<Index>(v)) / largest);
      }
      levels.unit.push_back(largest * most[c * rank + r] / (kUnits * kUnits));
    }
  }
  for (size_t i = 0; i < texels * members; ++i) {
    levels.member.push_back(static_cast<uint8_t>(tensor.member[i]));
    for (size_t r = 0; r < rank; ++r) {
      levels.coefficient.push_back(
          rounded(coefficient(i / members, i % members * rank + r) / most[tensor.member[i] * rank + r]));
    }
  }
  return levels;
}

class OfShell : public OcclusionCandidate {
 public:
  OfShell(std::shared_ptr<const VotfVolume> volume, const TileTexels& texels, const std::vector<Vec3>& views)
      : field_(std::move(volume)), texels_(texels), views_(views) {}

  bool covered(size_t texel, uint32_t view) const override { return covered(texel, views_[view]); }
  bool covered(size_t texel, const Vec3& wv) const override { return line_meets(field_, texels_.center(texel), wv); }
  void covered(std::span<const OcclusionQuery> queries, uint8_t* found) const override {
    std::vector<ShellWay> ways;
    for (const auto& q : queries) ways.push_back(line_through(field_.volume(), texels_.center(q.texel), q.wv));
    std::vector<ShellHit> hits(ways.size());
    trace_shells(field_, ways, hits.data());
    for (size_t i = 0; i < hits.size(); ++i) found[i] = hits[i].met ? 1 : 0;
  }

 private:
  const ShellField field_;
  const TileTexels texels_;
  const std::vector<Vec3> views_;
};

}  // namespace

std::unique_ptr<OcclusionCandidate> whole_table(const LevelTable& table, bool bits) {
  const float largest = *std::ranges::max_element(table.level);
  WholeLevels levels{table.views.size(), {}};
  std::vector<uint8_t> packed(bits ? (table.level.size() + 7) / 8 : 0);
  for (const float level : table.level) levels.level.push_back(rounded(level / largest));
  if (bits) {  // view after view: neighbors in a file are neighbors in space
    size_t at = 0;
    for (size_t v = 0; v < levels.views; ++v) {
      for (size_t t = 0; t < table.texels(); ++t, ++at) {
        if (levels.at(t, static_cast<uint32_t>(v)) > 0) packed[at / 8] |= static_cast<uint8_t>(1u << at % 8);
      }
    }
  } else {
    for (size_t v = 0; v < levels.views; ++v) {
      for (size_t t = 0; t < table.texels(); ++t)
        packed.push_back(static_cast<uint8_t>(levels.level[t * levels.views + v]));
    }
  }
  auto candidate = std::make_unique<OfTable<WholeLevels>>(table.views, std::move(levels));
  candidate->stored = std::move(packed);
  return candidate;
}

std::unique_ptr<OcclusionCandidate> clustered(const LevelTable& table, const ClusteredShape& shape, uint64_t seed) {
  const auto views = static_cast<Index>(table.views.size());
  ClusterOptions options;
  options.clusters = shape.clusters;
  options.members = shape.members;
  options.ranks = {shape.rank, shape.rank};
  options.iterations = 12;
  options.tensor.seed = seed;
  Progress progress;
  const ClusterFit fit =
      fit_clusters(TensorView(table.level.data(), {static_cast<Index>(table.texels()), views}), options, progress);
  ClusteredLevels levels = in_bytes(fit.tensor, table.views.size());
  std::vector<uint8_t> stored;
  append(stored, levels.basis);
  append(stored, levels.unit);
  append(stored, levels.member);
  append(stored, levels.coefficient);
  auto candidate = std::make_unique<OfTable<ClusteredLevels>>(table.views, std::move(levels));
  candidate->stored = std::move(stored);
  return candidate;
}

std::unique_ptr<OcclusionCandidate> shell_distances(std::shared_ptr<const VotfVolume> volume, const TileTexels& texels,
                                                    const std::vector<Vec3>& views) {
  auto candidate = std::make_unique<OfShell>(volume, texels, views);
  candidate->stored = volume->distance;
  return candidate;
}

}  // namespace velour
