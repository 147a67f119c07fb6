"""Checks whether the dissertation's own reference, uniform samples of the measurement, agrees with ours."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import silhouette
import uniform_moments
from agreement import Agreement, agreement
from figure_scenes import Subject
from reference import FIRST_SEED, Reference
from renders import Renders
from scenes import Scene
from uniform_check import UniformAgreement, uniform_agreement

TOO_BRIGHT = 1.02  # factor of the control, which must be refused
# Independent samples, one direction per camera ray: the variance is known only for independent samples.
UNIFORM = {"strategy": "uniform", "sequence": "random", "split": 1}


@dataclass(frozen=True)
class Check:
    """Results of comparisons with `product`."""

    subject: Subject
    uniform: UniformAgreement
    control: UniformAgreement  # uniform, with `product` too bright
    by_spread: Agreement  # uniform, with error bars from the spread of its renders
    mis: Agreement
    moment_error: float  # median over the pixels of the relative standard error of the second moment
    worst_moment_error: float


def announce(renders: Renders, extent) -> None:
    size, batches = extent.check_size, extent.check_batches
    renders.expect(extent.uniform_spp // batches, size, batches)
    renders.expect(extent.check_spp, size, 2 * batches)


def check(subject: Subject, scene: Scene, renders: Renders, extent) -> Check:
    """`scene`: evaluates the measurement itself."""
    size, batches = {"size": extent.check_size}, extent.check_batches

    def stack(spp: int, number: int, **strategy) -> np.ndarray:
        seed = number * FIRST_SEED
        return Reference(renders, scene, spp, seed, **strategy, **size).add(batches).stack()

    product = stack(extent.check_spp, 3, strategy="product")
    mis = stack(extent.check_spp, 4, strategy="mis")
    uniform = stack(extent.uniform_spp // batches, 2, **UNIFORM)
    where = silhouette.of(scene, renders, extent.check_size)
    found = uniform_moments.of(
        scene, renders, extent.check_size, extent.moment_rays, range(1, 1 + extent.moment_runs)
    )

    def verdict(brightness: float) -> UniformAgreement:
        samples = batches * (extent.uniform_spp // batches)
        mean = uniform.mean(axis=0)
        return uniform_agreement(mean, brightness * product, where, found.moments, samples)

    return Check(
        subject,
        verdict(1.0),
        verdict(TOO_BRIGHT),
        agreement(uniform, product, where),
        agreement(mis, product, where),
        float(np.median(found.error[where])),
        float(found.error[where].max()),
    )
