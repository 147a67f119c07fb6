// What evaluating a BTF of clustered tensors costs: nanoseconds of processor time, of a random place, view and light.
//
//   tensor_rate CLUSTERS MEMBERS TEXEL_RANK VIEW_RANK LIGHT_RANK COLOR_RANK [TEXELS]
//
// Random numbers in 128 x 128 texels, or others, of which patches share their clusters, under the 81 x 81 directions of
// the Bonn sets, with a relief. A line
// for each instruction set, the least of several runs: the whole, evaluations a second, and the part of it that looking
// up both directions takes.
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <limits>

#include "btf/tensor_evaluator.h"
#include "sphere/warp.h"
#include "srbf/simd_target.h"
#include "support/example_tensor.h"

namespace {

using namespace velour;

constexpr uint32_t kQueries = 20000;
constexpr int kRuns = 7;
constexpr uint32_t kPatch = 4;  // texels along a side that share their clusters

struct Query {
  Vec2 place;
  DirectionPair pair;
};

std::vector<Query> random_queries() {
  std::vector<Query> queries;
  for (uint32_t i = 0; i < kQueries; ++i) {
    RandomStream random(0, i, 0);
    const Vec2 place = random.next2();
    queries.push_back({place, {sample_cosine_hemisphere(random.next2()), sample_cosine_hemisphere(random.next2())}});
  }
  return queries;
}

double seconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Nanoseconds of `use` a query; keeps what it returns from being left out.
template <typename Use>
double cost(const std::vector<Query>& queries, const Use& use) {
  double least = std::numeric_limits<double>::infinity();
  for (int run = 0; run < kRuns; ++run) {
    const double start = seconds();
    for (const Query& query : queries) {
      const auto result = use(query);
      asm volatile("" : : "r"(&result) : "memory");
    }
    least = std::min(least, (seconds() - start) / kQueries * 1e9);
  }
  return least;
}

TensorBtf random_btf(const test::TensorShape& shape, uint32_t texels) {
  TensorBtf btf{PairLayout(bonn_directions(), bonn_directions()),
                {texels, texels, Vec2(0.01f)},
                Companding::root,
                Mat3(1.0f),
                {}};
  btf.sides.push_back(test::random_side(btf.layout, btf.grid, false, shape));
  for (TensorLevel& level : btf.sides[0].levels) {
    for (uint32_t y = 0; y < level.height; ++y) {
      for (uint32_t x = 0; x < level.width; ++x) {
        const auto at = [&](uint32_t column, uint32_t row) {
          return level.member.begin() + (size_t{row} * level.width + column) * shape.members;
        };
        std::copy_n(at(x / kPatch * kPatch, y / kPatch * kPatch), shape.members, at(x, y));
      }
    }
  }
  return btf;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 7) {
    std::fprintf(stderr, "usage: tensor_rate CLUSTERS MEMBERS TEXEL_RANK VIEW_RANK LIGHT_RANK COLOR_RANK [TEXELS]\n");
    return 2;
  }
  const auto number = [&](int i) { return static_cast<uint32_t>(std::atoi(arguments[i])); };
  const test::TensorShape shape{number(1), number(2), {number(3), number(4), number(5), number(6)}, true};
  const TensorEvaluator evaluator(std::make_shared<const TensorBtf>(random_btf(shape, count > 7 ? number(7) : 128)));
  const DirectionMesh directions(directions_on_side(bonn_directions(), false));
  const std::vector<Query> queries = random_queries();
  const auto point = std::make_unique<TensorPoint>();
  for (const std::string& target : simd_targets()) {
    select_simd_target(target.c_str());
    const double whole = cost(queries, [&](const Query& query) {
      evaluator.begin(0, query.pair.wv, *point);
      evaluator.add(query.place, 0, 1, *point);
      evaluator.finish(*point);
      return evaluator.value(*point, query.pair.wl);
    });
    const double light = cost(queries, [&](const Query& query) { return evaluator.value(*point, query.pair.wl); });
    const double places = cost(queries, [&](const Query& query) {
      evaluator.begin(0, query.pair.wv, *point);
      evaluator.add(query.place, 0, 1, *point);
      return point->count;
    });
    const double look = cost(queries, [&](const Query& query) { return directions.at(query.pair.wv); });
    std::printf("%-10s %7.1f ns, %.2f M/s; place %.1f, view %.1f, light %.1f; a look %.1f\n", target.c_str(), whole,
                1e3 / whole, places, whole - places - light, light, look);
  }
}
