// What evaluating a BTF of clustered tensors costs: nanoseconds of processor time, of a random place, view and light.
//
//   tensor_rate MODEL
//   tensor_rate CLUSTERS MEMBERS TEXEL_RANK VIEW_RANK LIGHT_RANK COLOR_RANK [TEXELS]
//
// A model's first side; or random numbers in 128 x 128 texels, or others, of which patches share their clusters, under
// the 81 x 81 directions of the Bonn sets, with a relief. A line for each instruction set: the whole, evaluations a
// second, and the parts of it that the place, the view and the light take. A look is what looking up one direction
// costs.
#include <cstdio>
#include <cstdlib>

#include "base/simd.h"
#include "btf/fit/btf_fit.h"
#include "btf/model/tensor_evaluator.h"
#include "model/file/model_file.h"
#include "support/example_tensor.h"

namespace {

using namespace velour;

constexpr uint32_t kPatch = 4;  // texels along a side that share their clusters

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

TensorBtf tensors_of(const char* path) {
  Model model = load_model(path);
  if (auto* btf = std::get_if<TensorBtf>(&model.body)) return std::move(*btf);
  std::fprintf(stderr, "%s is no model of clustered tensors\n", path);
  std::exit(2);
}

TensorBtf asked_for(int count, char** arguments) {
  if (count == 2) return tensors_of(arguments[1]);
  if (count < 7) {
    std::fprintf(stderr,
                 "usage: tensor_rate MODEL | CLUSTERS MEMBERS TEXEL_RANK VIEW_RANK LIGHT_RANK COLOR_RANK [TEXELS]\n");
    std::exit(2);
  }
  const auto number = [&](int i) { return static_cast<uint32_t>(std::atoi(arguments[i])); };
  const test::TensorShape shape{number(1), number(2), {number(3), number(4), number(5), number(6)}, true};
  return random_btf(shape, count > 7 ? number(7) : 128);
}

}  // namespace

int main(int count, char** arguments) {
  const TensorEvaluator evaluator(std::make_shared<const TensorBtf>(asked_for(count, arguments)));
  const PairLayout& layout = evaluator.btf().layout;
  const DirectionMesh directions(directions_on_side(layout.views(), evaluator.btf().sides[0].view_below));
  const std::vector<BtfQuery> queries = random_queries();
  const auto point = std::make_unique<TensorPoint>();
  const auto nanoseconds = [&](const auto& use) { return 1e9 * seconds_a_query(queries, use); };
  const auto at_place = [&](const BtfQuery& query) {
    evaluator.begin(0, query.pair.wv, *point);
    evaluator.add(query.place, 0, 1, *point);
    return point->count;
  };
  for (const std::string& target : simd_targets()) {
    select_simd_target(target.c_str());
    const double whole = nanoseconds([&](const BtfQuery& query) {
      at_place(query);
      evaluator.finish(*point);
      return evaluator.value(*point, query.pair.wl);
    });
    const double light = nanoseconds([&](const BtfQuery& query) { return evaluator.value(*point, query.pair.wl); });
    const double places = nanoseconds(at_place);
    const double look = nanoseconds([&](const BtfQuery& query) { return directions.at(query.pair.wv); });
    std::printf("%-10s %7.1f ns, %.2f M/s; place %.1f, view %.1f, light %.1f; a look %.1f\n", target.c_str(), whole,
                1e3 / whole, places, whole - places - light, light, look);
  }
}
