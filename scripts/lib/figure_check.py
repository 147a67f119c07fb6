"""Does the dissertation's own reference, uniform samples of the measurement, agree with ours?"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import silhouette
from agreement import Agreement, agreement
from reference import FIRST_SEED, Reference
from renders import Renders
from scenes import Scene


@dataclass(frozen=True)
class Check:
    """Each of them against `product`."""

    uniform: Agreement
    mis: Agreement
    control: Agreement  # uniform, with `product` a hundredth too bright: must not hold


def check(renders: Renders, measured: Scene, extent) -> Check:
    size, batches = {"size": extent.check_size}, extent.check_batches

    def stack(spp: int, number: int, strategy: str) -> np.ndarray:
        seed = number * FIRST_SEED
        return Reference(renders, measured, spp, seed, strategy=strategy, **size).add(batches).stack()

    uniform = stack(extent.uniform_spp // batches, 2, "uniform")
    product = stack(extent.check_spp, 3, "product")
    mis = stack(extent.check_spp, 4, "mis")
    where = silhouette.of(measured, renders, extent.check_size)
    return Check(
        agreement(uniform, product, where),
        agreement(mis, product, where),
        agreement(uniform, 1.01 * product, where),
    )
