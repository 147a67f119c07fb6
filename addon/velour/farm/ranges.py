"""Frame numbers as text: "1-10,15,20-30:2" is 1 to 10, 15, and every second one from 20 to 30."""

from __future__ import annotations

import argparse
import re

LAST = 1048574  # Blender's last frame


def parse(text: str) -> list[int]:
    """The frames in ascending order, without duplicates. Raises ValueError with a one-sentence message."""
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


def argument(text: str) -> list[int]:
    """parse() for an option of argparse, which shows the message."""
    try:
        return parse(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from error


def words(numbers: list[int], steps: bool = False) -> str:
    """The shortest text for the numbers. `steps`: may use steps, which not every render manager supports."""
    left, found = sorted(numbers), []
    while left:
        count, step = _run(left, steps)
        first, last = left[0], left[count - 1]
        found.append(f"{first}" if count == 1 else f"{first}-{last}" + (f":{step}" if step > 1 else ""))
        left = left[count:]
    return ",".join(found)


def _run(numbers: list[int], steps: bool) -> tuple[int, int]:
    """Length and step of the first run of equally spaced numbers. Two numbers are a run only if adjacent."""
    step = numbers[1] - numbers[0] if len(numbers) > 1 else 1
    if step > 1 and not steps:
        return 1, 1
    count = 1
    while count < len(numbers) and numbers[count] - numbers[count - 1] == step:
        count += 1
    return (count, step) if step == 1 or count > 2 else (1, 1)
