// The environment's sampler against a scalar one in double, on every instruction set.
#include <gtest/gtest.h>

#include <vector>

#include "base/simd.h"
#include "light/environment.h"
#include "math/sphere/random.h"

namespace velour::environment_sampling_test {
namespace {

/// Where between two nodes the linear density reaches the share `u` of its mass, by bisection.
double invert(double a, double b, double u) {
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double t = 0.5 * (low + high);
    (a * t + 0.5 * (b - a) * t * t < u * 0.5 * (a + b) ? low : high) = t;
  }
  return low;
}

struct Place {
  size_t cell;
  double share;  // of the cell's mass
  double t;      // where the linear density has reached it
};

/// The cell of `mass` that holds the share `u` of all, and the place in it.
Place find(const std::vector<double>& mass, const std::vector<double>& node, double u) {
  double total = 0, below = 0;
  for (double m : mass) total += m;
  size_t cell = 0;
  while (cell + 1 < mass.size() && (below + mass[cell]) / total <= u) below += mass[cell++];
  const double share = (u * total - below) / mass[cell];
  return {cell, share, invert(node[cell], node[cell + 1], share)};
}

/// The documented density (environment.h), drawn from one step after the other.
class Reference {
 public:
  Reference(int width, int height, const std::vector<float>& gray) : width_(width), height_(height) {
    for (int y = 0; y < height; ++y) {
      std::vector<double> row;
      for (int x = -1; x <= width; ++x) {
        const auto at = static_cast<size_t>(y * width + (x + width) % width);
        row.push_back(static_cast<double>(gray[at]) * std::sin(kPiD * (y + 0.5) / height));
      }
      rows_.push_back(row);
    }
  }

  Vec3d sample(const Vec2& u) const {
    std::vector<double> node{0}, mass;
    for (const auto& row : rows_) node.push_back(sum(columns(row)));
    node.push_back(0);
    for (size_t i = 0; i + 1 < node.size(); ++i) {
      const bool pole = i == 0 || i + 2 == node.size();  // half as high
      mass.push_back((pole ? 0.25 : 0.5) * (node[i] + node[i + 1]));
    }
    const Place band = find(mass, node, static_cast<double>(u.y));
    // The upper row has the first part of the band's share, in proportion to its mass; the lower row has the rest.
    const double split = node[band.cell] / (node[band.cell] + node[band.cell + 1]);
    const bool lower = band.share >= split;
    const double t = lower ? std::sqrt((band.share - split) / (1 - split)) : 1 - std::sqrt(1 - band.share / split);
    const size_t row = lower ? band.cell : band.cell - 1;
    const Place column = find(columns(rows_[row]), rows_[row], static_cast<double>(u.x));
    const double h = height_, at = static_cast<double>(band.cell);
    const double line = band.cell == 0 ? 0.5 * t : (at == h ? h - 0.5 + 0.5 * t : at - 0.5 + t);
    const double theta = kPiD * line / h;
    const double phi = 2 * kPiD * (0.5 - (static_cast<double>(column.cell) - 0.5 + column.t) / width_);
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
  }

 private:
  static std::vector<double> columns(const std::vector<double>& row) {
    std::vector<double> mass;
    for (size_t i = 0; i + 2 < row.size(); ++i) mass.push_back(0.5 * (row[i] + row[i + 1]));
    return mass;
  }
  static double sum(const std::vector<double>& values) {
    double total = 0;
    for (double v : values) total += v;
    return total;
  }

  int width_, height_;
  std::vector<std::vector<double>> rows_;
};

TEST(EnvironmentSampling, FollowsTheScalarReferenceOnEveryTarget) {
  for (const auto& [width, height] : {std::pair{16, 8}, {7, 3}, {1, 1}, {64, 32}}) {
    std::vector<float> gray(static_cast<size_t>(width * height));
    RandomStream random(4, 5, 6);
    for (float& v : gray) v = std::pow(random.next(), 8.0f) + 1e-4f;
    const Environment environment = Environment::image({width, height, 1, gray}, 1, Mat3(1.0f));
    const Reference reference(width, height, gray);
    std::vector<Vec2> u;
    while (u.size() < 64) u.push_back(random.next2());
    for (const std::string& target : simd_targets()) {
      ASSERT_TRUE(select_simd_target(target.c_str()));
      for (size_t count : {size_t{1}, size_t{9}, u.size()}) {
        DirectionBatch world;
        environment.sample(std::span(u).first(count), world);
        ASSERT_EQ(world.count, static_cast<int>(count));
        for (size_t i = 0; i < count; ++i) {
          // Rounding of the tables is stretched where a cell has little mass.
          EXPECT_LT(glm::distance(Vec3d(world.get(static_cast<int>(i))), reference.sample(u[i])), 2e-4)
              << target << ' ' << width << ' ' << u[i].x << ' ' << u[i].y;
        }
      }
    }
  }
  select_simd_target("auto");
}

}  // namespace
}  // namespace velour::environment_sampling_test
