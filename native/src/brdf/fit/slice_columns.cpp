#include "brdf/fit/slice_columns.h"

#include <algorithm>
#include <array>

#include "math/sphere/frame.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "brdf/fit/slice_columns.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// Require Highway's namespace of the target.
#include "base/simd_dispatch.h"
#include "hwy/contrib/math/math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace velour::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, SliceSamples::kPadding>;
using Lanes = hn::Vec<Tag>;

/// Broadcasts a shape to all lanes.
struct Broadcast {
  Lanes x, y, z, sharpness;
  explicit Broadcast(const LobeShape& s)
      : x(hn::Set(Tag(), static_cast<float>(s.center.x))),
        y(hn::Set(Tag(), static_cast<float>(s.center.y))),
        z(hn::Set(Tag(), static_cast<float>(s.center.z))),
        sharpness(hn::Set(Tag(), static_cast<float>(s.sharpness))) {}
};

/// k d = k |eta - xi|^2 / 2, without cancellation of numbers near one.
Lanes scaled_distance(const Broadcast& lobe, Lanes x, Lanes y, Lanes z) {
  const Lanes dx = hn::Sub(x, lobe.x), dy = hn::Sub(y, lobe.y), dz = hn::Sub(z, lobe.z);
  const Lanes squares = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
  return hn::Mul(hn::Mul(squares, hn::Set(Tag(), 0.5f)), lobe.sharpness);
}

/// S and -dS/d(kd) at kd.
template <Kernel kernel>
void shape_and_slope(Lanes kd, Lanes& shape, Lanes& slope) {
  const Tag tag;
  if constexpr (kernel == Kernel::gaussian) {
    // Values below exp(-80) are negligible, and denormals would be slow.
    shape = hn::IfThenElseZero(hn::Lt(kd, hn::Set(tag, 80.0f)), hn::Exp(tag, hn::Neg(kd)));
    slope = shape;
  } else {
    const Lanes u = hn::Div(hn::Set(tag, 1.0f), hn::MulAdd(hn::Set(tag, 2.0f / 3.0f), kd, hn::Set(tag, 1.0f)));
    shape = hn::Mul(u, hn::Sqrt(u));
    slope = hn::Mul(shape, u);
  }
}

template <Kernel kernel>
void fill_value_of(const LobeShape& lobe, const SliceSamples& samples, float* HWY_RESTRICT out) {
  const Tag tag;
  const Broadcast b(lobe);
  for (size_t i = 0; i < samples.padded(); i += hn::Lanes(tag)) {
    Lanes shape, slope;
    shape_and_slope<kernel>(scaled_distance(b, hn::Load(tag, samples.x() + i), hn::Load(tag, samples.y() + i),
                                            hn::Load(tag, samples.z() + i)),
                            shape, slope);
    hn::Store(hn::Mul(shape, hn::Load(tag, samples.sqrt_weight() + i)), tag, out + i);
  }
}

template <Kernel kernel>
void fill_derivatives_of(const LobeShape& lobe, const SliceSamples& samples, float* HWY_RESTRICT along_x,
                         float* HWY_RESTRICT along_y, float* HWY_RESTRICT by_log_sharpness) {
  const Tag tag;
  const Broadcast b(lobe);
  const LobeTangents t = lobe_tangents(lobe);
  // dS/dt along a tangent is k slope (eta . tangent); for a turn of 1/sqrt(k) the factor is sqrt(k).
  const double turn = std::sqrt(lobe.sharpness);
  const Broadcast tx({turn * t.x, 0}), ty({turn * t.y, 0});
  for (size_t i = 0; i < samples.padded(); i += hn::Lanes(tag)) {
    const Lanes x = hn::Load(tag, samples.x() + i), y = hn::Load(tag, samples.y() + i);
    const Lanes z = hn::Load(tag, samples.z() + i);
    const Lanes kd = scaled_distance(b, x, y, z);
    Lanes shape, slope;
    shape_and_slope<kernel>(kd, shape, slope);
    slope = hn::Mul(slope, hn::Load(tag, samples.sqrt_weight() + i));
    const Lanes eta_x = hn::MulAdd(x, tx.x, hn::MulAdd(y, tx.y, hn::Mul(z, tx.z)));
    const Lanes eta_y = hn::MulAdd(x, ty.x, hn::MulAdd(y, ty.y, hn::Mul(z, ty.z)));
    hn::Store(hn::Mul(slope, eta_x), tag, along_x + i);
    hn::Store(hn::Mul(slope, eta_y), tag, along_y + i);
    hn::Store(hn::Neg(hn::Mul(slope, kd)), tag, by_log_sharpness + i);
  }
}

