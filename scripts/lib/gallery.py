"""scripts/gallery, after staging: pictures of presets for README and docs/results/gallery.md."""

from __future__ import annotations

import argparse
import json
import shutil
import sys
from pathlib import Path

import headless_blender
import markdown_table
import provenance
import script
from progress import Progress
from velour.core import files
from velour.core.machine import threads
from velour_cli import ROOT

SCENES = {
    "metals": "Metals, paints and porcelain on sculptures",
    "cloths": "Denim, velvet and knitted wool, draped, with silhouettes of their yarns",
}
_SIZE, _SAMPLES, _NOISE = (1600, 900), 4096, 0.012
_QUICK_SIZE, _QUICK_SAMPLES = (320, 180), 64


def main() -> int:
    parser = argparse.ArgumentParser(prog="gallery")
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help=f"{', '.join(SCENES)}; default: all")
    parser.add_argument("--quick", action="store_true", help="small pictures in build/gallery, to try it")
    args = parser.parse_args()
    for unknown in set(args.scenes) - set(SCENES):
        parser.error(f"there is no scene {unknown!r}; there are {', '.join(SCENES)}")
    work = ROOT / "build/gallery"
    work.mkdir(parents=True, exist_ok=True)
    progress, chosen = Progress(), args.scenes or list(SCENES)
    for _ in chosen:
        progress.expect(1)
    for name in chosen:
        with progress.work(name, 1):
            _render(name, work, args.quick)
        if not args.quick:
            shutil.copy(work / f"{name}.png", ROOT / f"docs/results/images/gallery_{name}.png")
    if not args.quick:
        files.write_text(ROOT / "docs/results/gallery.md", _page(work))
    return 0


def _render(name: str, work: Path, quick: bool) -> None:
    task = {
        "scene": name,
        "folder": str(work),
        "report": str(work / f"{name}.json"),
        "size": _QUICK_SIZE if quick else _SIZE,
        "samples": _QUICK_SAMPLES if quick else _SAMPLES,
        "noise": _NOISE,
    }
    headless_blender.run("gallery_scene.py", task, work / f"{name}.log")
    if not quick:
        report = json.loads((work / f"{name}.json").read_text(encoding="utf-8"))
        report["conditions"] = provenance.conditions(1, threads())
        files.write_json(work / f"{name}.json", report)


def _page(work: Path) -> str:
    made = {name: work / f"{name}.json" for name in SCENES if (work / f"{name}.json").is_file()}
    reports = {name: json.loads(path.read_text(encoding="utf-8")) for name, path in made.items()}
    rows = [
        [text, f"{reports[name]['seconds']:.0f}", f"{reports[name]['spp']:.0f}"]
        for name, text in SCENES.items()
        if name in reports
    ]
    table = markdown_table.table(["picture", "seconds", "light directions a pixel, mean"], rows)
    pictures = "\n".join(
        f"## {SCENES[name]}\n\n![{SCENES[name]}](images/gallery_{name}.png)\n" for name in reports
    )
    conditions = next(iter(reports.values()))["conditions"]
    return f"""# Gallery

Presets of Velour in its procedural studio, rendered by `scripts/gallery` at {_SIZE[0]} x {_SIZE[1]} pixels
with a noise threshold of {_NOISE} and denoising. Seconds include no export.

{table}
{provenance.sentence(conditions)}

{pictures}"""


if __name__ == "__main__":
    sys.exit(script.guarded("gallery", main))
