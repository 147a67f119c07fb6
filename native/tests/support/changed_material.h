// Materials that change what another one gives.
#pragma once

#include <functional>
#include <memory>

#include "material/material.h"

namespace velour::test {

/// Another material with results changed by `change`, which gets the directions and what the material gave for them.
class ChangedMaterial : public Material {
 public:
  using Change = std::function<void(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf)>;

  ChangedMaterial(std::shared_ptr<const Material> material, Change change)
      : material_(std::move(material)), change_(std::move(change)) {}

  const PreparedBrdf* prepare(const Vec3& wv, const SurfaceSite& site, const PrepareOptions& options,
                              ScratchArena& arena) const override {
    return arena.make<Prepared>(*material_->prepare(wv, site, options, arena), change_);
  }
  bool varies() const override { return material_->varies(); }
  bool transmits() const override { return material_->transmits(); }
  bool isotropic() const override { return material_->isotropic(); }

 private:
  class Prepared final : public PreparedBrdf {
   public:
    Prepared(const PreparedBrdf& brdf, const Change& change) : brdf_(brdf), change_(change) {}
    void eval(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
      brdf_.eval(wl, f, pdf);
      change_(wl, f, pdf);
    }
    void sample(std::span<const Vec2> u, DirectionBatch& wl) const override { brdf_.sample(u, wl); }
    bool proposal_lobes(ProposalLobes& lobes) const override { return brdf_.proposal_lobes(lobes); }

   private:
    const PreparedBrdf& brdf_;
    const Change& change_;
  };

  std::shared_ptr<const Material> material_;
  Change change_;
};

}  // namespace velour::test
