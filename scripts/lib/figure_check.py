"""Does the dissertation's own reference, uniform samples of the measurement, agree with ours?"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import silhouette
from agreement import Agreement, agreement, blocks
from reference import FIRST_SEED, Reference
from renders import Renders
from scenes import Scene

BLOCK = 8  # pixels


@dataclass(frozen=True)
class Check:
    """Each of them against `product`."""

    uniform: Agreement
    uniform_blocks: Agreement  # the same of blocks of BLOCK x BLOCK pixels
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
        _block_agreement(uniform, product, where),
        agreement(mis, product, where),
        agreement(uniform, 1.01 * product, where),
    )


def _block_agreement(a: np.ndarray, b: np.ndarray, where: np.ndarray) -> Agreement:
    a, b = (blocks(stack, where, BLOCK) for stack in (a, b))
    return agreement(a, b, np.ones(a.shape[1:3], bool))
