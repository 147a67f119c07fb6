"""velour-check: a user's .blend files beside their references. See docs/engine/regression.md."""

from __future__ import annotations

import argparse
import os
import shutil
import signal
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING

TESTS = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TESTS))

from regression import blender, folder, room  # noqa: E402
from regression.case import CHECK_SEEDS, REFERENCE_SEEDS, Case, Outcome, Settings  # noqa: E402
from support import junit, process, report  # noqa: E402

if TYPE_CHECKING:  # it imports the package, which _installation() finds
    from regression.update import Staged

STAGE = TESTS.parent / "build/release/blender"
JOBS = min(2, os.cpu_count() or 1)  # starting and reading keep one core busy
SECONDS = 900  # that all renders of a .blend may take
INTERRUPTED = 130
NOTHING_CHECKED = 2  # as wrong usage


def main() -> int:
    arguments = _arguments()
    try:
        output = (arguments.output or folder.parent(arguments.path[0]) / "velour-check").resolve()
        held = room.take(output)  # the earlier page goes first, so that none is taken for one of this run
        if arguments.junit:
            _forget_report(arguments.junit)
        cases = folder.cases(arguments.path, output / "work", arguments.frame)
        installation = _installation(arguments)
    except (folder.FolderError, room.RoomError, blender.BlenderError, OSError) as error:
        print(f"velour-check: {error}", file=sys.stderr)
        return NOTHING_CHECKED
    with held:
        try:
            return _run(arguments, cases, installation, output)
        except OSError as error:  # of the page, of what is replaced or of the JUnit report
            print(f"velour-check: {error}", file=sys.stderr)
            return 1


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="velour-check",
        description="Renders .blend files with Velour and holds each against its NAME.exr, by statistics.",
    )
    add = parser.add_argument
    add("path", nargs="+", type=Path, metavar="FOLDER", help="with .blend files, or a .blend file")
    add("--update", action="store_true", help="make references; asks before it replaces any")
    add("--yes", action="store_true", help="with --update: replace references without asking")
    add("--frame", type=int, action="append", metavar="N", help="of references to make; may be repeated")
    add("--output", type=Path, metavar="FOLDER", help="of the page (velour-check in the first FOLDER)")
    add("--junit", type=Path, metavar="FILE", help="write a JUnit XML report")
    add("--jobs", type=int, default=JOBS, metavar="N", help=f"Blenders that run at a time ({JOBS})")
    add(
        "--seeds",
        type=int,
        metavar="N",
        help=f"renders of each picture ({CHECK_SEEDS}; of a reference {REFERENCE_SEEDS})",
    )
    add("--samples", type=int, metavar="N", help="directions a pixel (those of the .blend)")
    add(
        "--blender",
        default=shutil.which("blender"),
        metavar="PATH",
        help="the Blender to run (on the PATH)",
    )
    add("--installed", action="store_true", help="use the add-on that Blender has, not the one built here")
    add("--scripts", action="store_true", help="let scripts and drivers inside the .blend files run")
    add("--timeout", type=int, default=SECONDS, metavar="SECONDS", help=f"of a .blend file ({SECONDS})")
    arguments = parser.parse_intermixed_args()
    if arguments.seeds is not None and arguments.seeds < 2:
        parser.error("--seeds: at least 2 are needed to know how noisy they are")
    if arguments.update and arguments.seeds is not None and arguments.seeds < CHECK_SEEDS:
        parser.error(f"--seeds: a reference needs at least {CHECK_SEEDS}, as many as a check renders")
    for name in ("jobs", "samples", "timeout"):
        if getattr(arguments, name) is not None and getattr(arguments, name) < 1:
            parser.error(f"--{name}: at least 1")
    if arguments.yes and not arguments.update:
        parser.error("--yes is for --update")
    if arguments.frame and not arguments.update:
        parser.error("--frame is for --update; frames are checked where there is a reference of them")
    return arguments


