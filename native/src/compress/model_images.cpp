#include "compress/model_images.h"

#include <memory>

#include "btf/srbf_evaluator.h"
#include "btf/tensor_images.h"

namespace velour {
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
