// What ways to keep the view-dependent occlusion of a tile cost and get wrong: one JSON object.
//
//   occlusion_tables TILE IRREGULARITY TEXELS VIEWS UNSEEN SEED FOLDER
//
// V of texel centers by rays, under VIEWS directions up to 80 degrees, and under UNSEEN others up to 75. What each
// candidate would keep in a file is written to FOLDER/N.bin, in the order of the rows.
#include <tbb/parallel_for.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <span>

#include "capture/tile/tile.h"
#include "math/sphere/directions.h"
#include "math/sphere/random.h"
#include "occlusion_candidates.h"
#include "support/test_scene.h"
#include "votf/capture/surface_distance.h"
#include "votf/capture/votf_capture.h"

namespace {

using namespace velour;
using Mask = std::vector<uint8_t>;

constexpr float kReach = 8;       // texels: the longest distance of borders that is told apart
constexpr float kTableReach = 4;  // texels: of the distances that tables hold
constexpr uint32_t kQueries = 200'000;
constexpr size_t kBatch = 1024;
constexpr int kRuns = 5;

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Task {
  Tile tile;
  std::string folder;
  TileTexels texels;
  std::vector<Vec3> views, unseen;
  uint64_t seed;
};

/// About `count` directions of equal solid angle up to 80 degrees.
std::vector<Vec3> stored_views(int count) {
  const float least = std::cos(radians_from(80.0f));
  std::vector<Vec3> views;
  for (const Vec3& w : hemisphere_fibonacci(static_cast<int>(std::lround(static_cast<float>(count) / (1 - least))))) {
    if (w.z > least) views.push_back(w);
  }
  return views;
}

/// Signed distances of texels to the border of a mask, texels, positive where it is set.
std::vector<float> signed_distances(const Mask& mask, const TileTexels& texels, float reach) {
  std::vector<float> level(mask.size());
  for (size_t i = 0; i < mask.size(); ++i) level[i] = mask[i] ? -0.5f : 0.5f;
  Progress progress;
  const DistanceGrid grid{texels.width, texels.height, 1, Vec3(0.0f), Vec3(1.0f)};
  std::vector<float> distance = level_distances(level, grid, progress);
  for (size_t i = 0; i < mask.size(); ++i) distance[i] = std::copysign(std::min(distance[i], reach), -level[i]);
  return distance;
}

struct Errors {
  double wrong = 0, apart = 0;  // texels that are wrong; sum of distances of borders
  double borders = 0, all = 0;

