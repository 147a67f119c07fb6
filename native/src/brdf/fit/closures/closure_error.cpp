#include "brdf/fit/closures/closure_error.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include "base/parallel.h"
#include "brdf/measure/held_out.h"

namespace velour {

namespace {

constexpr int kJudgedLights = 1024, kAlbedoLights = 512, kLastMeanView = 75;

/// Relative root of a sum of squares; a black reference gives 0 for a black model and 1 for any other.
double relative_root(double error_sq, double reference_sq) {
  return reference_sq > 0 ? std::sqrt(error_sq / reference_sq) : (error_sq > 0 ? 1.0 : 0.0);
}

/// Error of `values` (rows per channel, times root_weight) against all azimuths.
ClosureViewError error_of(const std::vector<ClosureTarget>& azimuths, int degrees, const AlignedArray<float>& values) {
  const size_t row = azimuths[0].lights.padded();
  double error_sq = 0, reference_sq = 0, luminance_error_sq = 0, luminance_sq = 0, root_error_sq = 0, root_sq = 0;
  for (const ClosureTarget& target : azimuths) {
    const float* root_weight = target.lights.root_weight();
    for (size_t i = 0; i < row; ++i) {
      const Rgb difference(values.data()[i] - target.channel(0)[i], values.data()[row + i] - target.channel(1)[i],
                           values.data()[2 * row + i] - target.channel(2)[i]);
      error_sq += static_cast<double>(glm::dot(difference, difference));
      luminance_error_sq += static_cast<double>(luminance(difference) * luminance(difference));
      for (int c = 0; c < 3; ++c) {  // the weight times the squared difference of roots
        const float source = target.channel(c)[i], model = values.data()[static_cast<size_t>(c) * row + i];
        const float root = std::sqrt(model) - std::sqrt(source);
        root_error_sq += static_cast<double>(root_weight[i] * root * root);
        root_sq += static_cast<double>(root_weight[i] * source);
      }
    }
    reference_sq += target.norm_sq.r + target.norm_sq.g + target.norm_sq.b;
    luminance_sq += target.norm_sq_luminance;
  }
  return {degrees, relative_root(luminance_error_sq, luminance_sq), relative_root(error_sq, reference_sq),
          relative_root(root_error_sq, root_sq)};
}

AlignedArray<float> mean_values(const std::vector<ClosureTarget>& azimuths) {
  AlignedArray<float> mean = aligned_zeros(azimuths[0].values.size());
  const float share = 1 / static_cast<float>(azimuths.size());
  for (const ClosureTarget& target : azimuths) {
    for (size_t i = 0; i < mean.size(); ++i) mean.data()[i] += share * target.values.data()[i];
  }
  return mean;
}

}  // namespace

ClosureJudge::ClosureJudge(const ClosureSource& source, const HighlightWidths& widths, int threads,
                           const Progress& progress)
    : views_(kHeldOutViews.size()) {
  parallel_pieces(views_.size(), threads, progress, [&](size_t v) {
    const float theta_v = radians_from(static_cast<float>(kHeldOutViews[v]));
    for (const ClosureSource& azimuth : closure_azimuths(source)) {
      views_[v].push_back(closure_target(azimuth, widths, theta_v, kJudgedLights));
    }
  });
}

std::vector<ClosureViewError> ClosureJudge::errors(const ClosureNetwork& network, LobeMasking masking) const {
  std::vector<ClosureViewError> errors;
  for (size_t v = 0; v < views_.size(); ++v) {
    errors.push_back(error_of(views_[v], kHeldOutViews[v], closure_values(network, masking, views_[v][0].lights)));
  }
  return errors;
}

std::vector<ClosureViewError> ClosureJudge::errors_of_mean() const {
  std::vector<ClosureViewError> errors;
  for (size_t v = 0; v < views_.size(); ++v) {
    errors.push_back(error_of(views_[v], kHeldOutViews[v], mean_values(views_[v])));
  }
  return errors;
}

namespace {

/// Mean of `error_at` over the views up to 75 degrees.
double mean_up_to_75(const std::vector<ClosureViewError>& errors, const auto& error_at) {
  double sum = 0;
  int count = 0;
  for (const ClosureViewError& e : errors) {
    if (e.degrees > kLastMeanView) continue;
    sum += error_at(e);
    ++count;
  }
  return sum / count;
}

}  // namespace

double mean_closure_error(const std::vector<ClosureViewError>& errors) {
  return mean_up_to_75(errors, [](const ClosureViewError& e) { return e.luminance; });
}

double visible_closure_error(const std::vector<ClosureViewError>& errors) {
  return mean_up_to_75(errors, [](const ClosureViewError& e) { return 0.5 * (e.luminance + e.root); });
}

ClosureAlbedo::ClosureAlbedo(const ClosureSource& source, const HighlightWidths& widths, int threads,
                             const Progress& progress) {
  std::vector<std::unique_ptr<ClosureTarget>> views(2 * kClosureSamples - 1);
  parallel_pieces(views.size(), threads, progress, [&](size_t i) {
    const float degrees = 90.0f * static_cast<float>(i) / (2 * kClosureSamples - 2);
    views[i] = std::make_unique<ClosureTarget>(
        closure_target(source, widths, radians_from(std::min(degrees, 89.5f)), kAlbedoLights));
  });
  for (auto& view : views) {
    largest_ = std::max({largest_, view->albedo.r, view->albedo.g, view->albedo.b});
    views_.push_back(std::move(*view));
  }
}

Vec3d ClosureAlbedo::albedo_of(const ClosureNetwork& network, LobeMasking masking, const ClosureTarget& view) const {
  const ClosureLights& lights = view.lights;
  const AlignedArray<float> values = closure_values(network, masking, lights);
  Vec3d sum(0);
  for (int c = 0; c < 3; ++c) {
    const float* row = values.data() + static_cast<size_t>(c) * lights.padded();
    for (size_t i = 0; i < lights.padded(); ++i) sum[c] += static_cast<double>(row[i] * lights.root_weight()[i]);
  }
  return sum;
}

void ClosureAlbedo::correct(ClosureNetwork& network, LobeMasking masking) const {
  constexpr double kSlack = 0.008, kMinShare = 0.01, kLargestGain = 1.25;
  std::vector<Vec3d> ratio(views_.size());  // albedo of the source over that of the network
  for (size_t v = 0; v < views_.size(); ++v) {
    const Vec3d model = albedo_of(network, masking, views_[v]);
    for (int c = 0; c < 3; ++c) ratio[v][c] = model[c] > 0 ? views_[v].albedo[c] / model[c] : 1;
  }
  for (size_t i = 0; i < kClosureSamples; ++i) {
    const size_t v = 2 * i;
    Rgb factor;
    for (int c = 0; c < 3; ++c) {
      // The last view, at 89.5 degrees, lies between the last two samples.
      const size_t first = v > 0 ? v - 1 : 0, last = i + 2 >= kClosureSamples ? views_.size() - 1 : v + 1;
      double most = ratio[v][c];
      for (size_t near = first; near <= last; ++near) most = std::min(most, ratio[near][c]);
      const bool dark = views_[v].albedo[c] < kMinShare * largest_;
      const double least = dark ? 0 : std::min(ratio[v][c] * (1 - kSlack), kLargestGain);
      factor[c] = static_cast<float>(std::min(std::max(1.0, least), most * (1 + kSlack)));
    }
    network.diffuse[i] *= factor;
    for (ClosureLobe& lobe : network.lobes) lobe.weight[i] *= factor;
  }
}

double ClosureAlbedo::largest_excess(const ClosureNetwork& network, LobeMasking masking) const {
  double excess = 0;
  for (const ClosureTarget& view : views_) {
    const Vec3d model = albedo_of(network, masking, view);
    for (int c = 0; c < 3; ++c) {
      if (view.albedo[c] > 1e-4 * largest_) excess = std::max(excess, model[c] / view.albedo[c] - 1);
    }
  }
  return excess;
}

}  // namespace velour
