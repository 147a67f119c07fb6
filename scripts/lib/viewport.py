"""Measures for docs/results/viewport.md how long the rendered viewport takes to show a change."""

from __future__ import annotations

import argparse
import json
import shutil
import statistics
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import provenance
from generated import replaced
from markdown_table import table
from velour.core import files
from velour.core.machine import threads
from velour_cli import ROOT

sys.path.insert(0, str(ROOT / "blend-tests"))

from support import process

PAGE = ROOT / "docs/results/viewport.md"
FILES = ROOT / "build/viewport"
SCENES = {
    "monkey": "a monkey of 31 thousand triangles in a measured paint, under a picture of a sky",
    "objects": "5 million triangles in 500 objects, each with a mesh of its own",
    "instances": "100,000 instances of a sphere of 992 triangles",
}
SEEN, EXPORT, HELD = 0.2, 3.0, 0.05  # targets in seconds
SCREEN = (1400, 1000)
SECONDS = 3600
HEADER = ["change", "seen after, s", "of it export, s", "Blender held up by a redraw, ms"]


def main() -> int:
    parser = argparse.ArgumentParser(prog="viewport")
    parser.add_argument("--restarts", type=int, default=1000, metavar="N")
    parser.add_argument("--blender", default=shutil.which("blender"), metavar="PATH")
    parser.add_argument("scenes", nargs="*", choices=[*SCENES, []], metavar="SCENE")
    arguments = parser.parse_args()
    for tool in ("xvfb-run", arguments.blender or "blender"):
        if not shutil.which(tool):
            return _stop(f"{tool} is not installed; run scripts/setup")
    load = provenance.busy_threads()
    results = {}
    for scene in arguments.scenes or SCENES:
        print(f"{scene} ...", flush=True)
        said = _run(scene, arguments)
        if said:
            return _stop(said)
        results[scene] = json.loads((FILES / scene / "result.json").read_text())
        print(_text(scene, results[scene]), flush=True)
    if len(results) == len(SCENES):
        page = PAGE.read_text(encoding="utf-8")
        files.write_text(PAGE, replaced(page, "measured", _measured(results, load), "viewport"))
    return 0


def _run(scene: str, arguments: argparse.Namespace) -> str:
    """Returns why it failed, or ""."""
    folder = FILES / scene
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    restarts = arguments.restarts if scene == "monkey" else 0
    (folder / "task.json").write_text(json.dumps({"scene": scene, "restarts": restarts}))
    log, stage = folder / "log.txt", ROOT / "build/release/blender"
    status = process.execute(
        _command(arguments.blender, folder), process.environment(arguments.blender, stage), log, SECONDS
    )
    if status == 0 and (folder / "result.json").is_file():
        return ""
    last = [line for line in log.read_text(errors="replace").splitlines() if line.strip()][-3:]
    return f"the scene {scene} failed; {log} ends: {' / '.join(last)}"


def _command(blender: str, folder: Path) -> list[str]:
    width, height = map(str, SCREEN)
    screen = [
        "env",
        "-C",
        str(folder),
        "xvfb-run",
        "-a",
        "-s",
        f"-screen 0 {width}x{height}x24 -fbdir . -nocursor",
    ]
    start = [blender, "--factory-startup", "-noaudio", "--window-geometry", "0", "0", width, height]
    inside = Path(__file__).with_name("viewport_inside.py")
    return [*screen, *start, "--python-exit-code", "1", "--python", str(inside), "--", str(folder)]


def _measured(results: dict[str, dict], load: float) -> str:
    first = next(iter(results.values()))
    width, height = first["size"]
    busy = "" if load < 0.2 else f" **Other programs kept {load:.1f} processors busy.**"
    conditions = provenance.sentence(provenance.conditions(0, threads()))
    head = f"""{conditions} Blender {first["blender"]}, a viewport of {width} x {height}
pixels, {first["samples"]} samples, drawn by Mesa on the processor. Medians of five.{busy}
Target: a change is seen within {SEEN} s, the first export of five million triangles takes less than
{EXPORT:g} s, and a redraw holds Blender up for at most {1000 * HELD:.0f} ms apart from the export. What is
not met is bold."""
    return "\n".join(["", head, "", *(_text(scene, result) for scene, result in results.items())])


def _text(scene: str, result: dict) -> str:
    rows = [_row(name, runs) for name, runs in result["changes"].items()]
    lines = [f"### {SCENES[scene][0].upper()}{SCENES[scene][1:]}", "", table(HEADER, rows)]
    lines.append(f"While the object moves on and on: {result['dragged']:.1f} pictures a second.")
    lines.append(f"Memory of Blender: {result['mib']:.0f} MiB.")
    if "restarts" in result:
        memory = ", ".join(f"{mib:.0f}" for mib in result["restarts"]["mib"])
        count = result["restarts"]["count"]
        lines.append(f"Switched off and on {count} times; MiB after each tenth of them: {memory}.")
    if "real_time" in result:
        lines += ["", _real_time_text(result["real_time"])]
    return "\n".join([*lines, ""])


def _real_time_text(result: dict) -> str:
    seconds, (width, height) = statistics.median(result["seconds"]), result["size"]
    return f"""In real time ([realtime.md](../engine/realtime.md)) a picture of {width} x {height} of it takes
{1000 * seconds:.0f} ms, {1 / seconds:.1f} a second, reading it back included; the target is 30 on a modest
graphics processor."""


def _row(name: str, runs: list[dict]) -> list[str]:
    seen, export, held = (statistics.median(run[key] for run in runs) for key in ("seen", "export", "held"))
    is_first = len(runs) == 1
    return [
        name,
        _marked(f"{seen:.2f}", not is_first and seen > SEEN),
        _marked(f"{export:.3f}", is_first and export > EXPORT),
        _marked(f"{1000 * held:.0f}", held > HELD),
    ]


def _marked(text: str, is_missed: bool) -> str:
    return f"**{text}**" if is_missed else text


def _stop(sentence: str) -> int:
    print(f"viewport: {sentence}", file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main())
