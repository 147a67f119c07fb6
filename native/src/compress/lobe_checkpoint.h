// Lobe orders and lobes in a fit's checkpoint, validated when read.
#pragma once

#include "compress/fit_checkpoint.h"
#include "compress/lobe_order.h"

namespace velour {

struct SharedLobes;

std::optional<LobeOrder> kept_order(const FitCheckpoint& checkpoint, const std::string& stage);
void keep_order(FitCheckpoint& checkpoint, const std::string& stage, const LobeOrder& order);

/// Restores refined lobes into `lobes`, which are chosen but not refined; returns false if none are stored.
bool take_kept_lobes(const FitCheckpoint& checkpoint, const std::string& stage, SharedLobes& lobes);
void keep_lobes(FitCheckpoint& checkpoint, const std::string& stage, const SharedLobes& lobes);

}  // namespace velour