template <Kernel kernel>
Projection project_of(const LobeShape& lobe, const SliceSamples& samples, const float* const residual[3]) {
  const Tag tag;
  const Broadcast b(lobe);
  Lanes m0 = hn::Zero(tag), m1 = m0, m2 = m0, norm_sq = m0;
  for (size_t i = 0; i < samples.padded(); i += hn::Lanes(tag)) {
    Lanes shape, slope;
    shape_and_slope<kernel>(scaled_distance(b, hn::Load(tag, samples.x() + i), hn::Load(tag, samples.y() + i),
                                            hn::Load(tag, samples.z() + i)),
                            shape, slope);
    shape = hn::Mul(shape, hn::Load(tag, samples.sqrt_weight() + i));
    m0 = hn::MulAdd(shape, hn::Load(tag, residual[0] + i), m0);
    m1 = hn::MulAdd(shape, hn::Load(tag, residual[1] + i), m1);
    m2 = hn::MulAdd(shape, hn::Load(tag, residual[2] + i), m2);
    norm_sq = hn::MulAdd(shape, shape, norm_sq);
  }
  const auto sum = [tag](Lanes v) { return static_cast<double>(hn::GetLane(hn::SumOfLanes(tag, v))); };
  return {{sum(m0), sum(m1), sum(m2)}, sum(norm_sq)};
}

void Project(Kernel kernel, const LobeShape& lobe, const SliceSamples& samples, const float* const residual[3],
             Projection& out) {
  const auto project = kernel == Kernel::gaussian ? project_of<Kernel::gaussian> : project_of<Kernel::abel_poisson>;
  out = project(lobe, samples, residual);
}

void FillValue(Kernel kernel, const LobeShape& lobe, const SliceSamples& samples, float* out) {
  if (kernel == Kernel::gaussian) return fill_value_of<Kernel::gaussian>(lobe, samples, out);
  fill_value_of<Kernel::abel_poisson>(lobe, samples, out);
}

void FillDerivatives(Kernel kernel, const LobeShape& lobe, const SliceSamples& samples, float* along_x, float* along_y,
                     float* by_log_sharpness) {
  const auto fill =
      kernel == Kernel::gaussian ? fill_derivatives_of<Kernel::gaussian> : fill_derivatives_of<Kernel::abel_poisson>;
  fill(lobe, samples, along_x, along_y, by_log_sharpness);
}

/// Dot products of 4 rows with 4 columns over [begin, end): 16 sums in registers, 8 loads for 16 multiply-adds.
void AddTile(const float* const* rows, const float* const* columns, size_t begin, size_t end, double* out,
             size_t row_stride, size_t column_stride) {
  const Tag tag;
  Lanes s00 = hn::Zero(tag), s01 = s00, s02 = s00, s03 = s00, s10 = s00, s11 = s00, s12 = s00, s13 = s00;
  Lanes s20 = s00, s21 = s00, s22 = s00, s23 = s00, s30 = s00, s31 = s00, s32 = s00, s33 = s00;
  for (size_t i = begin; i < end; i += hn::Lanes(tag)) {
    const Lanes c0 = hn::Load(tag, columns[0] + i), c1 = hn::Load(tag, columns[1] + i);
    const Lanes c2 = hn::Load(tag, columns[2] + i), c3 = hn::Load(tag, columns[3] + i);
    Lanes r = hn::Load(tag, rows[0] + i);
    s00 = hn::MulAdd(r, c0, s00), s01 = hn::MulAdd(r, c1, s01);
    s02 = hn::MulAdd(r, c2, s02), s03 = hn::MulAdd(r, c3, s03);
    r = hn::Load(tag, rows[1] + i);
    s10 = hn::MulAdd(r, c0, s10), s11 = hn::MulAdd(r, c1, s11);
    s12 = hn::MulAdd(r, c2, s12), s13 = hn::MulAdd(r, c3, s13);
    r = hn::Load(tag, rows[2] + i);
    s20 = hn::MulAdd(r, c0, s20), s21 = hn::MulAdd(r, c1, s21);
    s22 = hn::MulAdd(r, c2, s22), s23 = hn::MulAdd(r, c3, s23);
    r = hn::Load(tag, rows[3] + i);
    s30 = hn::MulAdd(r, c0, s30), s31 = hn::MulAdd(r, c1, s31);
    s32 = hn::MulAdd(r, c2, s32), s33 = hn::MulAdd(r, c3, s33);
  }
  const Lanes sums[16] = {s00, s01, s02, s03, s10, s11, s12, s13, s20, s21, s22, s23, s30, s31, s32, s33};
  for (size_t k = 0; k < 16; ++k) {
    out[k / 4 * row_stride + k % 4 * column_stride] += static_cast<double>(hn::GetLane(hn::SumOfLanes(tag, sums[k])));
  }
}

