#include "btf/fit/srbf/texel_solver.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "base/memory.h"
#include "base/parallel.h"
#include "btf/fit/byte_rounding.h"
#include "btf/fit/relief_pyramid.h"
#include "btf/model/srbf_btf.h"
#include "image/texels.h"
#include "math/tensor/decompositions.h"
#include "math/tensor/matrix_product.h"

namespace velour {

namespace {

constexpr double kLobeRidge = 1e-4;         // on coefficients, relative to a lobe of value 1 everywhere
constexpr double kTexelsConverged = 1e-12;  // relative squared residual; below float precision steps become 0 / 0
constexpr size_t kSampled = 170;            // approximate number of texels per view for means
constexpr size_t kTogether = 8;             // texels whose lobes are multiplied at once
constexpr size_t kSums = 16;                // number of partial sums; fixed as well

}  // namespace

struct TexelSolver::Place {
  BilinearTexels texels;
  Mat3 to_normal;
};

TexelSolver::TexelSolver(const SideDirections& side, const SharedLobes& lobes, const Relief& relief, int threads,
                         const Progress& progress)
    : side_(side),
      lobes_(lobes),
      relief_(relief),
      threads_(threads),
      progress_(progress),
      tile_(std::span(lobes.lobes).first(lobes.tile_lobes)),
      texel_(std::span(lobes.lobes).subspan(lobes.tile_lobes)),
      stride_(tile_.padded() + texel_.padded()) {
  for (uint32_t a = 0; a < 3; ++a) {
    for (const uint16_t lobe : lobes.lobe[a]) {
      column_.push_back(a * stride_ + (lobe < tile_.size() ? lobe : tile_.padded() + lobe - tile_.size()));
    }
  }
  data_.setZero(Eigen::Index{relief.width()} * relief.height(), static_cast<Eigen::Index>(column_.size()));
  set_coordinates();
}

std::vector<TexelSolver::Place> TexelSolver::places(size_t view) const {
  const uint32_t width = relief_.width(), height = relief_.height();
  std::vector<Place> places(size_t{width} * height);
  parallel_pieces(height, threads_, progress_, [&](size_t row) {
    for (uint32_t x = 0; x < width; ++x) {
      const Vec2 place((static_cast<float>(x) + 0.5f) / static_cast<float>(width),
                       (static_cast<float>(row) + 0.5f) / static_cast<float>(height));
      Place& at = places[row * width + x];
      at.texels = bilinear_texels(relief_.seen(place, side_.view[view]), width, height);
      at.to_normal = to_normal(relief_.slope(at.texels));
    }
  });
  return places;
}

/// A sample of a view's texels.
std::vector<size_t> TexelSolver::sample(size_t view) const {
  const size_t texels = size_t{relief_.width()} * relief_.height(), step = std::max<size_t>(1, texels / kSampled);
  std::vector<size_t> sample;
  for (size_t t = view % step; t < texels; t += step) sample.push_back(t);
  return sample;
}

/// Interpolates the coefficients at a place.
Eigen::RowVectorXf TexelSolver::blended(const RowMatrix& coefficient, const Place& place) {
  Eigen::RowVectorXf sum = Eigen::RowVectorXf::Zero(coefficient.cols());
  for (size_t i = 0; i < 4; ++i) sum += place.texels.weight[i] * coefficient.row(place.texels.index[i]);
  return sum;
}

/// Writes a row of lobe values for every light.
void TexelSolver::write_rows(size_t view, const Place& place, float* rows) const {
  for (const Vec3& wl : side_.light) {
    const LobeArguments at({wl, side_.view[view]});
    tile_.values(at, rows);
    texel_.values(at.turned(place.to_normal), rows + tile_.padded());
    rows += stride_;
  }
}

/// Adds to `sums`, for every texel of the view, the moments of its lobes with the output of values_of(texel, place,
/// rows, values), at the texels that it sees.
template <class Values>
void TexelSolver::accumulate(size_t view, const Values& values_of, RowMatrix& sums) const {
  const std::vector<Place> place = places(view);
  const auto lights = static_cast<uint32_t>(side_.light.size());
  std::vector<LobeArguments> pair;
  AlignedArray<float> tile_rows(size_t{lights} * stride_);
  for (uint32_t l = 0; l < lights; ++l) {
    pair.emplace_back(DirectionPair{side_.light[l], side_.view[view]});
    tile_.values(pair[l], tile_rows.data() + size_t{l} * stride_);
  }
  RowMatrix moment(static_cast<Eigen::Index>(place.size()), sums.cols());
  parallel_pieces((place.size() + kTexelsPerPiece - 1) / kTexelsPerPiece, threads_, progress_, [&](size_t block) {
    AlignedArray<float> rows(size_t{lights} * stride_), values(size_t{lights} * 3), sum(size_t{3} * stride_);
    std::copy_n(tile_rows.data(), size_t{lights} * stride_, rows.data());
    for (size_t t = block * kTexelsPerPiece; t < std::min(place.size(), (block + 1) * kTexelsPerPiece); ++t) {
      for (uint32_t l = 0; l < lights; ++l) {
        texel_.values(pair[l].turned(place[t].to_normal), rows.data() + size_t{l} * stride_ + tile_.padded());
      }
      values_of(t, place[t], rows.data(), values.data());
      times_rows(rows.data(), lights, stride_, values.data(), sum.data());
      gather(sum.data(), moment.row(static_cast<Eigen::Index>(t)).data());
    }
  });
  // From the view's texels to those they see: by target, so that threads do not conflict and sums have a fixed order.
  std::vector<uint32_t> first(place.size() + 1);
  for (const Place& p : place) {
    for (const uint32_t i : p.texels.index) ++first[i + 1];
  }
  for (size_t t = 0; t < place.size(); ++t) first[t + 1] += first[t];
  std::vector<uint32_t> source(first.back()), next = first;
  for (uint32_t t = 0; t < place.size(); ++t) {
    for (uint32_t i = 0; i < 4; ++i) source[next[place[t].texels.index[i]]++] = 4 * t + i;
  }
  parallel_pieces((place.size() + kTexelsPerPiece - 1) / kTexelsPerPiece, threads_, progress_, [&](size_t block) {
    for (size_t t = block * kTexelsPerPiece; t < std::min(place.size(), (block + 1) * kTexelsPerPiece); ++t) {
      for (uint32_t i = first[t]; i < first[t + 1]; ++i) {
        const float weight = place[source[i] / 4].texels.weight[source[i] % 4];
        sums.row(static_cast<Eigen::Index>(t)) += weight * moment.row(source[i] / 4);
      }
    }
  });
}

void TexelSolver::add_view(size_t view, const LevelImages& images) {
  const auto take = [&](size_t t, const Place&, const float*, float* values) {
    for (size_t l = 0; l < side_.light.size(); ++l) {
      for (size_t a = 0; a < 3; ++a) {
        values[3 * l + a] = images.value[a](static_cast<Eigen::Index>(t), static_cast<Eigen::Index>(l));
      }
    }
  };
  accumulate(view, take, data_);
  for (const size_t t : sample(view)) {
    for (size_t l = 0; l < side_.light.size(); ++l) {
      for (const RowMatrix& image : images.value) {
        const float value = image(static_cast<Eigen::Index>(t), static_cast<Eigen::Index>(l));
        measured_ += static_cast<double>(side_.light[l].z * side_.view[view].z * value * value);
      }
    }
  }
}

double TexelSolver::modelled(const RowMatrix& solution) const {
  const auto lights = static_cast<uint32_t>(side_.light.size());
  AlignedArray<float> rows(size_t{lights} * stride_), values(size_t{lights} * 3), padded(size_t{3} * stride_);
  double sum = 0;
  for (size_t v = 0; v < side_.view.size(); ++v) {
    const std::vector<Place> place = places(v);
    for (const size_t t : sample(v)) {
      write_rows(v, place[t], rows.data());
      spread(blended(solution, place[t]).data(), padded.data());
      rows_times(rows.data(), lights, stride_, padded.data(), values.data());
      for (size_t i = 0; i < values.size(); ++i) {
        sum += static_cast<double>(side_.light[i / 3].z * side_.view[v].z * values.data()[i] * values.data()[i]);
      }
    }
  }
  return sum;
}

RowMatrix TexelSolver::normal_product(const RowMatrix& coefficient) const {
  RowMatrix product = RowMatrix::Zero(coefficient.rows(), coefficient.cols());
  const auto lights = static_cast<uint32_t>(side_.light.size());
  const auto modelled = [&](size_t, const Place& place, const float* rows, float* values) {
    AlignedArray<float> padded(size_t{3} * stride_);
    spread(blended(coefficient, place).data(), padded.data());
    rows_times(rows, lights, stride_, padded.data(), values);
  };
  for (size_t v = 0; v < side_.view.size(); ++v) {
    progress_.check();
    accumulate(v, modelled, product);
  }
  return product;
}

void TexelSolver::spread(const float* compact, float* padded) const {
  std::fill_n(padded, size_t{3} * stride_, 0.0f);
  for (size_t k = 0; k < column_.size(); ++k) padded[column_[k]] = compact[k];
}

void TexelSolver::gather(const float* padded, float* compact) const {
  for (size_t k = 0; k < column_.size(); ++k) compact[k] = padded[column_[k]];
}

/// Adds the products of any two lobes over sampled texels of a view and all lights, on and below the diagonal; returns
/// the number of summands.
size_t TexelSolver::add_products(size_t view, Eigen::MatrixXd& sum) const {
  const std::vector<Place> place = places(view);
  const std::vector<size_t> texels = sample(view);
  const size_t lights = side_.light.size();
  const Eigen::Index stride = stride_;
  AlignedArray<float> rows(kTogether * lights * stride_);
  RowMatrix product(stride, stride);
  for (size_t first = 0; first < texels.size(); first += kTogether) {
    const size_t count = std::min(kTogether, texels.size() - first);
    for (size_t i = 0; i < count; ++i) {
      write_rows(view, place[texels[first + i]], rows.data() + i * lights * stride_);
    }
    multiply_by_itself({rows.data(), stride, static_cast<Eigen::Index>(count * lights), 1, stride},
                       {product.data(), stride, stride, stride, 1});
    sum.triangularView<Eigen::Lower>() += product.cast<double>();
  }
  return texels.size() * lights;
}

/// Computes the whitening from the mean products of any two lobes over sampled texels and pairs.
void TexelSolver::set_coordinates() {
  std::vector<Eigen::MatrixXd> part(kSums, Eigen::MatrixXd::Zero(stride_, stride_));
  std::vector<size_t> count(kSums);
  parallel_pieces(kSums, threads_, progress_, [&](size_t s) {
    for (size_t v = s; v < side_.view.size(); v += kSums) count[s] += add_products(v, part[s]);
  });
  for (size_t s = 1; s < kSums; ++s) {
    part[0].triangularView<Eigen::Lower>() += part[s];
    count[0] += count[s];
  }
  const Eigen::MatrixXd sum = part[0].selfadjointView<Eigen::Lower>();
  const Eigen::MatrixXd mean = sum / static_cast<double>(count[0]);
  for (size_t a = 0, k = 0; a < 3; ++a) {
    const auto n = static_cast<Eigen::Index>(lobes_.lobe[a].size());
    Eigen::MatrixXd gram(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) {
        gram(i, j) = mean(column_[k + static_cast<size_t>(i)] % stride_, column_[k + static_cast<size_t>(j)] % stride_);
      }
    }
    gram.diagonal().array() += kLobeRidge;
    products_[a] = gram.cast<float>();
    whiten_[a] = n > 0 ? inverse_root(gram).cast<float>().eval() : Eigen::MatrixXf();
    k += static_cast<size_t>(n);
  }
}

