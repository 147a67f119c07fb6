#include "btf/fit/tensor/tensor_texels.h"

#include <algorithm>
#include <Eigen/Cholesky>
#include <numeric>

#include "base/parallel.h"
#include "btf/fit/relief_pyramid.h"
#include "btf/model/srbf_btf.h"

namespace velour {
namespace {

constexpr float kMemberRidge = 1e-3f;        // on coefficients; functions have length 1 if all views show them
constexpr int kMaxSteps = 12;                // maximum number of conjugate-gradient iterations
constexpr double kMembersConverged = 1e-10;  // relative to the initial squared residual

/// Inverses of the products of a texel's members over all views. As many as fit into TensorSource::inverse_bytes are
/// kept; the others are computed again for every product.
class MemberInverses {
 public:
  MemberInverses(const TensorFunctions& functions, const TensorTexelValues& values, const TensorSource& source,
                 const Progress& progress)
      : functions_(functions), sets_(values), threads_(source.threads), progress_(progress) {
    const auto numbers = static_cast<uint64_t>(values.value.cols()) * static_cast<uint64_t>(values.value.cols());
    inverse_.resize(std::min(sets_.size(), source.inverse_bytes / (numbers * sizeof(float))));
    parallel_pieces(inverse_.size(), threads_, progress_, [&](size_t set) { inverse_[set] = inverse_of(set); });
  }

  RowMatrix times(const RowMatrix& rows) const {
    RowMatrix product(rows.rows(), rows.cols());
    parallel_pieces(sets_.size(), threads_, progress_, [&](size_t set) {
      const Eigen::MatrixXf computed = set < inverse_.size() ? Eigen::MatrixXf() : inverse_of(set);
      const Eigen::MatrixXf& inverse = set < inverse_.size() ? inverse_[set] : computed;
      for (const uint32_t t : sets_.texels(set)) product.row(t).noalias() = rows.row(t) * inverse;
    });
    return product;
  }

 private:
  Eigen::MatrixXf inverse_of(size_t set) const {
    const Eigen::MatrixXf matrix =
        TensorFunctions::of_members(functions_.products(), functions_.rank(), sets_.members(set), kMemberRidge);
    return matrix.llt().solve(Eigen::MatrixXf::Identity(matrix.rows(), matrix.cols()));
  }

  const TensorFunctions& functions_;
  const MemberSets sets_;
  const int threads_;
  const Progress& progress_;
  std::vector<Eigen::MatrixXf> inverse_;
};

double dot(const RowMatrix& a, const RowMatrix& b) {
  double sum = 0;
  for (Index t = 0; t < a.rows(); ++t) sum += static_cast<double>(a.row(t).dot(b.row(t)));
  return sum;
}

}  // namespace

/// Products of functions over the views, weighted by the visibility of one texel.
class TensorTexels::OfTexel {
 public:
  OfTexel(const TensorFunctions& functions, const ShownViews& shown, size_t texel) : functions_(functions) {
    for (Index v = 0; v < functions.views(); ++v) {
      if (!shown.shown(texel, v)) hidden_.push_back(v);
    }
    if (!hidden_.empty()) block_.resize(static_cast<size_t>(functions.clusters() * functions.clusters()));
  }

  Eigen::MatrixXf block(uint32_t c, uint32_t d) {
    const Index rank = functions_.rank();
    if (hidden_.empty()) return functions_.products().block(c * rank, d * rank, rank, rank);
    Eigen::MatrixXf& block = block_[static_cast<size_t>(c * functions_.clusters() + d)];
    if (block.size() > 0) return block;
    block = functions_.products().block(c * rank, d * rank, rank, rank);
    for (const Index v : hidden_) {
      block -= (1 - ShownViews::kHidden) * functions_.products(v).block(c * rank, d * rank, rank, rank);
    }
    return block;
  }

