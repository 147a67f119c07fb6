"""The check of uniform samples by their true moments: bounds, verdict, and the program that finds them."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from bench import tail_bound, velour_cli
from bench.agreement import agreement
from bench.pages import figures_check
from bench.run import Run
from bench.scenes import Scene
from bench.tail_bound import Moments, log_p_of_pixels, log_p_of_sum
from bench.uniform_check import uniform_agreement
from campaigns import run_in_this_process
from scipy import stats
from velour.core.luminance import LUMINANCE

SAMPLES = 400_000
PIXELS = (30, 40)
EXACT = np.zeros(PIXELS[0] * PIXELS[1])
EVEN = np.full(EXACT.shape, 1 / EXACT.size)


def _rare(expected: float, height: float = 30_000.0) -> tuple[Moments, np.ndarray, float]:
    """Pixels of 1 nearly everywhere, and a height that so many of the samples are expected to meet."""
    chance = np.full(EXACT.shape, expected / SAMPLES)
    powers = [1 - chance + chance * height**k for k in (1, 2, 3)]
    return Moments(*powers, np.full(EXACT.shape, height)), chance, height


def _means(chance: np.ndarray, height: float, rng, batches: int = 1) -> np.ndarray:
    """[batch, pixel]: of all samples dealt out to so many batches."""
    hits = rng.binomial(SAMPLES // batches, chance, (batches, len(chance)))
    return 1 + (height - 1) * hits * batches / SAMPLES


def test_a_normal_mean_has_nearly_its_own_tail():
    moments = Moments(*(np.array([value]) for value in (1.0, 1.5, 2.75, 4.0)))
    error = (moments.variance / SAMPLES) ** 0.5
    for z in (3.0, 5.0):
        for side in (-1, 1):
            bound = log_p_of_pixels(side * z * error, moments, SAMPLES, np.zeros(1))
            exact = np.log(2) + stats.norm.logsf(z)
            assert exact < bound < exact + np.log(15)  # Chernoff's bound, z sqrt(2 pi) times the tail


def test_a_rare_event_has_poissons_tail():
    moments, chance, height = _rare(0.05)
    two_hits = (2 - SAMPLES * chance) * (height - 1) / SAMPLES
    bound = log_p_of_pixels(two_hits, moments, SAMPLES, EXACT)[0]
    exact = stats.poisson.logsf(1, 0.05)
    assert exact + np.log(2) <= bound < exact + np.log(2 * 10)
    assert stats.norm.logsf(two_hits[0] / (moments.variance[0] / SAMPLES) ** 0.5) < exact - 20


@pytest.mark.parametrize("expected", [0.01, 0.3, 3, 100])
def test_no_level_is_exceeded(expected):
    rng = np.random.default_rng(1)
    moments, chance, height = _rare(expected)
    log_p = []
    of_mean = []
    for _ in range(20):
        d = _means(chance, height, rng)[0] - moments.mean
        log_p.append(log_p_of_pixels(d, moments, SAMPLES, EXACT))
        of_mean.append(log_p_of_sum(d.mean(), EVEN, moments, SAMPLES, EXACT))
    for level in (0.1, 0.01, 0.001):
        count = np.size(log_p)
        assert (np.array(log_p) < np.log(level)).sum() <= stats.binom.ppf(0.9999, count, level)
    assert min(of_mean) > np.log(1e-3)


def test_the_mean_is_that_of_more_samples():
    moments, _, _ = _rare(3)
    one = moments.at(slice(0, 1))
    d = 0.05
    alike = log_p_of_pixels(np.array([d]), one, SAMPLES * len(EXACT), np.zeros(1))[0]
    assert log_p_of_sum(d, EVEN, moments, SAMPLES, EXACT) == pytest.approx(alike)


def test_a_sum_of_one_pixel_is_that_pixel():
    moments, chance, height = _rare(3)
    d = _means(chance, height, np.random.default_rng(2))[0] - moments.mean
    variance = np.full(EXACT.shape, 1e-3)
    alone = np.zeros(EXACT.shape)
    alone[7] = 1.0
    expected = log_p_of_pixels(d, moments, SAMPLES, variance)[7]
    assert log_p_of_sum(d[7], alone, moments, SAMPLES, variance) == pytest.approx(expected)


def _pictures(expected: float, seed: int, height: float = 30_000.0):
    """Batches of uniform samples, another estimate that errs by a thousandth, both gray, and the moments."""
    rng = np.random.default_rng(seed)
    moments, chance, _ = _rare(expected, height)
    batches = _means(chance, height, rng, 16)
    batches += rng.normal(0, 1e-5, batches.shape)  # or Welch warns where no batch was hit
    others = moments.mean * rng.normal(1, 1e-3, (16, len(chance)))
    gray = [np.repeat(stack.reshape(16, *PIXELS, 1), 3, axis=3) for stack in (batches, others)]
    shaped = Moments(
        *(getattr(moments, name).reshape(PIXELS) for name in ("mean", "second", "third", "largest"))
    )
    return *gray, shaped


@pytest.mark.parametrize("seeds", [4, pytest.param(10, marks=pytest.mark.long)])
def test_rare_events_pass_where_the_spread_of_renders_fails(seeds):
    everywhere = np.ones(PIXELS, bool)
    spread_fails = 0
    for seed in range(seeds):
        batches, others, moments = _pictures(0.5, seed)
        found = uniform_agreement(batches.mean(axis=0), others, everywhere, moments, SAMPLES)
        assert found.holds
        assert found.tests == 1202
        assert found.spread_of_z == pytest.approx(1, abs=0.15)
        spread_fails += not agreement(batches, others, everywhere).holds
    assert spread_fails >= seeds / 2


@pytest.mark.parametrize("seeds", [3, pytest.param(20, marks=pytest.mark.long)])
def test_two_per_cent_too_bright_is_refused_as_stated(seeds):
    everywhere = np.ones(PIXELS, bool)
    refused = 0
    for seed in range(seeds):
        batches, others, moments = _pictures(30, seed, 3000)
        found = uniform_agreement(batches.mean(axis=0), others, everywhere, moments, SAMPLES)
        assert found.factor_seen < 0.02
        refused += not uniform_agreement(
            batches.mean(axis=0), others * (1 + found.factor_seen), everywhere, moments, SAMPLES
        ).holds
        assert not uniform_agreement(batches.mean(axis=0), 1.02 * others, everywhere, moments, SAMPLES).holds
    assert refused >= 0.9 * seeds


def test_one_wrong_pixel_is_refused():
    batches, others, moments = _pictures(100, 1)
    everywhere = np.ones(PIXELS, bool)
    found = uniform_agreement(batches.mean(axis=0), others, everywhere, moments, SAMPLES)
    others[:, 3, 4] *= 1 + 1.5 * found.pixel_bias_seen
    assert not uniform_agreement(batches.mean(axis=0), others, everywhere, moments, SAMPLES).holds


def test_psi_does_not_cancel():
    u = np.array([-0.0101, -0.0099, -1e-8, 1e-8, 1e-3, 0.0099, 0.0101])
    series = u**3 / 6 + u**4 / 24 + u**5 / 120
    np.testing.assert_allclose(tail_bound._psi(u), series, rtol=1e-4)
    assert tail_bound._psi(np.array(1.0)) == pytest.approx(np.e - 2.5)


# The program.

SIZE = (32, 24)
RENDERS = 8


@pytest.fixture
def scene(mesh_file, world_file, measurement_file, model_file):
    return Scene("octahedron", mesh_file, "y", world_file, measurement_file, model_file)


@pytest.fixture
def run(tmp_path, monkeypatch):
    monkeypatch.setattr(velour_cli, "_run", run_in_this_process)
    return Run("it", tmp_path / "work", tmp_path / "out", SimpleNamespace(size=SIZE))


def test_its_moments_are_those_of_uniform_renders(scene, run):
    """Under a soft sky without rare events the spread of renders is the true one."""
    if not figures_check._PROGRAM.is_file():
        pytest.skip("uniform_moments is not built")
    moments, error_of_second = figures_check.uniform_moments(run, scene, SIZE, 1024, range(1, 5))
    spp = 64
    stack = np.array(
        [
            run.render(scene, spp, seed=seed, strategy="uniform", sequence="random", split=1).pixels
            for seed in range(100, 100 + RENDERS)
        ]
    )
    luminance = stack @ LUMINANCE
    np.testing.assert_allclose(luminance.mean(), moments.mean.mean(), rtol=0.01)
    lit = moments.variance > 1e-6 * moments.second  # not the sky itself
    ratio = luminance.var(axis=0, ddof=1)[lit] / (moments.variance[lit] / spp)
    error = ratio.std() / ratio.size**0.5
    assert error < 0.05
    assert ratio.mean() == pytest.approx(1, abs=3 * error)
    assert error_of_second.max() < 0.1
    assert (moments.largest >= moments.second / moments.mean - 1e-6).all()
