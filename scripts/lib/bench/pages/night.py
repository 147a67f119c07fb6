"""A whole night on a farm: a shot rendered on four nodes of Slurm while things fail, and what comes out."""

from __future__ import annotations

import shutil
from collections import Counter
from pathlib import Path

from .. import blender, project
from ..inside import frames_of
from ..night import shift, site, still, trouble, verdicts
from ..night.pictures import digest
from ..run import Run

from support import process, slurm  # isort: skip - bench.blender knows where it is

SETTINGS = {
    "frames": (300, 12),
    "size": ((160, 90), (96, 54)),
    "samples": (32, 16),
    "noise_frames": (24, 12),
    "still_size": ((4096, 2160), (512, 270)),
    "still_samples": (4, 4),
}
CSV = "night.csv"
_THREADS_STEP = 3  # every third frame is rendered with another number of threads
PAGES = {"night.md": "night"}
# Debian's Blender allocates with jemalloc, which keeps freed pages for ten seconds: up to a tenth of the
# memory, more than any growth to be found.
_KEEP_NO_FREED_PAGES = {"MALLOC_CONF": "dirty_decay_ms:0,muzzy_decay_ms:0"}
_LISTEN = """\
import sys
sys.path[:0] = {path!r}
from bench.inside import night
night.listen()
"""


def measure(run: Run) -> dict:
    """Raises MissingError where Slurm cannot run."""
    if why := slurm.why_not():
        raise project.MissingError(f"skipped, {why}.")
    run.progress.expect(1, 6)
    blend = _shot(run)
    unbroken, night = _unbroken(run, blend, shift.THREADS, 1), _night(run, blend)
    found = {"frames": run.settings.frames, "farm": night, "unbroken": unbroken}
    found["threads"] = _unbroken(run, blend, run.threads, _THREADS_STEP)
    found |= {"noise": _noise(run, blend), "still": _still(run)}
    judgements = verdicts.judge(found)
    rows = [_row(row, night["frames"].get(str(row["frame"]), {})) for row in unbroken["rows"]]
    summary = {
        name: night[name] for name in ("done", "status", "seconds", "events", "submissions", "has_disk")
    }
    return {
        "conditions": run.conditions(load=round(project.busy_threads(), 1)),
        "rows": rows,
        "judgements": judgements,
        "night": summary,
        "still": found["still"],
        "unbroken_seconds": unbroken["seconds"],
    }


def failures(found: dict) -> list[str]:
    return [each["sentence"] for each in found["judgements"] if each["met"] is False]


def _velour() -> dict[str, Path]:
    """The Python programs of the add-on that renders: kept results depend on them."""
    return _files(*(blender.STAGE / "addons/velour").rglob("*.py"))


def _files(*paths: Path) -> dict[str, Path]:
    return {str(path): path for path in sorted(paths)}


def _shot(run: Run) -> Path:
    """The .blend."""
    task = {name: getattr(run.settings, name) for name in ("frames", "size", "samples")}
    parameters = task | _velour() | _files(blender.INSIDE / "night.py", blender.INSIDE / "scene.py")
    blend = run.stem("shot", parameters) / "shot.blend"
    blend.parent.mkdir(exist_ok=True)
    make = lambda: _inside(run, "night", task | {"blend": str(blend)}, blend) or {}  # noqa: E731
    run.keep("shot", "shot", parameters, make, 1)
    return blend


def _inside(run: Run, script: str, task: dict, stem: Path) -> dict | None:
    return blender.run(script, task, stem.with_suffix(".log"), ("-t", str(run.threads)))


def _unbroken(run: Run, blend: Path, threads: int, step: int) -> dict:
    """Every `step`th frame in one process of plain Blender: what it prints of each, and hashes of their
    pixels."""
    parameters = {"blend": blend, "threads": threads, "step": step} | _KEEP_NO_FREED_PAGES | _velour()
    stem = run.stem("unbroken", parameters)

    def make() -> dict:
        shutil.rmtree(stem, ignore_errors=True)
        _render_all(blend, stem, threads, step)
        rows = frames_of(stem.with_suffix(".log"))
        digests = {str(int(path.stem)): digest(path) for path in sorted(stem.glob("*.exr"))}
        return {"rows": rows, "digests": digests, "seconds": sum(row["seconds"] for row in rows)}

    return run.keep(f"unbroken run, {threads} threads", "unbroken", parameters, make, 1)


