#include "compress/tensor_texels.h"

#include <algorithm>
#include <Eigen/Cholesky>
#include <map>
#include <numeric>

#include "btf/srbf_btf.h"
#include "job/parallel.h"

namespace velour {
namespace {

constexpr float kRidge = 1e-3f;     // of coefficients; functions are of length 1 where all views show them
constexpr int kSteps = 12;          // of the conjugate gradients
constexpr double kSettled = 1e-10;  // of the rest's square
constexpr size_t kTexels = 64;      // of a piece of work: fixed, so that sums do not depend on threads

/// Inverses of what the members of a texel are to each other, over all views: one for each set of members.
class MemberInverses {
 public:
  MemberInverses(const TensorFunctions& functions, const TensorTexelValues& values, size_t texels) {
    const size_t members = values.member.size() / texels;
    std::map<std::vector<uint32_t>, size_t> known;
    for (size_t t = 0; t < texels; ++t) {
      const auto from = values.member.begin() + static_cast<ptrdiff_t>(t * members);
      const std::vector<uint32_t> set(from, from + static_cast<ptrdiff_t>(members));
      const auto [at, is_new] = known.try_emplace(set, inverse_.size());
      of_.push_back(at->second);
      if (!is_new) continue;
      const Eigen::MatrixXf matrix = TensorFunctions::of_members(functions.products(), functions.rank(), set, kRidge);
      inverse_.push_back(matrix.llt().solve(Eigen::MatrixXf::Identity(matrix.rows(), matrix.cols())));
    }
  }

  RowMatrix times(const RowMatrix& rows) const {
    RowMatrix product(rows.rows(), rows.cols());
    for (Index t = 0; t < rows.rows(); ++t) {
      product.row(t).noalias() = rows.row(t) * inverse_[of_[static_cast<size_t>(t)]];
    }
    return product;
  }

 private:
  std::vector<Eigen::MatrixXf> inverse_;
  std::vector<size_t> of_;
};

double dot(const RowMatrix& a, const RowMatrix& b) {
  double sum = 0;
  for (Index t = 0; t < a.rows(); ++t) sum += static_cast<double>(a.row(t).dot(b.row(t)));
  return sum;
}

}  // namespace

/// Texels of a view by those that they see, so that threads do not meet and sums have one order.
struct TensorTexels::Sources {
  std::vector<uint32_t> first;   // of each texel
  std::vector<uint32_t> source;  // texels of the view
  std::vector<float> weight;
};

/// Products of functions over the views that show one texel.
class TensorTexels::OfTexel {
 public:
  OfTexel(const TensorFunctions& functions, const uint8_t* shown) : functions_(functions) {
    for (Index v = 0; v < functions.views(); ++v) {
      if (shown[v] != 0) shown_.push_back(v);
    }
    all_ = static_cast<Index>(shown_.size()) == functions.views();
    if (!all_) block_.resize(static_cast<size_t>(functions.clusters() * functions.clusters()));
  }

  Eigen::MatrixXf block(uint32_t c, uint32_t d) {
    const Index rank = functions_.rank();
    if (all_) return functions_.products().block(c * rank, d * rank, rank, rank);
    Eigen::MatrixXf& block = block_[static_cast<size_t>(c * functions_.clusters() + d)];
    if (block.size() > 0) return block;
    block = Eigen::MatrixXf::Zero(rank, rank);
    for (const Index v : shown_) block += functions_.products(v).block(c * rank, d * rank, rank, rank);
    return block;
  }

