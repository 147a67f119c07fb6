#include "btf/fit/btf_compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include "base/parallel.h"
#include "btf/model/srbf_evaluator.h"
#include "btf/model/tensor_evaluator.h"

namespace velour {

namespace {

/// The sRGB curve of x in [0, 1].
float srgb(float x) { return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f; }

struct Sums {
  double squares = 0, error = 0, energy = 0, measured = 0, modelled = 0;
  double companded_error = 0, companded_energy = 0;
  uint64_t values = 0;
};

Sums compare_images(std::span<const float> truth, std::span<const float> model, const BtfJudgement& by,
                    const DirectionPair& pair) {
  Sums sums;
  const float scale = 1 / static_cast<float>(by.p99);
  const auto cosine = static_cast<double>(std::abs(pair.wl.z)), seen_cosine = static_cast<double>(std::abs(pair.wv.z));
  for (size_t i = 0; i < truth.size(); ++i) {
    if (!std::isfinite(truth[i])) continue;
    const float seen = srgb(std::clamp(truth[i] * scale, 0.0f, 1.0f)) - srgb(std::clamp(model[i] * scale, 0.0f, 1.0f));
    const double difference = (static_cast<double>(truth[i]) - static_cast<double>(model[i])) * cosine;
    const double value = static_cast<double>(truth[i]) * cosine;
    sums.squares += static_cast<double>(seen * seen);
    sums.error += difference * difference;
    sums.energy += value * value;
    const auto stored = static_cast<double>(companded(by.companding, truth[i]));
    const double off = stored - static_cast<double>(companded(by.companding, model[i]));
    sums.companded_error += off * off;
    sums.companded_energy += stored * stored;
    sums.measured += value * seen_cosine;
    sums.modelled += (value - difference) * seen_cosine;
    ++sums.values;
  }
  return sums;
}

}  // namespace

double percentile_99(const BtfMeasurement& measurement, const Progress& progress) {
  // Positive half floats are ordered like their bits.
  constexpr HalfBits kInfinity = 0x7c00, kSign = 0x8000;
  std::vector<uint64_t> count(kInfinity, 0);
  std::vector<HalfBits> values(measurement.grid().texels() * 3);
  uint64_t total = 0;
  for (uint64_t pair = 0; pair < measurement.layout().pairs(); ++pair) {
    progress.check();
    measurement.read_pairs(pair, 1, values);
    for (const HalfBits h : values) {
      if ((h & ~kSign) >= kInfinity) continue;
      ++count[(h & kSign) != 0 ? 0 : h];
      ++total;
    }
  }
  uint64_t below = 0;
  HalfBits at = 0;
  for (; at + 1 < kInfinity; ++at) {
    below += count[at];
    if (static_cast<double>(below) >= 0.99 * static_cast<double>(total)) break;
  }
  if (at == 0) {
    for (at = kInfinity - 1; at > 0 && count[at] == 0; --at) {
    }
  }
  float value = 0;
  halves_to_floats({&at, 1}, {&value, 1});
  return at == 0 ? 1.0 : static_cast<double>(value);
}

BtfErrors compare_btf(const BtfMeasurement& truth, const BtfImages& images, const BtfJudgement& by, int threads,
                      Progress& progress) {
  const uint64_t pairs = truth.layout().pairs();
  std::vector<Sums> sums(pairs);
  parallel_for_each(pairs, threads, progress, [&](size_t pair) {
    std::vector<HalfBits> halves(truth.grid().texels() * 3);
    std::vector<float> measured(halves.size()), modelled;
    truth.read_pairs(pair, 1, halves);
    halves_to_floats(halves, measured);
    const DirectionPair directions = truth.layout().directions(pair);
    images(directions, modelled);
    sums[pair] = compare_images(measured, modelled, by, directions);
  });
  Sums all;
  for (const Sums& s : sums) {
    all.squares += s.squares;
    all.error += s.error;
    all.energy += s.energy;
    all.companded_error += s.companded_error;
    all.companded_energy += s.companded_energy;
    all.measured += s.measured;
    all.modelled += s.modelled;
    all.values += s.values;
  }
  BtfErrors errors{.pairs = pairs};
  if (all.values > 0) errors.psnr = -10 * std::log10(std::max(all.squares / static_cast<double>(all.values), 1e-30));
  if (all.energy > 0) errors.ser = all.error / all.energy;
  if (all.companded_energy > 0) errors.relative_l2 = std::sqrt(all.companded_error / all.companded_energy);
  if (all.measured > 0) errors.brightness = all.modelled / all.measured;
  return errors;
}

namespace {

template <typename Images, typename Btf>
BtfImages images_by(const Btf& btf) {
  return [images = std::make_shared<const Images>(btf)](const DirectionPair& pair, std::vector<float>& rgb) {
    images->image(pair, rgb);
  };
}

BtfImages images_of_btf(const FactoredBtf& btf) { return images_by<FactoredImages>(btf); }

BtfImages images_of_btf(const SrbfBtf& btf) {
  const std::shared_ptr<const SrbfBtf> unowned(std::shared_ptr<const void>(), &btf);
  return [evaluator = std::make_shared<SrbfEvaluator>(unowned)](const DirectionPair& pair, std::vector<float>& rgb) {
    srbf_image(*evaluator, pair, rgb);
  };
}

BtfImages images_of_btf(const TensorBtf& btf) { return images_by<TensorImages>(btf); }

}  // namespace

BtfImages images_of(const ModelBody& body) {
  return with_btf(body, [](const auto& btf) { return images_of_btf(btf); });
}

}  // namespace velour
