"""Targets of the chart, and whether its numbers meet them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from chart_result import DEFAULT, Result
from chart_scenes import SKY, STUDIO, SUNSET
from curve import Reading, shown
from peer_mitsuba import Comparison
from synthetic_sky import SUN_SHARE, SunLobes

# Maximum relmse of `product` relative to the default strategy at equal samples.
_EQUAL_SAMPLES = {
    ("nickel", SUNSET): 0.6,
    ("blue-metallic-paint", SUNSET): 0.4,
    ("nickel", STUDIO): 0.5,
    ("blue-metallic-paint", STUDIO): 0.5,
    ("krylon-blue", STUDIO): 0.5,
}
_MOST_GGX_ERROR = 0.2  # relative L2 above which SRBF lobes must be clearly faster


@dataclass(frozen=True)
class Verdict:
    target: str
    where: str
    measured: str
    met: bool | None  # None: not measured


def verdicts(
    results: list[Result], sun: SunLobes, mitsuba: list[Comparison] | str, spp: int
) -> list[Verdict]:
    """`spp`: the number of samples at which equal samples are compared."""
    figures = [result for result in results if result.scene.world != SKY]
    return [
        *_at_equal_samples(figures, spp),
        *_at_equal_time(figures),
        *_against_uniform(figures),
        *_against_ggx(figures),
        _sun(sun),
        *([] if isinstance(mitsuba, str) else _against_mitsuba(mitsuba)),
    ]


def _at_equal_samples(figures: list[Result], spp: int) -> Iterator[Verdict]:
    for result in figures:
        most = _EQUAL_SAMPLES.get((result.scene.material, result.scene.world))
        if most is not None:
            gain = result.gain("product", DEFAULT, spp)
            target = f"relmse of `product` / `mis` at {spp} spp at most {most}"
            yield Verdict(target, result.scene.scene.name, str(gain), gain.value <= most)


def _at_equal_time(figures: list[Result]) -> Iterator[Verdict]:
    ratios = {result.scene.scene.name: result.error_ratio("product", DEFAULT) for result in figures}
    for name, found in ratios.items():
        yield _limit("relmse of `product` / `mis` at equal time at most 1.2", name, found, 1.2)
    better = sum(found is not None and found.value < 1 for found in ratios.values())
    target = "`product` better than `mis` at equal time on at least four of six"
    yield Verdict(target, "all", f"{better} of {len(ratios)}", better >= 4)


def _against_uniform(figures: list[Result]) -> Iterator[Verdict]:
    for result in figures:
        part = 100 if result.scene.material == "nickel" else 5
        target = f"seconds of `mis` to equal error at most 1/{part} of `uniform`"
        found = result.time_ratio(DEFAULT, "uniform")
        yield _limit(target, result.scene.scene.name, found, 1 / part)


def _against_ggx(figures: list[Result]) -> Iterator[Verdict]:
    for result in figures:
        sharp = result.ggx["relative_l2"] > _MOST_GGX_ERROR
        most, words = (2 / 3, "2/3 of") if sharp else (1.0, "those of")
        target = f"seconds of `mis` to equal error at most {words} `mis-ggx`"
        found = result.time_ratio(DEFAULT, "mis-ggx")
        yield _limit(target, result.scene.scene.name, found, most)


def _sun(sun: SunLobes) -> Verdict:
    target = "the sun's lobes keep its energy within 1 % of all, no wider than twice the sun"
    measured = f"{100 * sun.energy:.1f} %, {sun.diameter:.2f} degrees"
    return Verdict(target, SKY, measured, abs(sun.energy - SUN_SHARE) <= 0.01)


def _against_mitsuba(comparisons: list[Comparison]) -> Iterator[Verdict]:
    for c in comparisons:
        found = c.speed_up()
        target = "seconds of Mitsuba to equal error over ours above 1"
        yield Verdict(target, c.material, shown(found), None if found is None else found.value > 1)
    for c in comparisons:
        target = "converged spheres of Mitsuba and ours differ by at most 1 %"
        yield Verdict(target, c.material, f"{100 * c.sphere.relative:.2f} %", c.sphere.relative <= 0.01)


def _limit(target: str, where: str, found: Reading | None, most: float) -> Verdict:
    return Verdict(target, where, shown(found), None if found is None else found.value <= most)
