#include "compress/tensor_rounding.h"

#include <algorithm>
#include <limits>
#include <map>

#include "compress/byte_rounding.h"

namespace velour {
namespace {

/// rounding_moves() of sets of members, each computed once.
class MemberMoves {
 public:
  explicit MemberMoves(const TensorFunctions& functions) : functions_(functions) {}

  const Eigen::MatrixXf& of(const std::vector<uint32_t>& members) {
    const auto [at, is_new] = known_.try_emplace(members);
    if (is_new) {
      at->second = rounding_moves(TensorFunctions::of_members(functions_.products(), functions_.rank(), members, 0));
    }
    return at->second;
  }

 private:
  const TensorFunctions& functions_;
  std::map<std::vector<uint32_t>, Eigen::MatrixXf> known_;
};

/// Calls use(cluster, rank, value) for every value.
template <class Use>
void for_values(const TensorTexelValues& level, size_t rank, const Use& use) {
  for (size_t i = 0; i < level.member.size(); ++i) {
    for (size_t r = 0; r < rank; ++r) use(level.member[i], r, level.value.data()[i * rank + r]);
  }
}

void set_scales(const std::vector<TensorTexelValues>& levels, TensorSide& side) {
  struct Range {
    float least = std::numeric_limits<float>::max(), most = std::numeric_limits<float>::lowest();
  };
  const size_t rank = side.rank.texel;
  std::vector<Range> range(side.clusters.size() * rank);
  for (const TensorTexelValues& level : levels) {
    for_values(level, rank, [&](uint32_t c, size_t r, float value) {
      Range& of = range[c * rank + r];
      of = {std::min(of.least, value), std::max(of.most, value)};
    });
  }
  for (size_t i = 0; i < range.size(); ++i) {
    const bool unused = range[i].least > range[i].most;
    side.clusters[i / rank].scale.push_back(unused ? ByteScale{}
                                                   : ByteScale{range[i].least, (range[i].most - range[i].least) / 255});
  }
}

/// Rounds a texel's coefficients one after the other.
void round_texel(const TensorSide& side, const uint32_t* member, const Eigen::MatrixXf& moves, float* value,
                 std::vector<uint8_t>& bytes) {
  const size_t rank = side.rank.texel, count = side.members * rank;
  for (size_t k = 0; k < count; ++k) {
    const ByteScale& scale = side.clusters[member[k / rank]].scale[k % rank];
    bytes.push_back(scale.nearest(value[k]));
    const float error = value[k] - scale.value(bytes.back());
    for (size_t j = k + 1; j < count; ++j) {
      value[j] -= error * moves(static_cast<Index>(k), static_cast<Index>(j));
    }
  }
}

}  // namespace

void set_rounded(const TensorFunctions& functions, std::vector<TensorTexelValues> levels, TensorSide& side) {
  set_scales(levels, side);
  MemberMoves moves(functions);
  for (size_t l = 0; l < levels.size(); ++l) {
    TensorTexelValues& from = levels[l];
    TensorLevel& to = side.levels[l];
    to.member.assign(from.member.begin(), from.member.end());
    to.value.clear();
    for (Index t = 0; t < from.value.rows(); ++t) {
      const uint32_t* member = from.member.data() + static_cast<size_t>(t) * side.members;
      const Eigen::MatrixXf& of = moves.of({member, member + side.members});
      round_texel(side, member, of, from.value.row(t).data(), to.value);
    }
  }
}

}  // namespace velour