  void add(const Mask& found, const Mask& truth, const TileTexels& texels) {
    for (size_t i = 0; i < truth.size(); ++i) wrong += found[i] != truth[i] ? 1 : 0;
    all += static_cast<double>(truth.size());
    add_borders(found, truth, texels);
    add_borders(truth, found, texels);
  }
  /// Adds the distances from places where neighboring texels of `mask` differ to the border of `other`.
  void add_borders(const Mask& mask, const Mask& other, const TileTexels& texels) {
    const std::vector<float> distance = signed_distances(other, texels, kReach);
    for (uint32_t y = 0; y < texels.height; ++y) {
      for (uint32_t x = 0; x < texels.width; ++x) {
        const size_t at = size_t{y} * texels.width + x;
        for (const size_t beside :
             {size_t{y} * texels.width + (x + 1) % texels.width, size_t{(y + 1) % texels.height} * texels.width + x}) {
          if (mask[at] == mask[beside]) continue;
          ++borders;
          if (other[at] == other[beside]) apart += static_cast<double>(std::abs(distance[at] + distance[beside])) / 2;
        }
      }
    }
  }
  nlohmann::ordered_json json() const { return {{"wrong", wrong / all}, {"border", apart / std::max(borders, 1.0)}}; }
};

template <typename View>
Errors errors_of(const OcclusionCandidate& candidate, std::span<const View> views, const std::vector<Mask>& truth,
                 const TileTexels& texels) {
  std::vector<Errors> each(views.size());
  tbb::parallel_for(size_t{0}, views.size(), [&](size_t i) {
    Mask found(texels.size());
    for (size_t t = 0; t < found.size(); ++t) found[t] = candidate.covered(t, views[i]) ? 1 : 0;
    each[i].add(found, truth[i], texels);
  });
  Errors sum;
  for (const Errors& e : each) {
    sum.wrong += e.wrong;
    sum.apart += e.apart;
    sum.borders += e.borders;
    sum.all += e.all;
  }
  return sum;
}

/// Nanoseconds a query of those that `use` makes, the least of some runs.
template <typename Use>
double cost(const Use& use) {
  double least = std::numeric_limits<double>::infinity();
  for (int run = 0; run < kRuns; ++run) {
    const double start = thread_seconds();
    const uint32_t sum = use();
    asm volatile("" : : "r"(sum) : "memory");
    least = std::min(least, (thread_seconds() - start) / kQueries * 1e9);
  }
  return least;
}

double cost_of_batches(const OcclusionCandidate& candidate, std::span<const OcclusionQuery> queries) {
  uint8_t found[kBatch];
  return cost([&] {
    uint32_t sum = 0;
    for (size_t done = 0; done < queries.size(); done += kBatch) {
      const size_t count = std::min(kBatch, queries.size() - done);
      candidate.covered(queries.subspan(done, count), found);
      sum = std::accumulate(found, found + count, sum);
    }
    return sum;
  });
}

nlohmann::ordered_json nanoseconds(const OcclusionCandidate& candidate, const Task& task) {
  std::vector<OcclusionQuery> any, in_order;
  std::vector<uint32_t> view;
  const auto below = [](float u, size_t n) { return static_cast<size_t>(u * static_cast<float>(n)); };
  for (uint32_t i = 0; i < kQueries; ++i) {
    RandomStream numbers(task.seed, i, 1);
    const Vec2 u = numbers.next2();
    any.push_back({below(u.x, task.texels.size()), check_view(task.seed + 1, i)});
    view.push_back(static_cast<uint32_t>(below(u.y, task.views.size())));
    in_order.push_back({i % task.texels.size(), any[0].wv});
  }
  const auto stored = [&] {
    uint32_t sum = 0;
    for (uint32_t i = 0; i < kQueries; ++i) sum += candidate.covered(any[i].texel, view[i]) ? 1 : 0;
    return sum;
  };
  return {{"stored", cost(stored)},
          {"any", cost_of_batches(candidate, any)},
          {"in_order", cost_of_batches(candidate, in_order)}};
}

std::unique_ptr<Scene> scene_of(const Tile& tile) {
  const TileMesh& m = tile.parts.mesh;
  auto scene = std::make_unique<Scene>();
  scene->add_material({.material = std::make_shared<test::Lambert>(0.5f)});
  scene->add_instance(scene->add_mesh(Mesh({.positions = m.positions, .triangles = m.triangles})), {}, {0});
  scene->commit();
  return scene;
}

class Comparison {
 public:
  explicit Comparison(const Task& task) : task_(task), scene_(scene_of(task.tile)), place_{{}, task.tile.period} {
    const RepeatedTile tile(*scene_, place_, 0);
    const double start = processor_seconds();
    truth_ = masks(tile, task.views);
    ray_seconds_ = processor_seconds() - start;
    unseen_truth_ = masks(tile, task.unseen);
  }

  nlohmann::ordered_json run() {
    json_ = {{"tile", task_.tile.kind},       {"irregularity", task_.tile.shape.irregularity},
             {"texels", task_.texels.width},  {"views", task_.views.size()},
             {"unseen", task_.unseen.size()}, {"mean", mean()},
             {"ray_seconds", ray_seconds_}};
    json_["candidates"] = nlohmann::ordered_json::array();
    of_tables("V", binary_levels());
    of_tables("signed distance", distance_levels());
    const LevelTable v = binary_levels();
    for (const int lobes : {1, 3}) {
      add(lobes == 1 ? "SRBF, 1 lobe a texel" : "SRBFs, 3 lobes a texel", [&] { return texel_lobes(v, lobes); });
    }
    for (const uint32_t texels : {task_.texels.width / 2, task_.texels.width}) of_shell(texels);
    return json_;
  }

 private:
  std::vector<Mask> masks(const RepeatedTile& tile, const std::vector<Vec3>& views) const {
    std::vector<Mask> found(views.size());
    tbb::parallel_for(size_t{0}, views.size(),
                      [&](size_t i) { found[i] = traced_mask(tile, task_.texels, 0, views[i]); });
    return found;
  }
  double mean() const {
    double sum = 0;
    for (const Mask& mask : truth_) {
      for (const uint8_t v : mask) sum += v;
    }
    return sum / static_cast<double>(truth_.size() * task_.texels.size());
  }

