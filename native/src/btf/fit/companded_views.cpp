#include "btf/fit/companded_views.h"

#include <Eigen/Eigenvalues>

#include "base/parallel.h"
#include "btf/measure/btf_measurement.h"

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

}  // namespace velour
