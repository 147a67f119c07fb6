"""scripts/guide, after the build: runs one Blender per chapter, then writes the pages."""

from __future__ import annotations

import argparse
import json
import shutil
import sys
from pathlib import Path

from bench import data_files
from bench.velour_cli import ROOT

from . import pages, pictures

sys.path.insert(0, str(ROOT / "blend-tests"))

from support import process

CHAPTERS = ("install", "preset", "first_material", "library", "tolerance", "scene_model", "tile", "cloth")
MEASUREMENT = "brdf/cc_iris_purple_gem_rgb.bsdf"
SCREEN = "1000x2300"  # the whole window fits a page at this width, the longest panel at this height
SECONDS = 1800  # time limit for a chapter, on a busy machine
FILES = ROOT / "build/guide"


def main() -> int:
    parser = argparse.ArgumentParser(prog="guide")
    parser.add_argument("--blender", default=shutil.which("blender"), metavar="PATH")
    parser.add_argument("chapters", nargs="*", metavar="CHAPTER", help=", ".join(CHAPTERS))
    arguments = parser.parse_args()
    unknown = set(arguments.chapters) - set(CHAPTERS)
    if unknown:
        return _stop(f"there is no chapter {min(unknown)!r}; there are {', '.join(CHAPTERS)}")
    missing = next(
        (tool for tool in ("xvfb-run", arguments.blender or "blender") if not shutil.which(tool)), None
    )
    if missing:
        return _stop(f"{missing} is not installed; run scripts/setup")
    try:
        measurement = data_files.folder() / MEASUREMENT
    except data_files.NoDataError as error:
        return _stop(str(error))
    for chapter in arguments.chapters or CHAPTERS:
        if chapter == "cloth" and not (FILES / "tile/weave.velour").is_file():
            return _stop("the cloth needs the model of the chapter tile; name that as well")
        said = _run(chapter, arguments.blender, measurement, FILES / chapter)
        if said:
            return _stop(said)
    return 0


def _run(chapter: str, blender: str, measurement: Path, folder: Path) -> str:
    """Returns why it failed, or ""."""
    print(f"{chapter} ...", flush=True)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    shutil.copy(measurement, folder)
    (folder / "task.json").write_text(json.dumps({"chapter": chapter, "measurement": measurement.name}))
    log, stage = folder / "log.txt", ROOT / "build/release/blender"
    status = process.execute(_command(blender, folder), process.environment(blender, stage), log, SECONDS)
    report = folder / "report.json"
    if status != 0 or not report.is_file() or json.loads(report.read_text())["failed"]:
        last = [line for line in log.read_text(errors="replace").splitlines() if line.strip()][-3:]
        return f"the chapter {chapter} failed; {log} ends: {' / '.join(last)}"
    for path in sorted(folder.glob("*.png")):
        pages.link(pictures.keep(path, pages.GUIDE / "images"))
    pages.write(chapter, json.loads((folder / "facts.json").read_text()))
    return ""


def _command(blender: str, folder: Path) -> list[str]:
    width, height = SCREEN.split("x")
    screen = ["env", "-C", folder, "xvfb-run", "-a", "-s", f"-screen 0 {SCREEN}x24 -fbdir . -nocursor"]
    start = [blender, "--factory-startup", "-noaudio", "--enable-event-simulate"]
    start += ["--window-geometry", "0", "0", width, height]
    inside = Path(__file__).with_name("inside.py")
    return [*map(str, screen), *start, "--python-exit-code", "1", "--python", str(inside), "--", str(folder)]


def _stop(sentence: str) -> int:
    print(f"guide: {sentence}", file=sys.stderr)
    return 1