  template <typename OfMask>
  LevelTable levels(const OfMask& of_mask) const {
    LevelTable table{task_.views, std::vector<float>(task_.views.size() * task_.texels.size())};
    tbb::parallel_for(size_t{0}, truth_.size(), [&](size_t v) {
      const std::vector<float> level = of_mask(truth_[v]);
      for (size_t t = 0; t < level.size(); ++t) table.level[t * truth_.size() + v] = level[t];
    });
    return table;
  }
  LevelTable binary_levels() const {
    return levels([](const Mask& mask) {
      std::vector<float> level;
      for (const uint8_t v : mask) level.push_back(v ? 1.0f : -1.0f);
      return level;
    });
  }
  LevelTable distance_levels() const {
    return levels([&](const Mask& mask) { return signed_distances(mask, task_.texels, kTableReach); });
  }

  void of_tables(const std::string& what, const LevelTable& table) {
    add(what + ", whole", [&] { return whole_table(table, what == "V"); });
    for (const auto& [name, shape] :
         {std::pair{"CTA", ClusteredShape{32, 1, 12}}, {"K-CTA, K = 2", ClusteredShape{64, 2, 5}}}) {
      add(what + ", " + name, [&, &shape = shape] { return clustered(table, shape, task_.seed); });
    }
  }

  void of_shell(uint32_t texels) {
    VotfCaptureOptions options;
    options.place = place_;
    options.texels = texels;
    options.reference_height = 0;
    options.check_views = 0;
    Progress progress;
    VotfCapture capture;
    const auto shell = [&] {
      capture = capture_votf(*scene_, options, progress);
      return shell_distances(std::make_shared<VotfVolume>(capture.volume), task_.texels, task_.views);
    };
    add("distances in the shell, " + std::to_string(texels) + " a tile", shell);
    options.check_views = static_cast<uint32_t>(task_.views.size());
    options.measure_ray_share = true;
    const auto start = std::chrono::steady_clock::now();
    const VotfCapture checked = capture_votf(*scene_, options, progress);
    auto& row = json_["candidates"].back();
    const auto& v = capture.volume;
    row["points"] = {v.width, v.height, v.depth};
    row["wall_seconds"] = capture.seconds;
    row["wall_seconds_checked"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    row["ray_share"] = checked.ray_share.value_or(0);
  }

  template <typename Make>
  void add(const std::string& name, const Make& make) {
    std::fprintf(stderr, "%s: %s\n", task_.tile.kind.c_str(), name.c_str());
    const double start = processor_seconds();
    const std::unique_ptr<OcclusionCandidate> candidate = make();
    const double seconds = processor_seconds() - start;
    std::vector<uint32_t> stored(task_.views.size());
    std::iota(stored.begin(), stored.end(), 0u);
    auto& rows = json_["candidates"];
    std::ofstream(task_.folder + "/" + std::to_string(rows.size()) + ".bin", std::ios::binary)
        .write(reinterpret_cast<const char*>(candidate->stored.data()),
               static_cast<std::streamsize>(candidate->stored.size()));
    rows.push_back({{"name", name},
                    {"stored", errors_of<uint32_t>(*candidate, stored, truth_, task_.texels).json()},
                    {"unseen", errors_of<Vec3>(*candidate, task_.unseen, unseen_truth_, task_.texels).json()},
                    {"bytes", candidate->stored.size()},
                    {"nanoseconds", nanoseconds(*candidate, task_)},
                    {"seconds", seconds}});
  }

  const Task& task_;
  const std::unique_ptr<Scene> scene_;
  const TilePlace place_;
  std::vector<Mask> truth_, unseen_truth_;
  double ray_seconds_ = 0;
  nlohmann::ordered_json json_;
};

}  // namespace

int main(int count, char** arguments) {
  if (count != 8) {
    std::fprintf(stderr, "usage: occlusion_tables TILE IRREGULARITY TEXELS VIEWS UNSEEN SEED FOLDER\n");
    return 2;
  }
  const auto number = [&](int i) { return static_cast<uint32_t>(std::strtoul(arguments[i], nullptr, 10)); };
  const double irregularity = std::strtod(arguments[2], nullptr);
  Task task{make_tile({.kind = arguments[1], .irregularity = irregularity}),
            arguments[7],
            {},
            stored_views(static_cast<int>(number(4))),
            {},
            number(6)};
  const float aspect = task.tile.period.y / task.tile.period.x;
  task.texels = {number(3), static_cast<uint32_t>(std::lround(static_cast<float>(number(3)) * aspect)), aspect};
  for (uint32_t i = 0; i < number(5); ++i) task.unseen.push_back(check_view(task.seed, i));
  std::printf("%s\n", Comparison(task).run().dump(1).c_str());
}