def _render_all(blend: Path, stem: Path, threads: int, step: int) -> None:
    path = [str(project.ROOT / "scripts/lib"), str(project.ROOT / "blend-tests")]
    program = shutil.which("blender")
    command = [program, "-b", "--factory-startup", "-noaudio", "--python-exit-code", "7", "-Y"]
    command += ["--addons", "velour", blend, "-E", "VELOUR", "-t", threads]
    command += ["--python-expr", _LISTEN.format(path=path), "-o", stem / "####"]
    command += ["-F", "OPEN_EXR_MULTILAYER", "-x", "1", "-j", step, "-a"]
    log, variables = stem.with_suffix(".log"), process.environment(program, blender.STAGE)
    variables = {name: variables[name] for name in variables if name != "PYTHONPATH"} | _KEEP_NO_FREED_PAGES
    if status := process.execute(list(map(str, command)), variables, log, None):
        raise blender.BlenderError(f"Blender ended with status {status}; {log} has its output")


def _night(run: Run, blend: Path) -> dict:
    programs = [Path(module.__file__) for module in (shift, site, trouble)]
    programs += (project.ROOT / "addon/velour/farm").glob("*.py")
    parameters = {"blend": blend, "seed": run.seed} | _velour() | _files(*programs)
    folder, frames = run.stem("site", parameters), run.settings.frames
    make = lambda: shift.work(blend, frames, folder, blender.STAGE, run.seed)  # noqa: E731
    return run.keep("night", "night", parameters, make, 1)


def _noise(run: Run, blend: Path) -> dict:
    """Mean squared differences of consecutive images where nothing moves."""
    count = run.settings.noise_frames
    task = {"count": count, "frame": max(1, (run.settings.frames - count) // 2)}
    parameters = task | {"shot": blend} | _velour() | _files(blender.INSIDE / "night_noise.py")
    stem = run.stem("noise", parameters)
    more = {"blend": str(blend), "folder": str(run.kept)}
    make = lambda: _inside(run, "night_noise", task | more, stem)  # noqa: E731
    return run.keep("noise", "noise", parameters, make, 1)


def _still(run: Run) -> dict:
    settings = {"size": run.settings.still_size, "spp": run.settings.still_samples}
    settings |= {"seed": run.seed, "threads": run.threads}
    parameters = settings | _files(Path(still.__file__))
    folder = run.stem("still-parts", parameters)
    return run.keep("still", "still", parameters, lambda: still.render(folder, **settings), 1)


def _row(unbroken: dict, farm: dict) -> dict:
    names = {"frame": "frame", "seconds": "seconds", "tracing": "tracing_seconds", "rays": "rays"}
    names |= {"noise": "noise", "mib": "resident_mib", "peak": "peak_mib", "nan_samples": "nan_samples"}
    found = {title: _rounded(unbroken[name]) for name, title in names.items()}
    return found | {"farm_seconds": farm.get("seconds"), "warnings": farm.get("warnings")}


def _rounded(value: float) -> float:
    return value if isinstance(value, int) else float(f"{value:.4g}")


def values(found: dict) -> dict:
    rows, night = found["rows"], found["night"]
    on_farm = [row["farm_seconds"] for row in rows if row["farm_seconds"] is not None]
    counts = Counter(event["kind"] for event in night["events"])
    share = sum(on_farm) / len(shift.NODES)
    refused = [each for each in night["submissions"] if each["status"]]
    return {
        "judgements": found["judgements"],
        "kinds": [{"kind": kind, "count": counts[kind]} for kind in trouble.KINDS],
        "seconds": night["seconds"],
        "share": share,
        "ratio": night["seconds"] / share if share else None,
        "sum": sum(on_farm),
        "submissions": len(night["submissions"]),
        "refused": len(refused),
        "failed": sum(len(each["failed"]) for each in night["submissions"]),
        "busy": project.busy(found["conditions"]["load"]),
        "unbroken_seconds": found["unbroken_seconds"],
        "still": found["still"],
        "no_disk": "" if night["has_disk"] else " No disk could be mounted here, so none was full.",
    }
