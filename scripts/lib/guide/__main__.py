"""scripts/guide, after the build: runs one Blender per chapter, then writes the pages."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from bench import blender, project

from . import pages

CHAPTERS = ("install", "preset", "first_material", "library", "tolerance", "scene_model", "tile", "cloth")
MEASUREMENT = "brdf/cc_iris_purple_gem_rgb.bsdf"
SCREEN = (1000, 2300)  # the whole window fits a page at this width, the longest panel at this height
SECONDS = 1800  # time limit for a chapter, on a busy machine
FILES = project.ROOT / "build/guide"


def main() -> int:
    parser = argparse.ArgumentParser(prog="guide")
    parser.add_argument("--blender", default="blender", metavar="PATH")
    parser.add_argument("chapters", nargs="*", metavar="CHAPTER", help=", ".join(CHAPTERS))
    arguments = parser.parse_args()
    unknown = set(arguments.chapters) - set(CHAPTERS)
    if unknown:
        return _stop(f"there is no chapter {min(unknown)!r}; there are {', '.join(CHAPTERS)}")
    script, options = Path(__file__).with_name("inside.py"), ["--enable-event-simulate"]
    try:
        measurement = project.data_folder() / MEASUREMENT
        for chapter in arguments.chapters or CHAPTERS:
            if chapter == "cloth" and not (FILES / "tile/weave.velour").is_file():
                return _stop("the cloth needs the model of the chapter tile; name that as well")
            print(f"{chapter} ...", flush=True)
            folder, task = FILES / chapter, {"chapter": chapter, "measurement": measurement.name}
            how = (SCREEN, arguments.blender, options, [measurement], SECONDS)
            facts = blender.in_window(script, task, folder, *how)
            for path in sorted(folder.glob("*.png")):
                pages.link(pages.keep(path, pages.GUIDE / "images"))
            pages.write(chapter, facts)
    except (project.MissingError, blender.BlenderError) as error:
        return _stop(str(error))
    return 0


def _stop(sentence: str) -> int:
    print(f"guide: {sentence}", file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main())
