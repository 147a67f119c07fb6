"""Pictures of presets for README and docs/results/gallery.md, in Blender, with their times.

--only renders some of the scenes; the others keep their pictures and numbers.
"""

from __future__ import annotations

import json
import shutil

from velour.core import files

from .. import blender, page
from ..run import Run

SCENES = {
    "metals": "Metals, paints and porcelain on sculptures",
    "cloths": "Denim, velvet and knitted wool, draped, with silhouettes of their yarns",
}
SETTINGS = {
    "size": ((1600, 900), (320, 180)),
    "samples": (4096, 64),  # maximum number of light directions per pixel
    "noise": (0.012, 0.1),
    "only": (tuple(SCENES), tuple(SCENES)),
}


def measure(run: Run) -> dict:
    own = run.settings
    unknown = set(own.only) - set(SCENES)
    if unknown:
        raise SystemExit(f"There is no scene {', '.join(sorted(unknown))}; there are {', '.join(SCENES)}.")
    for _ in own.only:
        run.progress.expect(1)
    for name in own.only:
        with run.progress.work(name, 1):
            _render(run, name)
    kept = {name: run.work / f"{name}.json" for name in SCENES}
    rows = [json.loads(path.read_text(encoding="utf-8")) for path in kept.values() if path.is_file()]
    return {"conditions": run.conditions(), "rows": rows}


def _render(run: Run, name: str) -> None:
    task = {"scene": name, "folder": str(run.work), "size": run.settings.size}
    task |= {"samples": run.settings.samples, "noise": run.settings.noise}
    report = blender.run("gallery", task, run.work / f"{name}.log", ("-t", str(run.threads)))
    row = {"scene": name, "seconds": report["seconds"], "directions": report["spp"]}
    files.write_json(run.work / f"{name}.json", row)
    (run.output / "images").mkdir(parents=True, exist_ok=True)
    shutil.copy(run.work / f"{name}.png", run.output / f"images/gallery_{name}.png")


def write(run: Run, found: dict) -> None:
    rows = [row | {"about": SCENES[row["scene"]]} for row in found["rows"]]
    table = page.table(
        rows, "picture | seconds | light directions a pixel", "{about} | {seconds:.0f} | {directions:.0f}"
    )
    pictures = "\n".join(
        "## {about}\n\n![{about}](images/gallery_{scene}.png)\n".format(**row) for row in rows
    )
    page.write(
        run.output,
        "gallery.md",
        page.text("gallery", found["conditions"] | {"table": table, "pictures": pictures}),
    )
