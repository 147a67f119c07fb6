// Speed of BTF evaluation.
#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <vector>

#include "job/thread_seconds.h"
#include "sphere/vec.h"

namespace velour {

struct BtfQuery {
  Vec2 place;  // in tiles
  DirectionPair pair;
};
/// 20,000 queries with random places, views and lights (sampled by the cosine).
std::vector<BtfQuery> random_queries();

/// CPU seconds of `use` per query: the minimum of seven runs, since other programs can only slow a run down.
template <class Use>
double seconds_a_query(const std::vector<BtfQuery>& queries, const Use& use) {
  constexpr int kRuns = 7;
  double least = std::numeric_limits<double>::infinity();
  for (int run = 0; run < kRuns; ++run) {
    const double start = thread_seconds();
    for (const BtfQuery& query : queries) {
      const auto result = use(query);
      asm volatile("" : : "r"(&result) : "memory");  // keeps the work from being optimized away
    }
    least = std::min(least, thread_seconds() - start);
  }
  return least / static_cast<double>(queries.size());
}

/// f of a query, without a footprint.
using BtfValue = std::function<Rgb(const BtfQuery& query)>;

/// Evaluations per second of CPU time on one thread.
double evaluation_rate(const BtfValue& value);

}  // namespace velour