/// Coefficients [column][channel].
void SubtractColumns(const float* const* columns, const float* coefficients, size_t count, const float* const* target,
                     size_t padded, float* const* residual) {
  const Tag tag;
  for (size_t i = 0; i < padded; i += hn::Lanes(tag)) {
    Lanes r0 = hn::Load(tag, target[0] + i), r1 = hn::Load(tag, target[1] + i), r2 = hn::Load(tag, target[2] + i);
    for (size_t j = 0; j < count; ++j) {
      const Lanes column = hn::Load(tag, columns[j] + i);
      r0 = hn::NegMulAdd(hn::Set(tag, coefficients[3 * j]), column, r0);
      r1 = hn::NegMulAdd(hn::Set(tag, coefficients[3 * j + 1]), column, r1);
      r2 = hn::NegMulAdd(hn::Set(tag, coefficients[3 * j + 2]), column, r2);
    }
    hn::Store(r0, tag, residual[0] + i);
    hn::Store(r1, tag, residual[1] + i);
    hn::Store(r2, tag, residual[2] + i);
  }
}

}  // namespace velour::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

namespace {
HWY_EXPORT(FillValue);
HWY_EXPORT(FillDerivatives);
HWY_EXPORT(Project);
HWY_EXPORT(AddTile);
HWY_EXPORT(SubtractColumns);

// Samples summed in float before the sum goes to a double: 64 per lane with 16 lanes. Four columns of a block stay in
// L1 while the others stream past.
constexpr size_t kBlock = 1024;

/// Pointers to columns, padded with the last one to a multiple of 4, so that all tiles are full.
std::vector<const float*> in_fours(std::span<const float* const> columns) {
  std::vector<const float*> out(columns.begin(), columns.end());
  while (out.size() % 4 != 0) out.push_back(out.back());
  return out;
}
}  // namespace

void fill_value(Kernel kernel, const LobeShape& shape, const SliceSamples& samples, float* out) {
  VELOUR_SIMD_DISPATCH(FillValue)(kernel, shape, samples, out);
}

LobeTangents lobe_tangents(const LobeShape& shape) {
  const Frame frame = Frame::about(Vec3(shape.center));
  // The frame is in float; make it orthogonal to the center in double.
  const Vec3d x = glm::normalize(Vec3d(frame.x) - glm::dot(Vec3d(frame.x), shape.center) * shape.center);
  return {x, glm::cross(shape.center, x)};
}

void fill_derivatives(Kernel kernel, const LobeShape& shape, const SliceSamples& samples, float* along_x,
                      float* along_y, float* by_log_sharpness) {
  VELOUR_SIMD_DISPATCH(FillDerivatives)(kernel, shape, samples, along_x, along_y, by_log_sharpness);
}

Projection project(Kernel kernel, const LobeShape& shape, const SliceSamples& samples, const float* const residual[3]) {
  Projection out;
  VELOUR_SIMD_DISPATCH(Project)(kernel, shape, samples, residual, out);
  return out;
}

void cross_gram(std::span<const float* const> rows, std::span<const float* const> columns, size_t padded,
                Eigen::MatrixXd& out) {
  out.resize(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(columns.size()));
  if (rows.empty() || columns.empty()) return;
  const auto r = in_fours(rows), c = in_fours(columns);
  Eigen::MatrixXd sums =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(r.size()), static_cast<Eigen::Index>(c.size()));
  for (size_t begin = 0; begin < padded; begin += kBlock) {
    const size_t end = std::min(begin + kBlock, padded);
    for (size_t i = 0; i < r.size(); i += 4) {
      for (size_t j = 0; j < c.size(); j += 4) {
        VELOUR_SIMD_DISPATCH(AddTile)(&r[i], &c[j], begin, end, sums.data() + i + j * r.size(), 1, r.size());
      }
    }
  }
  out = sums.topLeftCorner(out.rows(), out.cols());
}

void gram(std::span<const float* const> columns, size_t padded, Eigen::MatrixXd& out) {
  const auto n = static_cast<Eigen::Index>(columns.size());
  out.resize(n, n);
  if (columns.empty()) return;
  const auto c = in_fours(columns);
  const auto m = static_cast<Eigen::Index>(c.size());
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(m, m);
  for (size_t begin = 0; begin < padded; begin += kBlock) {
    const size_t end = std::min(begin + kBlock, padded);
    for (size_t j = 0; j < c.size(); j += 4) {
      for (size_t i = j; i < c.size(); i += 4) {
        VELOUR_SIMD_DISPATCH(AddTile)(&c[i], &c[j], begin, end, sums.data() + i + j * c.size(), 1, c.size());
      }
    }
  }
  out = sums.topLeftCorner(n, n).selfadjointView<Eigen::Lower>();
}

void subtract_columns(std::span<const float* const> columns, const Eigen::MatrixXd& coefficients,
                      const float* const target[3], size_t padded, float* const residual[3]) {
  const Eigen::MatrixXf by_column = coefficients.transpose().cast<float>();
  VELOUR_SIMD_DISPATCH(SubtractColumns)(columns.data(), by_column.data(), columns.size(), target, padded, residual);
}

}  // namespace velour
#endif  // HWY_ONCE