 private:
  const TensorFunctions& functions_;
  std::vector<Index> shown_;
  bool all_;
  std::vector<Eigen::MatrixXf> block_;
};

TensorTexels::TensorTexels(const TensorSource& source, size_t level, const TensorFunctions& functions,
                           const Progress& progress)
    : source_(source),
      relief_(source.relief[level]),
      functions_(functions),
      progress_(progress),
      plane_(is_plane(relief_)) {
  const auto rows = static_cast<Index>(texels());
  shows_ = RowMatrix::Zero(rows, functions.count());
  shown_.assign(texels() * source.side.view.size(), 0);
  if (plane_) return;
  data_ = RowMatrix::Zero(rows, functions.count());
  seen_.resize(shown_.size());
  for (size_t v = 0; v < source.side.view.size(); ++v) {
    pieces([&](size_t t) {
      const Vec2 place =
          (Vec2(t % relief_.width(), t / relief_.width()) + 0.5f) / Vec2(relief_.width(), relief_.height());
      seen_[v * texels() + t] = relief_.seen_texel(place, source.side.view[v]);
    });
  }
}

template <class Work>
void TensorTexels::pieces(const Work& work) const {
  parallel_pieces((texels() + kTexels - 1) / kTexels, source_.threads, progress_, [&](size_t piece) {
    for (size_t t = piece * kTexels; t < std::min(texels(), (piece + 1) * kTexels); ++t) work(t);
  });
}

BilinearTexels TensorTexels::seen(Index view, size_t texel) const {
  return bilinear_at(seen_[static_cast<size_t>(view) * texels() + texel], relief_.width(), relief_.height());
}

TensorTexels::Sources TensorTexels::sources(Index view) const {
  Sources sources;
  sources.first.resize(texels() + 1);
  std::vector<BilinearTexels> at;
  for (size_t t = 0; t < texels(); ++t) {
    at.push_back(seen(view, t));
    for (const uint32_t i : at.back().index) ++sources.first[i + 1];
  }
  std::partial_sum(sources.first.begin(), sources.first.end(), sources.first.begin());
  sources.source.resize(4 * texels());
  sources.weight.resize(4 * texels());
  std::vector<uint32_t> next = sources.first;
  for (uint32_t t = 0; t < at.size(); ++t) {
    for (size_t i = 0; i < 4; ++i) {
      const uint32_t to = next[at[t].index[i]]++;
      sources.source[to] = t;
      sources.weight[to] = at[t].weight[i];
    }
  }
  return sources;
}

void TensorTexels::add_view(Index view, const LevelImages& images, const TensorFunctions::OfView& functions) {
  RowMatrix moments(shows_.rows(), shows_.cols());
  parallel_pieces((texels() + kTexels - 1) / kTexels, source_.threads, progress_, [&](size_t piece) {
    const auto first = static_cast<Index>(piece * kTexels);
    auto rows = moments.middleRows(first, std::min<Index>(kTexels, moments.rows() - first));
    rows.setZero();
    for (size_t a = 0; a < 3; ++a) {
      rows.noalias() += images.value[a].middleRows(first, rows.rows()) * functions[a].transpose();
    }
  });
  std::vector<uint32_t> all(texels());
  std::iota(all.begin(), all.end(), 0u);
  const auto shown = shown_texels(relief_, all, source_.side.view[static_cast<size_t>(view)], tile_aspect(source_.grid),
                                  source_.threads, progress_);
  pieces([&](size_t t) {
    if (!shown[t].shown) return;
    shows_.row(static_cast<Index>(t)) += blended(moments, shown[t].at);
    shown_[t * source_.side.view.size() + static_cast<size_t>(view)] = 1;
  });
  const float cosine = source_.side.view[static_cast<size_t>(view)].z;
  for (size_t l = 0; l < source_.side.light.size(); ++l) {
    for (const RowMatrix& image : images.value) {
      const float square = image.col(static_cast<Index>(l)).squaredNorm();
      measured_ += static_cast<double>(cosine * source_.side.light[l].z * square);
    }
  }
  if (plane_) return;
  const Sources from = sources(view);
  pieces([&](size_t t) {
    for (uint32_t i = from.first[t]; i < from.first[t + 1]; ++i) {
      data_.row(static_cast<Index>(t)) += from.weight[i] * moments.row(from.source[i]);
    }
  });
}

TensorTexelValues TensorTexels::solve(Index members, const std::function<void(double)>& after_step) const {
  TensorTexelValues values{std::vector<uint32_t>(texels() * static_cast<size_t>(members)),
                           RowMatrix(shows_.rows(), members * functions_.rank())};
  pieces([&](size_t t) { choose(t, values); });
  after_step(plane_ ? 1.0 : 0.2);
  if (!plane_) refine(values, [&](double part) { after_step(0.2 + 0.8 * part); });
  return values;
}

/// Cluster after cluster the one that explains most of what is left, all coefficients solved for anew with each.
void TensorTexels::choose(size_t texel, TensorTexelValues& values) const {
  const Index rank = functions_.rank();
  const auto members = values.value.cols() / rank;
  OfTexel of(functions_, shown_.data() + texel * source_.side.view.size());
  const auto moments = shows_.row(static_cast<Index>(texel));
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
      own.diagonal().array() += kRidge;
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
    matrix.diagonal().array() += kRidge;
    solution = matrix.llt().solve(right);
  }
  std::copy(chosen.begin(), chosen.end(), values.member.begin() + static_cast<ptrdiff_t>(texel * chosen.size()));
  values.value.row(static_cast<Index>(texel)) = solution.transpose();
}