RowMatrix TexelSolver::whitened(const RowMatrix& m) const {
  RowMatrix out(m.rows(), m.cols());
  Eigen::Index first = 0;
  for (const Eigen::MatrixXf& w : whiten_) {
    if (w.cols() > 0) out.middleCols(first, w.cols()).noalias() = m.middleCols(first, w.cols()) * w;
    first += w.cols();
  }
  return out;
}

RowMatrix TexelSolver::solve(const RowMatrix& start, int steps, const std::function<void(int)>& after_step) {
  // Ridge for a texel that a quarter of all pairs show.
  const auto ridge = static_cast<float>(kLobeRidge * static_cast<double>(side_.light.size() * side_.view.size()) / 4);
  RowMatrix x = RowMatrix::Zero(start.rows(), start.cols());
  RowMatrix rest = whitened(data_ - normal_product(start));
  RowMatrix direction = rest;
  double energy = static_cast<double>(rest.squaredNorm());
  const double settled = kTexelsConverged * energy;
  for (int step = 0; step < steps && energy > settled; ++step) {
    const RowMatrix product = whitened(normal_product(whitened(direction))) + ridge * direction;
    const double length = energy / static_cast<double>(direction.cwiseProduct(product).sum());
    x += static_cast<float>(length) * direction;
    rest -= static_cast<float>(length) * product;
    const double now = static_cast<double>(rest.squaredNorm());
    direction = rest + static_cast<float>(now / energy) * direction;
    energy = now;
    after_step(step);
  }
  return start + whitened(x);
}

