"""Writes docs/results/figures/check.md: whether uniform samples of measurements agree with references."""

from __future__ import annotations

from pathlib import Path

import provenance
from agreement import LEVEL
from figure_check import TOO_BRIGHT, Check
from markdown_table import small, table
from velour.core import files


def write(folder: Path, checks: list[Check], conditions: dict, extent) -> None:
    files.write_text(folder / "check.md", _page(checks, conditions, extent))


def _page(checks: list[Check], conditions: dict, extent) -> str:
    columns, rows = extent.check_size
    control = f"{TOO_BRIGHT - 1:.0%} too bright"
    return f"""# The dissertation's reference

Written by `scripts/figures --check`.
{provenance.sentence(conditions)}

Uniform samples of the measurement, {extent.uniform_spp} a pixel at {columns}x{rows}, against
`product`, the strategy of the references ({extent.check_batches} renders of {extent.check_spp}):
luminance of each pixel that shows the object, its mean over them, and its mean with the weights that see a
common factor best (brightness over variance, known without a render). They agree where p, of the least likely
difference among so many (Sidak), is at least {LEVEL}.

A uniform sample meets the sun in the mirror once in many thousands; what then is most of a pixel comes from
a few samples or, in a render that missed them, is not there. So the spread of some renders says too little
about their error. Instead:

- Each of the samples is on its own: one direction a camera ray, independent random numbers (`--split 1
  --sequence random`). With Sobol points, or more directions a ray, the variance would not be known.
- First, second and third moment of one sample, and the largest, come from importance sampling, apart from all
  renders compared here: the program `uniform_moments`, directions half from the material and half from the
  sky, {extent.moment_runs} runs of {extent.moment_rays} camera rays a pixel. They give each pixel's variance.
- Few rare events do not add up to a normal distribution. p is a bound that holds for any with these moments:
  Bennett's inequality with one moment more (`scripts/lib/tail_bound.py`). The error of `product`, from the
  spread of its renders, counts as normal. The bound is never too small; where the distribution is normal, it
  is about ten times too large.

The definition was fixed before any of these results was seen. z: difference over true error bar; where
rare events are few, Sidak's bound does not hold for it. Seen: what relative bias is refused in 99 of 100
cases, of all pixels alike, and of one pixel alone (median). Control: `product` {control}, which must be
refused.

{_uniform(checks)}
Are the error bars right? How well the second moment of a pixel is known, as relative standard error; and how
much z varies over the pixels: by 1, if they are.

{_moments(checks)}
By the spread of {extent.check_batches} renders instead (Welch's test): `uniform`, whose error bars are too
short, and `mis` against `product`, {extent.check_batches} renders of {extent.check_spp} each, which meets no
rare events.

{_by_spread(checks)}"""


def _uniform(checks: list[Check]) -> str:
    header = ["figure", "pair", "tests", "largest z", "Sidak's bound", "p", "ratio of means", "agree"]
    header += ["seen in all", "seen in a pixel"]
    rows = []
    for found in checks:
        for pair, a in (("uniform", found.uniform), ("control", found.control)):
            seen = [f"{a.factor_seen:.2%}", f"{a.pixel_bias_seen:.1%}"]
            rows.append([_name(found), pair, *_numbers(a), *seen])
    return table(header, rows)


def _moments(checks: list[Check]) -> str:
    rows = [
        [_name(c), small(c.moment_error), small(c.worst_moment_error), f"{c.uniform.spread_of_z:.3f}"]
        for c in checks
    ]
    return table(["figure", "second moment's error, median", "worst", "standard deviation of z"], rows)


def _by_spread(checks: list[Check]) -> str:
    header = ["figure", "pair", "tests", "largest z", "Sidak's bound", "p", "ratio of means", "agree"]
    rows = []
    for found in checks:
        for pair, a in (("uniform", found.by_spread), ("mis", found.mis)):
            rows.append([_name(found), pair, *_numbers(a)])
    return table(header, rows)


def _numbers(a) -> list:
    bounds = [f"{a.largest_z:.2f}", f"{a.sidak_z:.2f}", f"{a.p_value:.2g}", f"{a.ratio:.5f}"]
    return [a.tests, *bounds, "yes" if a.holds else "no"]


def _name(found: Check) -> str:
    return f"{found.subject.figure} {found.subject.name}"