/// What texels first ... end - 1 of a view see: texel x function.
RowMatrix TensorTexels::spread(Index view, size_t first, size_t end, const TensorTexelValues& values) const {
  const Index rank = functions_.rank();
  const size_t members = values.member.size() / texels();
  RowMatrix spread = RowMatrix::Zero(static_cast<Index>(end - first), functions_.count());
  const auto add = [&](size_t t, uint32_t from, float weight) {
    for (size_t k = 0; k < members; ++k) {
      spread.row(static_cast<Index>(t - first)).segment(values.member[from * members + k] * rank, rank) +=
          weight * values.value.row(from).segment(static_cast<Index>(k) * rank, rank);
    }
  };
  for (size_t t = first; t < end; ++t) {
    if (plane_) {
      add(t, static_cast<uint32_t>(t), 1);
      continue;
    }
    const BilinearTexels at = seen(view, t);
    for (size_t i = 0; i < 4; ++i) add(t, at.index[i], at.weight[i]);
  }
  return spread;
}

void TensorTexels::add_products(Index view, const TensorTexelValues& values, RowMatrix& sums) const {
  RowMatrix moments(shows_.rows(), shows_.cols());
  parallel_pieces((texels() + kTexels - 1) / kTexels, source_.threads, progress_, [&](size_t piece) {
    const size_t first = piece * kTexels, end = std::min(texels(), first + kTexels);
    moments.middleRows(static_cast<Index>(first), static_cast<Index>(end - first)).noalias() =
        spread(view, first, end, values) * functions_.products(view);
  });
  const Index rank = functions_.rank();
  const size_t members = values.member.size() / texels();
  const Sources from = sources(view);
  pieces([&](size_t t) {
    for (uint32_t i = from.first[t]; i < from.first[t + 1]; ++i) {
      for (size_t k = 0; k < members; ++k) {
        sums.row(static_cast<Index>(t)).segment(static_cast<Index>(k) * rank, rank) +=
            from.weight[i] * moments.row(from.source[i]).segment(values.member[t * members + k] * rank, rank);
      }
    }
  });
}

RowMatrix TensorTexels::normal_product(const TensorTexelValues& values) const {
  RowMatrix product = kRidge * values.value;
  for (Index v = 0; v < functions_.views(); ++v) {
    progress_.check();
    add_products(v, values, product);
  }
  return product;
}

void TensorTexels::refine(TensorTexelValues& values, const std::function<void(double)>& after_step) const {
  const MemberInverses inverse(functions_, values, texels());
  const Index rank = functions_.rank();
  const size_t members = values.member.size() / texels();
  RowMatrix rest = -normal_product(values);
  for (size_t t = 0; t < texels(); ++t) {
    for (size_t k = 0; k < members; ++k) {
      rest.row(static_cast<Index>(t)).segment(static_cast<Index>(k) * rank, rank) +=
          data_.row(static_cast<Index>(t)).segment(values.member[t * members + k] * rank, rank);
    }
  }
  RowMatrix turned = inverse.times(rest);
  TensorTexelValues direction{values.member, turned};
  double energy = dot(rest, turned);
  const double settled = kSettled * energy;
  for (int step = 0; step < kSteps && energy > settled; ++step) {
    const RowMatrix product = normal_product(direction);
    const auto length = static_cast<float>(energy / dot(direction.value, product));
    values.value += length * direction.value;
    rest -= length * product;
    turned = inverse.times(rest);
    const double now = dot(rest, turned);
    direction.value = turned + static_cast<float>(now / energy) * direction.value;
    energy = now;
    after_step(static_cast<double>(step + 1) / kSteps);
  }
}

double TensorTexels::modelled(const TensorTexelValues& values) const {
  Eigen::VectorXf cosine(static_cast<Index>(source_.side.light.size()));
  for (Index l = 0; l < cosine.size(); ++l) cosine[l] = source_.side.light[static_cast<size_t>(l)].z;
  double sum = 0;
  for (Index v = 0; v < functions_.views(); ++v) {
    const RowMatrix products = functions_.weighed_products(v, cosine);
    std::vector<double> part((texels() + kTexels - 1) / kTexels);
    parallel_pieces(part.size(), source_.threads, progress_, [&](size_t piece) {
      const size_t first = piece * kTexels, end = std::min(texels(), first + kTexels);
      const RowMatrix rows = spread(v, first, end, values);
      part[piece] = dot(rows, rows * products);
    });
    sum += static_cast<double>(source_.side.view[static_cast<size_t>(v)].z) *
           std::accumulate(part.begin(), part.end(), 0.0);
  }
  return sum;
}

}  // namespace velour
