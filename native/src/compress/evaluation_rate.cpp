#include "compress/evaluation_rate.h"

#include "sphere/random.h"
#include "sphere/warp.h"

namespace velour {

std::vector<BtfQuery> random_queries() {
  constexpr uint32_t kQueries = 20000;
  std::vector<BtfQuery> queries;
  for (uint32_t i = 0; i < kQueries; ++i) {
    RandomStream random(0, i, 0);
    BtfQuery& query = queries.emplace_back();
    query.place = random.next2();
    query.pair = {sample_cosine_hemisphere(random.next2()), sample_cosine_hemisphere(random.next2())};
  }
  return queries;
}

double evaluation_rate(const BtfValue& value) { return 1 / seconds_a_query(random_queries(), value); }

}  // namespace velour