namespace {

constexpr int kFinestSteps = 20, kCoarseSteps = 12;  // on the finest level, on coarser ones
constexpr double kTexelReading = 0.1;                // fraction of the progress

/// Interpolates coefficients to a finer level.
RowMatrix refined(const RowMatrix& coarse, uint32_t width, uint32_t height, const Relief& fine) {
  RowMatrix out(Eigen::Index{fine.width()} * fine.height(), coarse.cols());
  for (uint32_t y = 0; y < fine.height(); ++y) {
    for (uint32_t x = 0; x < fine.width(); ++x) {
      const Vec2 place((static_cast<float>(x) + 0.5f) / static_cast<float>(fine.width()),
                       (static_cast<float>(y) + 0.5f) / static_cast<float>(fine.height()));
      const BilinearTexels texels = bilinear_texels(place, width, height);
      auto row = out.row(Eigen::Index{y} * fine.width() + x);
      row.setZero();
      for (size_t i = 0; i < 4; ++i) row += texels.weight[i] * coarse.row(texels.index[i]);
    }
  }
  return out;
}

size_t coefficients_of(const SharedLobes& lobes) {
  return lobes.lobe[0].size() + lobes.lobe[1].size() + lobes.lobe[2].size();
}

/// Solved coefficients of a level, and the factor that makes them as bright as the data.
struct Solution {
  RowMatrix value;
  double brightening = 1;
};

/// Per level, finest first; coarser ones may have been restored.
using Solutions = std::vector<std::optional<Solution>>;

constexpr char kBrightening[] = ".brightening";

std::optional<Solution> kept_level(const TexelLevelsInput& input, const FitCheckpoint& checkpoint,
                                   const std::string& stage, const Relief& relief) {
  auto value = checkpoint.matrix(stage, Eigen::Index{relief.width()} * relief.height(),
                                 static_cast<Eigen::Index>(coefficients_of(input.lobes)));
  const auto factor = checkpoint.numbers(stage + kBrightening, 1);
  if (!value || !factor || factor->size() != 1) return std::nullopt;
  return Solution{std::move(*value), (*factor)[0]};
}

Solutions kept_levels(const TexelLevelsInput& input, const FitCheckpoint& checkpoint, const std::string& stage) {
  Solutions levels(input.relief.size());
  for (size_t l = levels.size(); l-- > 0;) {
    levels[l] = kept_level(input, checkpoint, stage + std::to_string(l), input.relief[l]);
    if (!levels[l]) break;  // finer levels start from it
  }
  return levels;
}

void keep_level(const Solution& level, const std::string& stage, FitCheckpoint& checkpoint) {
  checkpoint.keep(stage, level.value);
  checkpoint.keep_numbers(stage + kBrightening, {&level.brightening, 1});
  checkpoint.write();
}

using Solvers = std::vector<std::unique_ptr<TexelSolver>>;

/// Reads the data of the finest `levels` levels.
Solvers read_data(CompandedViews& views, const TexelLevelsInput& input, size_t levels, Progress& progress) {
  Solvers solver;
  if (levels == 0) return solver;
  for (size_t l = 0; l < levels; ++l) {
    solver.push_back(std::make_unique<TexelSolver>(input.side, input.lobes, input.relief[l], input.threads, progress));
  }
  std::vector<LevelImages> images;
  const size_t count = input.side.view.size();
  for (size_t v = 0; v < count; ++v) {
    progress.check();
    read_side_view(views, input.grid, input.side, v, levels, images);
    for (size_t l = 0; l < levels; ++l) solver[l]->add_view(v, images[l]);
    progress.update(kTexelReading * static_cast<double>(v + 1) / static_cast<double>(count));
  }
  return solver;
}

Solution solved(const TexelLevelsInput& input, TexelSolver& solver, const RowMatrix& start, size_t level,
                Progress& progress) {
  const int steps = level == 0 ? kFinestSteps : kCoarseSteps;
  // A level costs four times the next coarser one: the finest takes three quarters of the time.
  const double from = kTexelReading + (1 - kTexelReading) * std::pow(0.25, static_cast<double>(level + 1));
  const double to = kTexelReading + (1 - kTexelReading) * std::pow(0.25, static_cast<double>(level));
  const auto after_step = [&](int step) { progress.update(from + (to - from) * (step + 1) / steps); };
  RowMatrix value = solver.solve(start, steps, after_step);
  progress.update(to);  // it may have converged early
  const float factor = brightening(input.companding, solver.measured(), solver.modelled(value));
  return {std::move(value), static_cast<double>(factor)};
}

/// Coefficients of all texels, as bright as the data.
std::vector<float> bright_values(const Solution& level) {
  const RowMatrix bright = level.value * static_cast<float>(level.brightening);
  return {bright.data(), bright.data() + bright.size()};
}

}  // namespace

