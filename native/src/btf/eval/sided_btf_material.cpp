#include "btf/eval/sided_btf_material.h"

#include "btf/model/srbf_evaluator.h"
#include "btf/model/tensor_evaluator.h"

namespace velour {

std::shared_ptr<const Material> make_srbf_btf_material(std::shared_ptr<const SrbfBtf> btf, BtfLight light) {
  return std::make_shared<SidedBtfMaterial<SrbfEvaluator, &PreparedBrdf::srbf>>(std::move(btf), light);
}

std::shared_ptr<const Material> make_tensor_btf_material(std::shared_ptr<const TensorBtf> btf, BtfLight light) {
  return std::make_shared<SidedBtfMaterial<TensorEvaluator, &PreparedBrdf::tensor>>(std::move(btf), light);
}

}  // namespace velour
