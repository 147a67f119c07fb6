"""scripts/guide, after the build: runs one Blender per chapter, then writes the pages."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from bench import blender, data_files
from bench.velour_cli import ROOT

from . import pages, pictures

CHAPTERS = ("install", "preset", "first_material", "library", "tolerance", "scene_model", "tile", "cloth")
MEASUREMENT = "brdf/cc_iris_purple_gem_rgb.bsdf"
SCREEN = (1000, 2300)  # the whole window fits a page at this width, the longest panel at this height
SECONDS = 1800  # time limit for a chapter, on a busy machine
FILES = ROOT / "build/guide"


def main() -> int:
    parser = argparse.ArgumentParser(prog="guide")
    parser.add_argument("--blender", default="blender", metavar="PATH")
    parser.add_argument("chapters", nargs="*", metavar="CHAPTER", help=", ".join(CHAPTERS))
    arguments = parser.parse_args()
    unknown = set(arguments.chapters) - set(CHAPTERS)
    if unknown:
        return _stop(f"there is no chapter {min(unknown)!r}; there are {', '.join(CHAPTERS)}")
    try:
        measurement = data_files.folder() / MEASUREMENT
        for chapter in arguments.chapters or CHAPTERS:
            if chapter == "cloth" and not (FILES / "tile/weave.velour").is_file():
                return _stop("the cloth needs the model of the chapter tile; name that as well")
            _run(chapter, arguments.blender, measurement, FILES / chapter)
    except (data_files.NoDataError, blender.BlenderError) as error:
        return _stop(str(error))
    return 0


def _run(chapter: str, program: str, measurement: Path, folder: Path) -> None:
    print(f"{chapter} ...", flush=True)
    script, options = Path(__file__).with_name("inside.py"), ["--enable-event-simulate"]
    task = {"chapter": chapter, "measurement": measurement.name}
    blender.in_window(script, task, folder, SCREEN, program, options, [measurement], SECONDS)
    for path in sorted(folder.glob("*.png")):
        pages.link(pictures.keep(path, pages.GUIDE / "images"))
    pages.write(chapter, json.loads((folder / "facts.json").read_text()))


def _stop(sentence: str) -> int:
    print(f"guide: {sentence}", file=sys.stderr)
    return 1