void solve_levels(CompandedViews& views, const TexelLevelsInput& input, FitCheckpoint& checkpoint,
                  const std::string& stage, Progress& progress, SrbfSide& side) {
  Solutions solution = kept_levels(input, checkpoint, stage);
  const auto missing =
      static_cast<size_t>(std::count_if(solution.begin(), solution.end(), [](const auto& s) { return !s; }));
  Solvers solver = read_data(views, input, missing, progress);
  side.levels.resize(solution.size());
  std::vector<std::vector<float>> values(solution.size());
  RowMatrix start = RowMatrix::Zero(1, static_cast<Eigen::Index>(coefficients_of(input.lobes)));
  for (size_t l = values.size(); l-- > 0;) {
    const Relief& relief = input.relief[l];
    if (!solution[l]) {
      solution[l] = solved(input, *solver[l], start, l, progress);
      solver[l].reset();
      keep_level(*solution[l], stage + std::to_string(l), checkpoint);
    }
    side.levels[l] = {relief.width(), relief.height(), stored_heights(relief), {}};
    values[l] = bright_values(*solution[l]);
    if (l > 0) start = refined(solution[l]->value, relief.width(), relief.height(), input.relief[l - 1]);
    solution[l].reset();
  }
  // Products on the finest level, whether its solver was needed or not.
  const TexelSolver finest(input.side, input.lobes, input.relief[0], input.threads, progress);
  set_rounded(finest.products(), std::move(values), side);
}

}  // namespace velour
