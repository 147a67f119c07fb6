#include "btf/fit/side_views.h"

#include <Eigen/Eigenvalues>

#include "base/parallel.h"
#include "btf/measure/btf_measurement.h"
#include "image/texels.h"

namespace velour {

CompandedViews::CompandedViews(const BtfMeasurement& btf, Companding companding, int threads, const Progress& progress)
    : btf_(btf), companding_(companding), threads_(threads), progress_(progress) {}

void CompandedViews::read(uint32_t view, std::vector<float>& f) {
  const PairLayout& layout = btf_.layout();
  const uint64_t first = layout.first(view), count = layout.first(view + 1) - first;
  const size_t image = btf_.grid().texels() * 3;
  halves_.resize(count * image);
  f.resize(halves_.size());
  btf_.read_pairs(first, count, halves_);
  std::vector<uint64_t> bad(count);
  parallel_pieces(count, threads_, progress_, [&](size_t i) {
    const std::span<float> floats(f.data() + i * image, image);
    halves_to_floats({halves_.data() + i * image, image}, floats);
    bad[i] = mend_image(floats);
  });
  if (view == 0) not_finite_ = 0;
  for (const uint64_t n : bad) not_finite_ += n;
}

void CompandedViews::planes(const std::vector<float>& f, uint64_t texels, Planes& planes) const {
  const uint64_t count = f.size() / (texels * 3);
  for (RowMatrix& plane : planes) plane.resize(static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(texels));
  parallel_pieces(count, threads_, progress_, [&](size_t row) {
    const float* image = f.data() + row * texels * 3;
    const auto r = static_cast<Eigen::Index>(row);
    for (uint64_t texel = 0; texel < texels; ++texel, image += 3) {
      const Vec3 value(companded(companding_, image[0]), companded(companding_, image[1]),
                       companded(companding_, image[2]));
      const auto t = static_cast<Eigen::Index>(texel);
      for (int a = 0; a < 3; ++a) planes[static_cast<size_t>(a)](r, t) = glm::dot(axes_[a], value);
    }
  });
}

Mat3 CompandedViews::decorrelate() {
  set_axes(Mat3(1.0f));
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  std::vector<float> f;
  Planes planes;
  energies_.clear();
  for (uint32_t v = 0; v < views(); ++v) {
    progress_.check();
    read(v, f);
    this->planes(f, btf_.grid().texels(), planes);
    for (Eigen::Index row = 0; row < planes[0].rows(); ++row) {
      float sum = 0;
      for (const RowMatrix& plane : planes) sum += plane.row(row).squaredNorm();
      energies_.push_back(static_cast<double>(sum));
    }
    for (size_t a = 0; a < 3; ++a) {
      for (size_t b = 0; b <= a; ++b) {
        double sum = 0;
        for (Eigen::Index row = 0; row < planes[a].rows(); ++row) {
          sum += static_cast<double>(planes[a].row(row).dot(planes[b].row(row)));
        }
        products(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) += sum;
      }
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(products);  // reads the lower triangle
  for (int a = 0; a < 3; ++a) {
    const Eigen::Vector3d axis = solver.eigenvectors().col(2 - a);
    const double sign = axis.sum() < 0 ? -1 : 1;  // the sign of an eigenvector is arbitrary
    axes_[a] = Vec3(Vec3d(axis.x(), axis.y(), axis.z()) * sign);
  }
  return axes_;
}

namespace {

void take_side(const std::vector<PolarAngles>& set, bool below, std::vector<uint32_t>& number,
               std::vector<Vec3>& directions) {
  for (uint32_t i = 0; i < set.size(); ++i) {
    const Vec3 w = unit_direction(set[i]);
    if ((w.z < 0) != below) continue;
    number.push_back(i);
    directions.emplace_back(w.x, w.y, std::abs(w.z));
  }
}

/// Values of the side's lights as texel x light.
RowMatrix by_texel(const RowMatrix& plane, const SideDirections& side) {
  RowMatrix values(plane.cols(), static_cast<Eigen::Index>(side.light.size()));
  for (size_t l = 0; l < side.light.size(); ++l) {
    values.col(static_cast<Eigen::Index>(l)) = plane.row(side.light_number[l]).transpose();
  }
  return values;
}

}  // namespace

std::vector<SideDirections> sides_of(const PairLayout& layout) {
  std::vector<SideDirections> sides;
  for (const bool view_below : {false, true}) {
    for (const bool light_below : {view_below, !view_below}) {
      SideDirections side{view_below, light_below, {}, {}, {}, {}};
      take_side(layout.views(), view_below, side.view_number, side.view);
      take_side(layout.lights(), light_below, side.light_number, side.light);
      if (!side.view.empty() && !side.light.empty()) sides.push_back(std::move(side));
    }
  }
  return sides;
}

std::vector<float> halved_images(const std::vector<float>& f, uint32_t width, uint32_t height) {
  const size_t image = size_t{width} * height * 3, coarse = size_t{half_of(width)} * half_of(height) * 3;
  std::vector<float> out(f.size() / image * coarse);
  for (size_t i = 0; i * image < f.size(); ++i) {
    const std::vector<float> half = half_image({f.data() + i * image, image}, width, height, 3);
    std::copy(half.begin(), half.end(), out.begin() + static_cast<ptrdiff_t>(i * coarse));
  }
  return out;
}

void read_side_view(CompandedViews& views, const TexelGrid& grid, const SideDirections& side, size_t view,
                    size_t levels, std::vector<LevelImages>& images) {
  std::vector<float> f;
  views.read(side.view_number[view], f);
  images.resize(levels);
  CompandedViews::Planes planes;
  uint32_t width = grid.width, height = grid.height;
  for (LevelImages& level : images) {
    level.width = width;
    level.height = height;
    views.planes(f, uint64_t{width} * height, planes);
    for (size_t a = 0; a < 3; ++a) level.value[a] = by_texel(planes[a], side);
    if (&level == &images.back()) break;
    f = halved_images(f, width, height);
    width = half_of(width);
    height = half_of(height);
  }
}

}  // namespace velour
