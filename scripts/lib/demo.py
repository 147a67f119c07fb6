"""scripts/demo: measurement, fit, renders in Blender, difference, report; then a BTF. With --votf: shells."""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import demo_btf
import demo_capture
import demo_material
import demo_votf
import headless_blender
from demo_parts import Parts
from progress import Progress
from velour.native import VelourError

ROOT = Path(__file__).resolve().parents[2]
OUT = ROOT / "out/demo"


def main() -> int:
    args = _parser().parse_args()
    parts = Parts(Progress(rate=1.0), args.fresh)
    tasks = _tasks(args)
    _announce(args, tasks, parts.progress)
    try:
        measured = demo_capture.default_measurement(parts) if _needs_default(args) else None
        for source, folder in tasks:
            capture = measured or demo_capture.Capture(source)
            if args.votf:
                demo_votf.demonstrate(folder / "votf", capture.path, parts)
            else:
                demo_material.demonstrate(folder, capture, parts)
        if _has_btf(args):
            demo_btf.demonstrate(OUT / "btf", parts)
    except KeyboardInterrupt:
        return 130
    except (VelourError, OSError, headless_blender.BlenderError) as error:
        print(f"demo: {error}", file=sys.stderr)
        return 1
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="demo")
    parser.add_argument("--fresh", action="store_true")
    parser.add_argument("--votf", action="store_true")
    parser.add_argument("files", metavar="FILE", nargs="*", type=Path)
    return parser


def _needs_default(args: argparse.Namespace) -> bool:
    return not args.files


def _has_btf(args: argparse.Namespace) -> bool:
    return not args.files and not args.votf


def _tasks(args: argparse.Namespace) -> list[tuple[Path | None, Path]]:
    """Pairs of measurement (None: the default one) and output folder."""
    if len(args.files) < 2:
        return [(args.files[0] if args.files else None, OUT)]
    folders = [OUT / path.stem for path in args.files]
    if len(set(folders)) < len(folders):
        folders = [OUT / f"{number}-{path.stem}" for number, path in enumerate(args.files, 1)]
    return list(zip(args.files, folders, strict=True))


def _announce(args: argparse.Namespace, tasks: list, progress: Progress) -> None:
    if _needs_default(args):
        progress.expect(demo_capture.COST)
    for _ in tasks:
        (demo_votf if args.votf else demo_material).PART.announce(progress)
    if _has_btf(args):
        demo_btf.PART.announce(progress)


if __name__ == "__main__":
    start = time.monotonic()
    status = main()
    if status == 0:
        print(f"        {time.monotonic() - start:.0f} s in all")
    sys.exit(status)
