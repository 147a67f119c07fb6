#include "material/tensor_btf_material.h"

#include "btf/tensor_evaluator.h"
#include "material/sided_btf_material.h"

namespace velour {

std::shared_ptr<const Material> make_tensor_btf_material(std::shared_ptr<const TensorBtf> btf, BtfLight light) {
  return std::make_shared<SidedBtfMaterial<TensorEvaluator, &PreparedBrdf::tensor>>(std::move(btf), light);
}

}  // namespace velour
