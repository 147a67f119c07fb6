"""The judge of pictures: how often it is wrong, what it sees, and what it does without error bars."""

from __future__ import annotations

import numpy as np
import pytest
from support import judge

SIZE = (48, 64, 3)
RUNS = 60
LIMIT = judge.z_limit(12 * 3)  # a level of FAMILY_ERROR for each picture
_TRUTH = np.random.default_rng(1).uniform(0.1, 1.0, SIZE)
_SPREAD = _TRUTH * np.random.default_rng(2).uniform(0.0, 0.1, SIZE)


def renders(count, seed, noise=1.0, gain=1.0):
    """Renders of a picture. The noise of a pixel is up to a tenth of its value, and almost none in some."""
    random = np.random.default_rng(seed)
    return gain * (_TRUTH + noise * _SPREAD * random.standard_normal((count, *SIZE)))


def verdicts(reference, **settings):
    """Verdicts on RUNS sets of four renders, each with its estimate, against `reference(seed, estimate)`."""
    for seed in range(RUNS):
        ours = judge.estimate(renders(4, seed, **settings))
        yield judge.judge(ours, reference(seed, ours), LIMIT), ours


@pytest.fixture(scope="module")
def known():
    """A reference with errors, of more samples."""
    found = judge.estimate(renders(16, 1000, noise=0.5))
    return lambda seed, ours: found


def single(noise):
    """One picture, whose errors nobody wrote down."""
    return lambda seed, ours: judge.estimate_single(renders(1, 2000 + seed, noise)[0], ours)


def test_chance_seldom_fails(known):
    # 60 pictures at a level of 0.001 each: two false alarms would be one in 600.
    assert sum(not verdict.agrees for verdict, _ in verdicts(known)) <= 1


@pytest.mark.parametrize("noise", [0.25, 1.0, 3.0])
def test_chance_seldom_fails_without_known_errors(noise):
    assert sum(not verdict.agrees for verdict, _ in verdicts(single(noise))) <= 1


def test_z_is_as_large_as_its_error_bars_say(known):
    rms = [verdict.rms for verdict, _ in verdicts(known)]
    assert np.mean(rms) == pytest.approx(1.0, abs=0.05)


def test_one_percent_fails(known):
    assert not any(verdict.agrees for verdict, _ in verdicts(known, gain=1.01))


def test_one_percent_fails_without_known_errors():
    """By the picture as a whole: it counts as no less noisy than a render, however clean it is."""
    reference = single(0.25)
    for seed in range(RUNS):
        ours = judge.estimate(renders(4, seed, gain=1.01))
        assert not judge.judge(ours, reference(seed, ours), LIMIT, judge.WHOLE).agrees


def test_error_bars_that_are_too_small_fail():
    """The control: a reference said to be exact, which is as noisy as a render."""
    exact = lambda seed, ours: judge.Estimate(renders(1, 2000 + seed)[0], 0 * ours.variance, 4)  # noqa: E731
    assert sum(not verdict.agrees for verdict, _ in verdicts(exact)) > RUNS / 2


def test_shift_of_one_block_is_found():
    reference = judge.estimate(renders(16, 1))
    ours = renders(4, 2)
    ours[:, 16:32, 32:48] *= 1.05
    verdict = judge.judge(judge.estimate(ours), reference, LIMIT)
    assert not verdict.agrees
    assert verdict.block[:2] == (2, 1)
    assert 4 < verdict.percent < 6


@pytest.mark.parametrize("difference", [0.0, 1e-6, 0.01])
def test_pictures_without_noise(difference):
    flat = judge.Estimate(np.full(SIZE, 0.5), np.zeros(SIZE), 4)
    ours = judge.estimate(np.full((4, *SIZE), 0.5 * (1 + difference)))
    for reference in (flat, judge.estimate_single(flat.mean, ours)):
        assert judge.judge(ours, reference, LIMIT).agrees == (difference < 0.001)


def test_half_floats_are_known_by_their_values():
    picture = np.full(SIZE, 0.30015)  # 8e-5 beside a half float
    ours = judge.estimate(np.broadcast_to(picture, (4, *SIZE)))
    half = picture.astype(np.float16).astype(np.float64)
    assert abs(half - picture).max() > 5 * judge.ROUNDING
    assert judge.judge(ours, judge.estimate_single(half, ours), LIMIT).agrees
    assert not judge.judge(ours, judge.estimate_single(half * 1.01, ours), LIMIT).agrees


def test_median_of_students_t_squared():
    # Squares of the quantile of 3/4, from tables.
    for freedom, median in ((1, 1.0), (3, 0.5851), (15, 0.4778), (10_000, 0.4549)):
        assert judge.student_median_sq(freedom) == pytest.approx(median, rel=0.04)


def test_limit_bounds_the_family():
    # 1e-3 / 36 two-sided, from tables: 4.19 standard errors.
    assert judge.z_limit(36) == pytest.approx(4.19, abs=0.01)


def test_what_half_of_the_blocks_see_is_refused(known):
    """In 99 of 100 cases; a fifth of it is not (the control)."""
    sees = next(verdicts(known))[0].sees
    assert sum(verdict.agrees for verdict, _ in verdicts(known, gain=1 + sees / 100)) <= 2
    assert sum(verdict.agrees for verdict, _ in verdicts(known, gain=1 + sees / 500)) > RUNS / 2
