// The list of strategies whose expectations must agree.
#pragma once

#include <string>
#include <vector>

#include "render/options.h"

namespace velour::test {

struct NamedStrategy {
  std::string name;
  Strategy strategy;
  Heuristic heuristic = Heuristic::balance;
  float light_share = 0.5f;
  bool usual() const { return heuristic == Heuristic::balance && light_share == 0.5f; }
};

inline std::vector<NamedStrategy> all_strategies() {
  return {{"uniform", Strategy::uniform},
          {"cosine", Strategy::cosine},
          {"table", Strategy::table},
          {"srbf", Strategy::srbf},
          {"ggx", Strategy::ggx},
          {"light", Strategy::light},
          {"mis", Strategy::mis},
          {"mis power", Strategy::mis, Heuristic::power},
          {"mis share 0.2", Strategy::mis, Heuristic::balance, 0.2f},
          {"mis power share 0.8", Strategy::mis, Heuristic::power, 0.8f},
          {"mis-ggx", Strategy::mis_ggx},
          {"product", Strategy::product},
          {"dissertation", Strategy::dissertation},
          {"mis-dissertation", Strategy::mis_dissertation},
          {"product power share 0.3", Strategy::product, Heuristic::power, 0.3f}};
}

}  // namespace velour::test
