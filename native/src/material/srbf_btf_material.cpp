#include "material/srbf_btf_material.h"

#include "btf/srbf_evaluator.h"
#include "material/sided_btf_material.h"

namespace velour {

std::shared_ptr<const Material> make_srbf_btf_material(std::shared_ptr<const SrbfBtf> btf, BtfLight light) {
  return std::make_shared<SidedBtfMaterial<SrbfEvaluator, &PreparedBrdf::srbf>>(std::move(btf), light);
}

}  // namespace velour