def _forget_report(path: Path) -> None:
    """Removes that of an earlier run. Raises OSError where none could be written."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.open("ab").close()
    if path.is_file():
        path.unlink()


def _installation(arguments: argparse.Namespace) -> blender.Installation:
    """Makes the package of the add-on importable as well."""
    program = shutil.which(arguments.blender or "blender")
    if program is None:
        raise blender.BlenderError("There is no Blender; install it, or name one with --blender.")
    stage = Path(os.environ.get("VELOUR_STAGE", STAGE)).resolve()
    if not arguments.installed and (stage / "addons/velour").is_dir():
        blender.use_package(stage / "addons")
        return blender.Installation(program, stage, arguments.timeout)
    installed = blender.Installation(program, None, arguments.timeout)
    with tempfile.TemporaryDirectory(prefix="velour-check-") as temporary:
        try:
            addons = installed.run("inside_find.py", {}, Path(temporary))["addons"]
        except blender.BlenderError as error:
            sentence = f"{program}: {error}; install the add-on, or build it with scripts/build."
            raise blender.BlenderError(sentence) from error
    blender.use_package(Path(addons))
    return installed


def _run(
    arguments: argparse.Namespace, cases: list[Case], installation: blender.Installation, output: Path
) -> int:
    from regression import page, update  # they import the package

    settings = Settings(arguments.seeds, arguments.samples, arguments.scripts, passes=True)
    pictures = sum(len(case.references) for case in cases) or 1
    staged = update.Staged(output / "new") if arguments.update else None

    def work(case: Case) -> list[Outcome]:
        start, outcomes = time.monotonic(), []
        for outcome in _outcomes(case, installation, settings, pictures, staged):
            shown.draw(outcome)
            outcomes.append(outcome)
        for outcome in outcomes:
            outcome.seconds = (time.monotonic() - start) / len(outcomes)
        return outcomes

    names = {"reference": "reference until now"} if staged else {}
    shown = page.Page(output, "Velour: renders beside their references", names)
    ended = []
    for outcome in _in_order(work, cases, arguments.jobs):
        print(outcome.line, flush=True)
        shown.add(outcome)
        ended.append(outcome)
    if count := folder.left_out(arguments.path, (case.blend for case in cases)):
        print(f"not checked: {count} .blend files in folders below; name those folders as well")
    print(f"page: {shown.finish()}")
    failed = sum(not outcome.passed for outcome in ended)
    status = int(failed > 0)
    if staged:
        status = max(status, staged.approve(arguments.yes))
    else:
        print(f"{len(ended) - failed} as expected, {failed} not")
    if arguments.junit:
        _write_junit(arguments.junit.resolve(), ended)
    return status


def _in_order(work: Callable[[Case], list[Outcome]], cases: list[Case], jobs: int) -> Iterator[Outcome]:
    """Outcomes in the order of the cases, whose Blenders run `jobs` at a time."""
    with ThreadPoolExecutor(jobs) as pool:
        runs = [pool.submit(work, case) for case in cases]
        try:
            for number, (case, run) in enumerate(zip(cases, runs, strict=True), 1):
                print(f"{number} of {len(cases)}: {case.blend}", file=sys.stderr, flush=True)
                yield from run.result()
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            process.stop_all()
            raise


def _outcomes(
    case: Case, installation: blender.Installation, settings: Settings, pictures: int, staged: Staged | None
) -> Iterable[Outcome]:
    from regression import check, update

    if not case.blend.is_file():
        sentence = f"{case.blend.name} is missing, but its reference is there; bring it back, or remove both."
        return [Outcome(case.name, False, sentence)]
    if staged is not None:
        if not case.references:
            case.references[None] = folder.own_reference(case.blend)
        return update.update(case, installation, settings, pictures, staged)
    if not case.references:
        sentence = f"{case.blend.name} has no reference; make {case.blend.stem}.exr with --update."
        return [Outcome(case.name, False, sentence)]
    return check.check(case, installation, settings, pictures)


def _write_junit(path: Path, outcomes: list[Outcome]) -> None:
    tests = [
        report.Test(
            outcome.name,
            report.PASSED if outcome.passed else report.FAILED,
            outcome.seconds,
            reason="" if outcome.passed else outcome.sentence,
        )
        for outcome in outcomes
    ]
    junit.write(path, {"velour-check": tests})


def _stop(number: int, _frame: object) -> None:
    """Ends like Ctrl-C: the Blenders have sessions of their own, so nobody else would end them."""
    sys.exit(128 + number)


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.default_int_handler)  # in the background of a shell it is ignored
    signal.signal(signal.SIGTERM, _stop)
    if signal.getsignal(signal.SIGHUP) == signal.SIG_DFL:  # nohup ignores it
        signal.signal(signal.SIGHUP, _stop)
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        print("velour-check: stopped.", file=sys.stderr)
        sys.exit(INTERRUPTED)