 private:
  const TensorFunctions& functions_;
  std::vector<Index> hidden_;
  std::vector<Eigen::MatrixXf> block_;
};

TensorTexels::TensorTexels(const TensorSource& source, const SeenTexels& seen, const ShownViews& shown,
                           const TensorFunctions& functions, const Progress& progress)
    : source_(source), seen_(seen), shown_(shown), functions_(functions), progress_(progress) {
  const auto rows = static_cast<Index>(texels());
  shows_ = RowMatrix::Zero(rows, functions.count());
  if (!shown.all()) hidden_ = RowMatrix::Zero(rows, functions.count());
  if (!seen.plane()) data_ = RowMatrix::Zero(rows, functions.count());
}

template <class Work>
void TensorTexels::pieces(const Work& work) const {
  parallel_pieces((texels() + kTexelsPerPiece - 1) / kTexelsPerPiece, source_.threads, progress_, [&](size_t piece) {
    for (size_t t = piece * kTexelsPerPiece; t < std::min(texels(), (piece + 1) * kTexelsPerPiece); ++t) work(t);
  });
}

void TensorTexels::add_view(Index view, const LevelImages& images, const std::vector<FunctionsOfView>& functions) {
  RowMatrix moments(shows_.rows(), shows_.cols());
  parallel_pieces((texels() + kTexelsPerPiece - 1) / kTexelsPerPiece, source_.threads, progress_, [&](size_t piece) {
    const auto first = static_cast<Index>(piece * kTexelsPerPiece);
    auto rows = moments.middleRows(first, std::min<Index>(kTexelsPerPiece, moments.rows() - first));
    rows.setZero();
    for (size_t a = 0; a < 3; ++a) {
      rows.noalias() +=
          images.value[a].middleRows(first, rows.rows()) * functions[static_cast<size_t>(view)][a].transpose();
    }
  });
  std::vector<uint32_t> all(texels());
  std::iota(all.begin(), all.end(), 0u);
  const auto shown = shown_texels(seen_.relief(), all, source_.side.view[static_cast<size_t>(view)],
                                  tile_aspect(source_.grid), source_.threads, progress_);
  pieces([&](size_t t) {
    if (!shown[t].shown) return;
    shows_.row(static_cast<Index>(t)) += blended(moments, shown[t].at);
  });
  if (!shown_.all()) add_hidden(view, images, functions);
  const float cosine = source_.side.view[static_cast<size_t>(view)].z;
  for (size_t l = 0; l < source_.side.light.size(); ++l) {
    for (const RowMatrix& image : images.value) {
      const float square = image.col(static_cast<Index>(l)).squaredNorm();
      measured_ += static_cast<double>(cosine * source_.side.light[l].z * square);
    }
  }
  if (seen_.plane()) return;
  const SeenTexels::Sources from = seen_.sources(view);
  pieces([&](size_t t) {
    for (uint32_t i = from.first[t]; i < from.first[t + 1]; ++i) {
      data_.row(static_cast<Index>(t)) += from.weight[i] * moments.row(from.source[i]);
    }
  });
}

/// Adds the values of the view for the views that it stands in for.
void TensorTexels::add_hidden(Index view, const LevelImages& images, const std::vector<FunctionsOfView>& functions) {
  const ShownViews::Values values = shown_.values(view, images, progress_);
  pieces([&](size_t t) {
    for (Index v = 0; v < shown_.views(); ++v) {
      if (v == view || shown_.stand_in(t, v) != view) continue;
      for (size_t a = 0; a < 3; ++a) {
        hidden_.row(static_cast<Index>(t)).noalias() += ShownViews::kHidden * values[a].row(static_cast<Index>(t)) *
                                                        functions[static_cast<size_t>(v)][a].transpose();
      }
    }
  });
}

TensorTexelValues TensorTexels::solve(Index members, const std::function<void(double)>& after_step) const {
  TensorTexelValues values{std::vector<uint32_t>(texels() * static_cast<size_t>(members)),
                           RowMatrix(shows_.rows(), members * functions_.rank())};
  pieces([&](size_t t) { choose(t, values); });
  after_step(seen_.plane() ? 1.0 : 0.2);
  if (!seen_.plane()) refine(values, [&](double part) { after_step(0.2 + 0.8 * part); });
  return values;
}

/// Repeatedly adds the cluster that explains most of the residual and solves for all coefficients again.
void TensorTexels::choose(size_t texel, TensorTexelValues& values) const {
  const Index rank = functions_.rank();
  const auto members = values.value.cols() / rank;
  OfTexel of(functions_, shown_, texel);
  Eigen::RowVectorXf moments = shows_.row(static_cast<Index>(texel));
  if (!shown_.all()) moments += hidden_.row(static_cast<Index>(texel));
  std::vector<uint32_t> chosen;
  Eigen::VectorXf solution;
  while (static_cast<Index>(chosen.size()) < members) {
    uint32_t best = 0;
    float most = -1;
    for (uint32_t c = 0; c < static_cast<uint32_t>(functions_.clusters()); ++c) {
      if (std::find(chosen.begin(), chosen.end(), c) != chosen.end()) continue;
      Eigen::VectorXf rest = moments.segment(c * rank, rank).transpose();
      for (size_t k = 0; k < chosen.size(); ++k) {
        rest -= of.block(c, chosen[k]) * solution.segment(static_cast<Index>(k) * rank, rank);
      }
      Eigen::MatrixXf own = of.block(c, c);
      own.diagonal().array() += kMemberRidge;
      const float gain = rest.dot(own.llt().solve(rest));
      if (gain <= most) continue;
      most = gain;
      best = c;
    }
    chosen.insert(std::upper_bound(chosen.begin(), chosen.end(), best), best);
    const auto count = static_cast<Index>(chosen.size());
    Eigen::MatrixXf matrix(count * rank, count * rank);
    Eigen::VectorXf right(count * rank);
    for (Index i = 0; i < count; ++i) {
      right.segment(i * rank, rank) = moments.segment(chosen[static_cast<size_t>(i)] * rank, rank).transpose();
      for (Index j = 0; j < count; ++j) {
        matrix.block(i * rank, j * rank, rank, rank) =
            of.block(chosen[static_cast<size_t>(i)], chosen[static_cast<size_t>(j)]);
      }
    }
    matrix.diagonal().array() += kMemberRidge;
    solution = matrix.llt().solve(right);
  }
  std::copy(chosen.begin(), chosen.end(), values.member.begin() + static_cast<ptrdiff_t>(texel * chosen.size()));
  values.value.row(static_cast<Index>(texel)) = solution.transpose();
}

void TensorTexels::add_products(Index view, const TensorTexelValues& values, RowMatrix& sums) const {
  RowMatrix moments(shows_.rows(), shows_.cols());
  parallel_pieces((texels() + kTexelsPerPiece - 1) / kTexelsPerPiece, source_.threads, progress_, [&](size_t piece) {
    const size_t first = piece * kTexelsPerPiece, end = std::min(texels(), first + kTexelsPerPiece);
    moments.middleRows(static_cast<Index>(first), static_cast<Index>(end - first)).noalias() =
        seen_.spread(view, first, end, values, functions_.count()) * functions_.products(view);
  });
  const Index rank = functions_.rank();
  const auto members = static_cast<size_t>(values.members());
  const SeenTexels::Sources from = seen_.sources(view);
  pieces([&](size_t t) {
    for (uint32_t i = from.first[t]; i < from.first[t + 1]; ++i) {
      for (size_t k = 0; k < members; ++k) {
        sums.row(static_cast<Index>(t)).segment(static_cast<Index>(k) * rank, rank) +=
            from.weight[i] * moments.row(from.source[i]).segment(values.member[t * members + k] * rank, rank);
      }
    }
    if (shown_.shown(t, view)) return;
    const std::vector<uint32_t> set(values.member.begin() + static_cast<ptrdiff_t>(t * members),
                                    values.member.begin() + static_cast<ptrdiff_t>((t + 1) * members));
    sums.row(static_cast<Index>(t)).noalias() += ShownViews::kHidden * values.value.row(static_cast<Index>(t)) *
                                                 TensorFunctions::of_members(functions_.products(view), rank, set, 0);
  });
}

RowMatrix TensorTexels::normal_product(const TensorTexelValues& values) const {
  RowMatrix product = kMemberRidge * values.value;
  for (Index v = 0; v < functions_.views(); ++v) {
    progress_.check();
    add_products(v, values, product);
  }
  return product;
}

void TensorTexels::refine(TensorTexelValues& values, const std::function<void(double)>& after_step) const {
  const MemberInverses inverse(functions_, values, source_, progress_);
  const Index rank = functions_.rank();
  const auto members = static_cast<size_t>(values.members());
  const RowMatrix wanted = shown_.all() ? data_ : RowMatrix(data_ + hidden_);
  RowMatrix rest = -normal_product(values);
  for (size_t t = 0; t < texels(); ++t) {
    for (size_t k = 0; k < members; ++k) {
      rest.row(static_cast<Index>(t)).segment(static_cast<Index>(k) * rank, rank) +=
          wanted.row(static_cast<Index>(t)).segment(values.member[t * members + k] * rank, rank);
    }
  }
  RowMatrix turned = inverse.times(rest);
  TensorTexelValues direction{values.member, turned};
  double energy = dot(rest, turned);
  const double settled = kMembersConverged * energy;
  for (int step = 0; step < kMaxSteps && energy > settled; ++step) {
    const RowMatrix product = normal_product(direction);
    const auto length = static_cast<float>(energy / dot(direction.value, product));
    values.value += length * direction.value;
    rest -= length * product;
    turned = inverse.times(rest);
    const double now = dot(rest, turned);
    direction.value = turned + static_cast<float>(now / energy) * direction.value;
    energy = now;
    after_step(static_cast<double>(step + 1) / kMaxSteps);
  }
}

double modelled_squares(const TensorSource& source, const SeenTexels& seen, const TensorFunctions& functions,
                        const TensorTexelValues& values, const Progress& progress) {
  Eigen::VectorXf cosine(static_cast<Index>(source.side.light.size()));
  for (Index l = 0; l < cosine.size(); ++l) cosine[l] = source.side.light[static_cast<size_t>(l)].z;
  double sum = 0;
  for (Index v = 0; v < functions.views(); ++v) {
    const RowMatrix products = functions.weighed_products(v, cosine);
    std::vector<double> part((seen.texels() + kTexelsPerPiece - 1) / kTexelsPerPiece);
    parallel_pieces(part.size(), source.threads, progress, [&](size_t piece) {
      const size_t first = piece * kTexelsPerPiece, end = std::min(seen.texels(), first + kTexelsPerPiece);
      const RowMatrix rows = seen.spread(v, first, end, values, functions.count());
      part[piece] = dot(rows, rows * products);
    });
    sum += static_cast<double>(source.side.view[static_cast<size_t>(v)].z) *
           std::accumulate(part.begin(), part.end(), 0.0);
  }
  return sum;
}

}  // namespace velour
