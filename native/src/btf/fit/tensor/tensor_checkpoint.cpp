#include "btf/fit/tensor/tensor_checkpoint.h"

#include <cmath>
#include <string>

namespace velour {
namespace {

constexpr size_t kJudgedNumbers = 8, kShapeNumbers = 2 * kJudgedNumbers + 3, kTrialNumbers = 8;
constexpr size_t kMaxKeptTrials = 64;

void append(const TensorShape& shape, std::vector<double>& numbers) {
  for (const uint32_t n :
       {shape.clusters, shape.members, shape.rank.texel, shape.rank.view, shape.rank.light, shape.rank.color}) {
    numbers.push_back(n);
  }
}

/// A shape that can be stored, otherwise one of 0 clusters.
TensorShape shape_at(const double* numbers) {
  uint32_t whole[6];
  for (size_t i = 0; i < 6; ++i) {
    if (!(numbers[i] >= 1 && numbers[i] <= static_cast<double>(TensorBtf::kMaxRank))) return {0, 1, {}};
    whole[i] = static_cast<uint32_t>(numbers[i]);
  }
  return {whole[0], whole[1], {whole[2], whole[3], whole[4], whole[5]}};
}

void append(const JudgedShape& judged, std::vector<double>& numbers) {
  append(judged.shape, numbers);
  numbers.insert(numbers.end(), {judged.choice.texel_share, judged.error});
}

/// A shape of 0 clusters if there is none.
JudgedShape judged_at(const double* numbers) {
  const TensorShape shape = shape_at(numbers);
  return {{shape.clusters, shape.members, shape.rank.color, numbers[6]}, shape, numbers[7]};
}

std::vector<std::vector<HalfBits>*> parts_of(TensorBtfCluster& c) { return {&c.view, &c.light, &c.color, &c.core}; }

}  // namespace

std::optional<FoundShape> kept_shape(const FitCheckpoint& checkpoint, const std::string& stage) {
  const auto numbers = checkpoint.numbers(stage, kShapeNumbers + kMaxKeptTrials * kTrialNumbers);
  if (!numbers || numbers->size() < kShapeNumbers || (numbers->size() - kShapeNumbers) % kTrialNumbers != 0) {
    return std::nullopt;
  }
  const double* at = numbers->data();
  FoundShape found;
  found.best = judged_at(at);
  if (found.best.shape.clusters == 0) return std::nullopt;
  if (const JudgedShape rival = judged_at(at + kJudgedNumbers); rival.shape.clusters > 0) found.rival = rival;
  at += 2 * kJudgedNumbers;
  const auto is_rank = [](double n) { return n >= 1 && n <= static_cast<double>(TensorBtf::kMaxRank); };
  if (!is_rank(at[0]) || !is_rank(at[1]) || !(at[2] >= 0)) return std::nullopt;
  found.view_rank = static_cast<uint32_t>(at[0]);
  found.light_rank = static_cast<uint32_t>(at[1]);
  found.relief_error = at[2];
  for (at += 3; at < numbers->data() + numbers->size(); at += kTrialNumbers) {
    const TensorShape shape = shape_at(at);
    if (shape.clusters == 0 || !(at[6] >= 0)) return std::nullopt;
    found.trials.push_back({shape.clusters,
                            shape.members,
                            {shape.rank.texel, shape.rank.view, shape.rank.light, shape.rank.color},
                            static_cast<uint64_t>(at[6]),
                            at[7]});
  }
  return found;
}

void keep_shape(FitCheckpoint& checkpoint, const std::string& stage, const FoundShape& found) {
  std::vector<double> numbers;
  append(found.best, numbers);
  append(found.rival.value_or(JudgedShape{{}, TensorShape{0, 0, {}}, 0}), numbers);
  numbers.insert(numbers.end(),
                 {static_cast<double>(found.view_rank), static_cast<double>(found.light_rank), found.relief_error});
  for (const ShapeTrial& trial : found.trials) {
    append({trial.clusters, trial.members, {trial.rank[0], trial.rank[1], trial.rank[2], trial.rank[3]}}, numbers);
    numbers.insert(numbers.end(), {static_cast<double>(trial.parameter_bytes), trial.expected});
  }
  checkpoint.keep_numbers(stage, numbers);
  checkpoint.write();
}

bool take_kept_clusters(const FitCheckpoint& checkpoint, const std::string& stage, const SideDirections& directions,
                        TensorSide& side) {
  const TensorSide::Ranks& rank = side.rank;
  const size_t sizes[] = {directions.view.size() * rank.view, directions.light.size() * rank.light,
                          size_t{3} * rank.color, size_t{rank.texel} * rank.view * rank.light * rank.color};
  const size_t all = sizes[0] + sizes[1] + sizes[2] + sizes[3];
  for (size_t c = 0; c < side.clusters.size(); ++c) {
    const auto kept = checkpoint.matrix(stage + std::to_string(c), 1, static_cast<Index>(all));
    if (!kept) return false;
    const float* from = kept->data();
    const auto parts = parts_of(side.clusters[c]);
    for (size_t i = 0; i < parts.size(); from += sizes[i++]) {
      parts[i]->resize(sizes[i]);
      floats_to_halves({from, sizes[i]}, *parts[i]);
    }
  }
  return true;
}

void keep_clusters(FitCheckpoint& checkpoint, const std::string& stage, const TensorSide& side) {
  for (size_t c = 0; c < side.clusters.size(); ++c) {
    TensorBtfCluster cluster = side.clusters[c];
    RowMatrix row(
        1, static_cast<Index>(cluster.view.size() + cluster.light.size() + cluster.color.size() + cluster.core.size()));
    float* to = row.data();
    for (const std::vector<HalfBits>* part : parts_of(cluster)) {
      halves_to_floats(*part, {to, part->size()});
      to += part->size();
    }
    checkpoint.keep(stage + std::to_string(c), row);
  }
  checkpoint.write();
}

/// Members and values are stored as one matrix: [texel][members, values].
std::optional<SolvedLevel> kept_level(const FitCheckpoint& checkpoint, const std::string& stage, const Relief& relief,
                                      const TensorSide& side) {
  const Index members = side.members, values = members * side.rank.texel;
  const auto kept = checkpoint.matrix(stage, Index{relief.width()} * relief.height(), members + values);
  const auto measured = checkpoint.numbers(stage + ".measured", 1);
  if (!kept || !measured || measured->size() != 1) return std::nullopt;
  SolvedLevel level{{{}, kept->rightCols(values)}, measured->front()};
  for (Index t = 0; t < kept->rows(); ++t) {
    for (Index k = 0; k < members; ++k) {
      const float member = (*kept)(t, k);
      if (!(member >= 0 && member < static_cast<float>(side.clusters.size()) && member == std::floor(member))) {
        return std::nullopt;
      }
      level.values.member.push_back(static_cast<uint32_t>(member));
    }
  }
  return level;
}

void keep_level(const SolvedLevel& level, const std::string& stage, FitCheckpoint& checkpoint) {
  const TensorTexelValues& from = level.values;
  const Index members = from.members();
  RowMatrix kept(from.value.rows(), members + from.value.cols());
  for (Index t = 0; t < kept.rows(); ++t) {
    for (Index k = 0; k < members; ++k) {
      kept(t, k) = static_cast<float>(from.member[static_cast<size_t>(t * members + k)]);
    }
  }
  kept.rightCols(from.value.cols()) = from.value;
  checkpoint.keep(stage, kept);
  checkpoint.keep_numbers(stage + ".measured", std::vector<double>{level.measured});
  checkpoint.write();
}

}  // namespace velour
