"""scripts/parity: anybody's .blend files by Velour beside Cycles."""

from __future__ import annotations

import argparse
import os
import shutil
import sys
from pathlib import Path
from typing import NamedTuple

TESTS = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TESTS))

from regression import blender, room  # noqa: E402
from regression.case import Outcome  # noqa: E402
from regression.folder import named  # noqa: E402

STAGE = TESTS.parent / "build/release/blender"
BOUNCES = (0, 4)
ENGINES = ("CYCLES", "VELOUR")
MOST_PERCENT = 2.0  # of the picture's mean, that a block may be off
INTERRUPTED = 130


class Effort(NamedTuple):
    seeds: int
    samples: int
    width: int
    scripts: bool


def main() -> int:
    arguments = _arguments()
    try:
        with room.take(arguments.output.resolve()):
            return _run(arguments)
    except (room.RoomError, OSError) as error:
        print(f"parity: {error}", file=sys.stderr)
        return 1


def _run(arguments: argparse.Namespace) -> int:
    stage = Path(os.environ.get("VELOUR_STAGE", STAGE)).resolve()
    if arguments.blender is None or not (stage / "addons/velour").is_dir():
        missing = "There is no Blender" if arguments.blender is None else f"{stage} holds no add-on"
        print(f"parity: {missing}; install it, or run scripts/build.", file=sys.stderr)
        return 1
    blender.use_package(stage / "addons")
    installation = blender.Installation(arguments.blender, stage, arguments.timeout)
    blends = _blends(arguments.path)
    if not blends or not all(blend.is_file() for blend in blends.values()):
        print(f"parity: {arguments.path[0]} holds no .blend file; name a folder that does.", file=sys.stderr)
        return 1
    effort = Effort(arguments.seeds, arguments.samples, arguments.width, arguments.scripts)
    outcomes = []
    for number, (name, blend) in enumerate(blends.items(), 1):
        print(f"{number} of {len(blends)}: {blend}", file=sys.stderr, flush=True)
        work = arguments.output.resolve() / "work" / f"{number:03d}"
        for outcome in _judged(name, blend, installation, effort, work, 2 * len(blends)):
            print(outcome.line, flush=True)
            outcomes.append(outcome)
    return _shown(outcomes, arguments.output.resolve())


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="parity",
        description="Renders .blend files with Cycles and with Velour, direct light and four bounces, without"
        f" clamping, and says where a block of pixels differs by more than {MOST_PERCENT:g} % of the mean.",
    )
    add = parser.add_argument
    add("path", nargs="+", type=Path, metavar="FOLDER", help="with .blend files at any depth, or such a file")
    add(
        "--output",
        type=Path,
        default=Path("build/parity"),
        metavar="FOLDER",
        help="of the page",
    )
    add("--seeds", type=int, default=2, metavar="N", help="renders of each picture (2)")
    add("--samples", type=int, default=64, metavar="N", help="a pixel and render (64)")
    add("--width", type=int, default=160, metavar="N", help="pixels (160); the height keeps the shape")
    add("--blender", default=shutil.which("blender"), metavar="PATH", help="the Blender to run")
    add("--scripts", action="store_true", help="let scripts and drivers inside of the files run")
    add("--timeout", type=int, default=600, metavar="SECONDS", help="of a file and engine (600)")
    arguments = parser.parse_args()
    if arguments.seeds < 2:
        parser.error("--seeds: at least 2 are needed to know how noisy they are")
    return arguments


def _blends(paths: list[Path]) -> dict[str, Path]:
    """By what they are called on the page."""
    resolved = [path.resolve() for path in paths]
    found = [sorted(path.rglob("*.blend")) if path.is_dir() else [path] for path in resolved]
    return named(dict.fromkeys(blend for blends in found for blend in blends))


def _judged(name, blend, installation, effort, work, pictures) -> list[Outcome]:
    """One of each number of bounces, or what went wrong: with one engine, so that it is known whose it is."""
    for engine in ENGINES:
        folder = work / engine.lower()
        folder.mkdir(parents=True)
        task = {"blend": str(blend), "engine": engine, "bounces": BOUNCES, "folder": str(folder)}
        task |= effort._asdict() | {"seeds": list(range(effort.seeds))}
        try:
            installation.run("inside_engine.py", task, folder)
        except blender.BlenderError as error:
            return [Outcome(name, False, f"{engine.title()}: {error}", notes=_notes(work))]
    return [_compared(f"{name}, {_words(bounces)}", work, bounces, effort, pictures) for bounces in BOUNCES]


def _words(bounces: int) -> str:
    return f"{bounces} bounces" if bounces else "direct light"


def _compared(name, work, bounces, effort, pictures) -> Outcome:
    from velour.native import VelourError, images

    from regression.comparison import ALPHA, compare
    from support.judge import BLOCK, estimate, scores

    def known(engine):
        folder = work / engine.lower()
        return estimate(images.read(folder / f"{bounces}-{seed}.exr") for seed in range(effort.seeds))

    try:
        theirs, ours = map(known, ENGINES)
        found = compare(ours, theirs, pictures)
        alpha = scores(ours.channels(ALPHA), theirs.channels(ALPHA))
        found = found._replace(percent=max(found.percent, 100 * abs(alpha.first - alpha.second).max()))
    except (VelourError, OSError, ValueError) as error:
        return Outcome(name, False, str(error), notes=_notes(work))
    agrees = found.agrees or found.percent <= MOST_PERCENT
    left, bottom = (index * BLOCK for index in found.block)
    sentence = (
        f"{found.percent:.2f} % of the mean, {found.z:.1f} standard errors of at most {found.limit:.1f}"
    )
    if not agrees:
        sentence += f", most in the block {left} pixels from the left, {bottom} from below"
    outcome = Outcome(name, agrees, sentence, comparison=found, notes=_notes(work))
    outcome.ours, outcome.reference = ours.mean, theirs.mean
    return outcome


def _notes(work: Path) -> list[str]:
    return blender.notes(work / "velour/inside_engine.log")


def _shown(outcomes: list[Outcome], output: Path) -> int:
    """The page, what differs most first."""
    from regression import page  # imports the package

    def place(outcome):
        return outcome.passed, -outcome.comparison.percent if outcome.comparison else -float("inf")

    shown = page.Page(output, "Velour beside Cycles", {"reference": "Cycles", "new": "Velour"})
    for outcome in sorted(outcomes, key=place):
        shown.add(outcome)
    failed = sum(not outcome.passed for outcome in outcomes)
    print(f"page: {shown.finish()}")
    print(f"{len(outcomes) - failed} alike, {failed} not")
    return 1 if failed else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        print("parity: stopped.", file=sys.stderr)
        sys.exit(INTERRUPTED)
