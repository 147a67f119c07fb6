"""Pictures and numbers of docs/guide, taken while its steps are performed in a window of Blender."""

from __future__ import annotations

from guide import CHAPTERS, pages

from .. import blender
from ..run import Run

SETTINGS = {"chapters": (CHAPTERS, ("install",)), "blender": ("blender", "blender")}  # path
MEASUREMENT = "brdf/cc_iris_purple_gem_rgb.bsdf"
SCREEN = (1000, 2300)  # the whole window fits a page at this width, the longest panel at this height
SECONDS = 1800  # time limit for a chapter, on a busy machine


def measure(run: Run) -> None:
    own, measurement = run.settings, run.data / MEASUREMENT
    if unknown := set(own.chapters) - set(CHAPTERS):
        raise SystemExit(f"guide: there is no chapter {min(unknown)!r}; there are {', '.join(CHAPTERS)}")
    for chapter in own.chapters:
        if chapter == "cloth" and not (run.work / "tile/weave.velour").is_file():
            raise SystemExit("guide: the cloth needs the model of the chapter tile; name that as well")
        print(f"{chapter} ...", flush=True)
        folder, task = run.work / chapter, {"chapter": chapter, "measurement": measurement.name}
        how = (SCREEN, own.blender, ["--enable-event-simulate"], [measurement], SECONDS)
        facts = blender.in_window("guide.inside", task, folder, *how)
        for path in sorted(folder.glob("*.png")):
            pages.link(pages.keep(path, pages.GUIDE / "images"))
        pages.write(chapter, facts)
