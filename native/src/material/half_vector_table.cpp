#include "material/half_vector_table.h"

#include <algorithm>

#include "brdf/fast_atan2.h"
#include "sphere/discrete_choice.h"

namespace velour {

namespace {

constexpr int kSubsamples = 2;  // along each side of a cell

/// Half vector of cosine 1 - d with +z.
Vec3 half_vector(float d, float phi) {
  const float sine = std::sqrt(d * (2 - d));
  return {sine * std::cos(phi), sine * std::sin(phi), 1 - d};
}

/// Turns weights into their running sum, scaled to end at 1; equal shares when all are 0. Returns the sum.
double accumulate(const double* weight, int n, float* cdf) {
  double total = 0;
  for (int i = 0; i < n; ++i) total += weight[i];
  double running = 0;
  for (int i = 0; i < n; ++i) {
    running += total > 0 ? weight[i] / total : 1.0 / n;
    cdf[i] = static_cast<float>(running);
  }
  cdf[n - 1] = 1;
  return total;
}

}  // namespace

float HalfVectorTable::row_edge(int row) {
  const float s = static_cast<float>(row) / kRows;
  return s * s * s * s;
}

void HalfVectorTable::tabulate(const Material& material, const Vec3& wv) {
  PreparedBrdf point;
  material.prepare(wv, point);
  Masses mass(static_cast<size_t>(kRows) * kColumns, 0.0);
  for (int row = 0; row < kRows; ++row) {
    for (int i = 0; i < kSubsamples; ++i) {
      const float share = (static_cast<float>(i) + 0.5f) / kSubsamples;
      add_row(point, material, row, (1 - share) * row_edge(row) + share * row_edge(row + 1), mass);
    }
  }
  std::array<double, kRows> row_mass;
  for (size_t i = 0; i < kRows; ++i) row_mass[i] = accumulate(&mass[i * kColumns], kColumns, columns_[i].data());
  accumulate(row_mass.data(), kRows, rows_.data());
}

void HalfVectorTable::add_row(const PreparedBrdf& point, const Material& material, int row, float d,
                              Masses& mass) const {
  constexpr int kSteps = kSubsamples * kColumns;
  static_assert(kSteps % DirectionBatch::kCapacity == 0);
  const double height = row_edge(row + 1) - row_edge(row);  // the columns' width is common to all cells
  for (int first = 0; first < kSteps; first += DirectionBatch::kCapacity) {
    DirectionBatch wl;
    float cosine[DirectionBatch::kCapacity];  // wv.h
    for (int k = 0; k < DirectionBatch::kCapacity; ++k) {
      const Vec3 h = half_vector(d, 2 * kPi / kSteps * (static_cast<float>(first + k) + 0.5f));
      cosine[k] = std::max(glm::dot(point.wv, h), 0.0f);
      wl.push(2 * glm::dot(point.wv, h) * h - point.wv);
    }
    RgbBatch f;
    ScalarBatch pdf;
    material.eval(point, wl, f, pdf);
    for (int k = 0; k < DirectionBatch::kCapacity; ++k) {
      const float density = luminance(f.get(k)) * std::max(wl.z[k], 0.0f) * 4 * cosine[k];
      mass[static_cast<size_t>(row * kColumns + (first + k) / kSubsamples)] += density * height;
    }
  }
}

Vec3 HalfVectorTable::sample(double u_row, double u_column) const {
  const int row = choose_index(rows_.data(), kRows, u_row);
  const int column = choose_index(columns_[static_cast<size_t>(row)].data(), kColumns, u_column);
  const float d = row_edge(row) + static_cast<float>(u_row) * (row_edge(row + 1) - row_edge(row));
  return half_vector(d, 2 * kPi / kColumns * (static_cast<float>(column) + static_cast<float>(u_column)));
}

HalfVectorTable::Cell HalfVectorTable::cell_of(const Vec3& h) {
  const float d = (h.x * h.x + h.y * h.y) / (1 + h.z);  // 1 - h.z without cancellation
  const int row = std::min(static_cast<int>(kRows * std::sqrt(std::sqrt(d))), kRows - 1);
  const float turn = fast_atan2(h.y, h.x) / (2 * kPi);
  const int column = std::min(static_cast<int>((turn < 0 ? turn + 1 : turn) * kColumns), kColumns - 1);
  return {static_cast<size_t>(row), static_cast<size_t>(column),
          kColumns / (2 * kPi) / (row_edge(row + 1) - row_edge(row))};
}

float HalfVectorTable::pdf(const Cell& cell) const {
  // Read off the very numbers that sampling uses.
  const auto step = [](const auto& cdf, size_t i) { return cdf[i] - (i > 0 ? cdf[i - 1] : 0); };
  return step(rows_, cell.row) * step(columns_[cell.row], cell.column) * cell.inverse_solid_angle;
}

}  // namespace velour
