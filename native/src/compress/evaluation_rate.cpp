#include "compress/evaluation_rate.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <vector>

#include "sphere/random.h"
#include "sphere/warp.h"

namespace velour {
namespace {

constexpr uint32_t kQueries = 20000;

struct Query {
  Vec2 place;
  DirectionPair pair;
};

std::vector<Query> random_queries() {
  std::vector<Query> queries;
  for (uint32_t i = 0; i < kQueries; ++i) {
    RandomStream random(0, i, 0);
    Query& query = queries.emplace_back();
    query.place = random.next2();
    query.pair = {sample_cosine_hemisphere(random.next2()), sample_cosine_hemisphere(random.next2())};
  }
  return queries;
}

}  // namespace

double evaluation_rate(const BtfValue& value) {
  const std::vector<Query> queries = random_queries();
  std::array<double, 5> rate;
  for (double& r : rate) {
    const auto start = std::chrono::steady_clock::now();
    float sum = 0;
    for (const Query& query : queries) {
      sum += value(query.place, query.pair).g;
    }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    // The sum is not negative; asking for it keeps the work from being left out.
    r = sum >= 0 ? kQueries / seconds.count() : 0;
  }
  std::nth_element(rate.begin(), rate.begin() + 2, rate.end());
  return rate[2];
}

}  // namespace velour
