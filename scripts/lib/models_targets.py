"""The target of the error at each view, and how many views meet it."""

from __future__ import annotations

from collections.abc import Mapping

ANGLES = ("5", "30", "60", "75", "85")


def target(angle: str, noise: float | None) -> float:
    """2 % up to 75 degrees, 4 % beyond; the measurement's own noise where that is larger."""
    return max(0.02 if int(angle) <= 75 else 0.04, noise or 0.0)


def meets(angle: str, error: float, noise: Mapping[str, float | None]) -> bool:
    return error <= target(angle, noise[angle])


def met(errors: Mapping[str, float | None], noise: Mapping[str, float | None]) -> int:
    """Number of views that meet their target."""
    return sum(meets(angle, error, noise) for angle, error in errors.items() if error is not None)


NO_NOISE = dict.fromkeys(ANGLES)
