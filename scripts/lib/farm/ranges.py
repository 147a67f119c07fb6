"""Frame numbers as text: "1-10,15,20-30:2" is 1 to 10, 15, and every second one from 20 to 30."""

from __future__ import annotations

import re

LAST = 1048574  # of Blender


def parse(text: str) -> list[int]:
    """Ascending, each once; raises ValueError with a sentence."""
    found = set()
    for part in text.split(","):
        match = re.fullmatch(r"\s*(\d+)(?:\s*-\s*(\d+)(?::(\d+))?)?\s*", part)
        if not match:
            raise ValueError(f"{part.strip()!r} is no frame, nor a range such as 1-10 or 1-10:2")
        first, last = int(match[1]), int(match[2] or match[1])
        step = int(match[3] or 1)
        if last < first or last > LAST or step < 1:
            raise ValueError(f"{part.strip()!r} holds no frame that Blender has")
        found.update(range(first, last + 1, step))
    return sorted(found)


def words(numbers: list[int]) -> str:
    """As short as may be without steps, which not every engine knows."""
    runs: list[list[int]] = []
    for number in sorted(numbers):
        if runs and number == runs[-1][1] + 1:
            runs[-1][1] = number
        else:
            runs.append([number, number])
    return ",".join(f"{a}" if a == b else f"{a}-{b}" for a, b in runs)
