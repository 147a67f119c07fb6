"""Judges a night: for each target whether it is met, and a sentence that says so if it is not."""

from __future__ import annotations

import statistics

from .. import page
from .still import ROUNDING
from .trouble import REFUSALS

MEMORY_GROWTH = 0.02
FLICKER = 1.1
FEWEST_FOR_RESIDENT, FEWEST_FOR_PEAK = 100, 300  # frames


def judge(found: dict) -> list[dict]:
    night, frames = found["farm"], found["frames"]
    return [
        *_frames(night, frames, found["unbroken"]["digests"]),
        _threads(found["unbroken"]["digests"], found["threads"]["digests"]),
        *_farm(night),
        _wrong_nodes(night),
        *_memory(found["unbroken"]["rows"]),
        *_flicker(found["noise"]),
        _still(found["still"]),
    ]


def _judged(name: str, target: str, measured: str, met: bool | None, sentence: str) -> dict:
    return page.judged(target, "", measured, met) | {"name": name, "sentence": sentence}


def _frames(night: dict, frames: int, unbroken: dict[str, str]) -> list[dict]:
    expected, there = set(range(1, frames + 1)), {int(number) for number in night["frames"]}
    wrong = sorted(expected ^ there)
    wrong += [int(number) for number, each in night["frames"].items() if each["says"] != int(number)]
    other = [
        number for number, each in night["frames"].items() if each["digest"] != unbroken.get(str(number))
    ]
    return [
        _judged(
            "every_frame_once",
            "every frame is there once",
            f"{len(there)} of {frames}",
            not wrong and night["done"],
            f"frames are missing or not what they say: {wrong}; --status says: {night['status']}",
        ),
        _judged(
            "same_bits",
            "each has the bits of an unbroken run",
            f"{len(there) - len(other)} of {frames}",
            not other and bool(there),
            f"frames differ from those of an unbroken run: {', '.join(other)}",
        ),
        _judged(
            "nothing_half_written",
            "no parts, failures or temporary files are left",
            f"{len(night['leftovers'])} files",
            not night["leftovers"],
            f"files are left of frames that are done: {', '.join(night['leftovers'])}",
        ),
    ]


def _threads(one: dict[str, str], several: dict[str, str]) -> dict:
    other = [number for number, digest in several.items() if digest != one.get(number)]
    return _judged(
        "same_bits_any_threads",
        "frames have the same bits for any number of threads",
        f"{len(several) - len(other)} of {len(several)}",
        not other and bool(several),
        f"frames differ with another number of threads: {', '.join(other)}",
    )


def _farm(night: dict) -> list[dict]:
    missed = night["planned"] - len(night["events"])
    return [
        _judged(
            "no_job_waits",
            "no job waits for ever",
            "none" if not night["waits"] else night["waits"].replace("\n", ", "),
            not night["waits"],
            f"jobs wait for ever: {night['waits']}",
        ),
        _judged(
            "all_trouble_happened",
            "all planned trouble happened",
            f"{len(night['events'])} of {night['planned']}",
            missed == 0,
            f"{missed} of the planned events did not happen, so the night proves less than it should",
        ),
    ]


def _wrong_nodes(night: dict) -> dict:
    """That the same bits came out proves nothing if no such node was asked."""
    failed = [line for each in night["submissions"] for line in each["failed"]]
    counts = {kind: sum(words in line for line in failed) for kind, words in REFUSALS.items()}
    missed = [kind for kind, count in counts.items() if not count]
    return _judged(
        "wrong_nodes_refused",
        "frames of nodes with a wrong Velour fail, with a message that says so",
        ", ".join(f"{kind}: {count}" for kind, count in counts.items()),
        not missed,
        f"no frame failed that says why: {', '.join(missed)}",
    )


def _memory(rows: list[dict]) -> list[dict]:
    """The median of the resident memory, which varies by some per cent between frames, and the peak, which
    such chance still raises in the first tenth of a short run."""
    tenth = len(rows) // 10
    first, last = rows[:tenth], rows[-tenth:]
    resident = peak = None
    if len(rows) >= FEWEST_FOR_RESIDENT:
        resident = _median(last) / _median(first) - 1
    if len(rows) >= FEWEST_FOR_PEAK:
        peak = last[-1]["peak"] / first[-1]["peak"] - 1
    return [
        _grown("memory_resident", "resident memory of one process", resident),
        _grown("memory_peak", "peak memory of one process", peak),
    ]


def _median(rows: list[dict]) -> float:
    return statistics.median(row["mib"] for row in rows)


def _grown(name: str, what: str, grown: float | None) -> dict:
    target = f"{what} grows by less than {MEMORY_GROWTH:.0%} from its first tenth to its last"
    if grown is None:
        return _judged(name, target, "the run is too short", None, "")
    return _judged(name, target, f"{grown:.2%}", grown < MEMORY_GROWTH, f"{what} grew by {grown:.2%}")


def _flicker(noise: dict) -> list[dict]:
    found = []
    for kind, name in (("seed per frame", "flicker_seed_per_frame"), ("fixed seed", "flicker_fixed_seed")):
        ratio = noise[kind] / noise["independent"]
        target = f"flicker of what does not move, {kind}: at most {FLICKER} of independent noise"
        sentence = f"what does not move flickers {ratio:.3f} times as much as independent noise ({kind})"
        found.append(_judged(name, target, f"{ratio:.3f}", ratio <= FLICKER, sentence))
    return found


def _still(still: dict) -> dict:
    return _judged(
        "still",
        f"a still in {still['parts']} parts equals a single run within {ROUNDING:g} of its brightest value",
        f"{still['difference']:.1e}",
        still["difference"] <= ROUNDING,
        f"the merged still differs from the single run by {still['difference']:.1e} of its brightest value",
    )
