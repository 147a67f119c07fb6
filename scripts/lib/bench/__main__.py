"""scripts/bench: measures a page of docs/results, or writes it again from the numbers of its last run."""

from __future__ import annotations

import argparse
import ast
import importlib
import json
import re
import signal
import subprocess
import sys
import textwrap
from pathlib import Path
from types import SimpleNamespace
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[3]


class Needs(NamedTuple):
    targets: tuple[str, ...] = ()  # of the build, besides the library
    tools: str = ""  # option of scripts/setup


# Name and first sentence of each page.
PAGES = {
    path.stem: re.split(r"\.(?:\s|$)", ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))))[0]
    for path in sorted(Path(__file__).with_name("pages").glob("[!_]*.py"))
}
NEEDS = {
    "btf_chart": Needs(tools="metrics"),
    "chart": Needs(("product_bound",), "peers"),
    "closures": Needs(tools="metrics"),
    "eevee": Needs(tools="metrics"),
    "failure_modes": Needs(("test_brdf_fit_optimized",)),
    "inputs": Needs(
        ("test_image", "test_portable_picture", "test_scene", "test_brdf_measure", "test_btf_measure")
    ),
    "models": Needs(("evaluation_cost",)),
    "perceptual": Needs(tools="metrics"),
    "votf": Needs(tools="metrics"),
}


def main(words: list[str]) -> int:
    if words[:1] in (["--list"], ["-h"], ["--help"], []):
        print("scripts/bench NAME [--help | OPTION...]: measures a page of docs/results. NAME is one of")
        for page, about in PAGES.items():
            print(textwrap.fill(f"  {page:16} {about}", 110, subsequent_indent=19 * " "))
        return 0
    name, *words = words
    if name not in PAGES:
        print(f"bench: there is no page {name!r}; scripts/bench --list names them.", file=sys.stderr)
        return 2
    if "--built" not in words and not {"-h", "--help"} & set(words):
        _build(NEEDS.get(name, Needs()))
    return run(name, words)


def _build(needs: Needs) -> None:
    subprocess.run([ROOT / "scripts/setup", *([f"--{needs.tools}"] if needs.tools else [])], check=True)
    subprocess.run([ROOT / "scripts/build", "release", "velour", *needs.targets], check=True)


def run(name: str, words: list[str]) -> int:
    from velour.native import VelourError

    from .blender import BlenderError
    from .project import MissingError

    module = importlib.import_module(f"{__package__}.pages.{name}")
    try:
        return _judge(module, name, _measure(module, name, _arguments(module, name, words)))
    except MissingError as absent:
        print(f"{name}: {absent}")
    except KeyboardInterrupt:
        print(f"{name}: stopped; the next run goes on from here.", file=sys.stderr)
        return 130
    except subprocess.CalledProcessError as error:
        return error.returncode
    except (VelourError, BlenderError, OSError) as error:
        print(f"{name}: {error}", file=sys.stderr)
        return 1
    return 0


def _arguments(module, name: str, words: list[str]) -> argparse.Namespace:
    from velour.core.machine import threads

    parser = argparse.ArgumentParser(prog=f"scripts/bench {name}", description=module.__doc__)
    for option, about in (
        ("--quick", "a small version, to try the script; its page stays in build"),
        ("--page", "writes the page from the numbers of the last run, measures nothing"),
        ("--fresh", "makes again what an earlier run has kept"),
        ("--built", "skips scripts/setup and scripts/build"),
    ):
        parser.add_argument(option, action="store_true", help=about)
    add = parser.add_argument
    add("--output", metavar="FOLDER", type=Path, help="folder of the page instead of docs/results")
    add("--work", metavar="FOLDER", type=Path, help=f"folder of what is kept instead of build/{name}")
    add("--seed", metavar="K", type=int, default=1)
    add("--threads", metavar="T", type=int, default=min(2, threads()))
    for setting, (value, _) in module.SETTINGS.items():
        option = f"--{setting.replace('_', '-')}"
        if isinstance(value, bool):
            add(option, action="store_true", default=None)
        else:
            add(option, metavar="V,..." if isinstance(value, tuple) else "V", type=_reader(setting, value))
    args = parser.parse_args(words)
    for setting, (full, quick) in module.SETTINGS.items():
        if getattr(args, setting) is None:
            setattr(args, setting, quick if args.quick else full)
    return args


def _reader(name: str, value):
    """Parses an option whose value has the type of `value`: WIDTHxHEIGHT, values between commas, or one."""
    if not isinstance(value, tuple):
        return type(value)
    kind = type(value[0]) if value else str
    separator = "x" if name.endswith("size") else ","
    return lambda text: tuple(kind(part) for part in text.split(separator) if part)


def _judge(module, name: str, found: dict) -> int:
    """The exit status: 1 with a sentence for each target that the page's `failures` name."""
    failures = module.failures(found) if hasattr(module, "failures") else []
    for sentence in failures:
        print(f"{name}: {sentence}", file=sys.stderr)
    return 1 if failures else 0


def _measure(module, name: str, args: argparse.Namespace) -> dict:
    """The numbers of the page; empty if it has none of its own."""
    from . import page
    from .project import RESULTS
    from .run import Run

    # A small version only tries the script; it must not replace the numbers of a full run.
    work = args.work or ROOT / "build" / name / ("quick" if args.quick else "full")
    output = args.output or (work / "documents" if args.quick else RESULTS)
    settings = SimpleNamespace(**{setting: getattr(args, setting) for setting in module.SETTINGS})
    run = Run(name, work, output, settings, args.seed, args.threads, args.fresh)
    found = {}
    if not args.page:
        _keep(module, run, module.measure(run))
    if hasattr(module, "PAGES"):
        found = load(module, run.output, name)
        values = found["conditions"] | module.values(found)
        for file, template in module.PAGES.items():
            page.write(run.output, file, page.text(template, values))
    if hasattr(module, "draw"):
        module.draw(run.output, found)
    return found


def _keep(module, run, found: dict | None) -> None:
    """Keeps the rows as the module's CSV, and the rest as JSON."""
    from velour.core import files

    from .page import write_rows

    found = dict(found or {})
    if hasattr(module, "CSV"):
        write_rows(run.output / module.CSV, found.pop("rows"), found.pop("conditions"))
    if found:
        files.write_json(run.output / f"{run.name}.json", found)


def load(module, folder: Path, name: str) -> dict:
    """What the last run has kept. Raises FileNotFoundError."""
    from .page import read_rows

    found, rest, rows = {}, folder / f"{name}.json", folder / getattr(module, "CSV", "")
    if not rows.exists() or not (hasattr(module, "CSV") or rest.is_file()):
        raise FileNotFoundError(f"{folder} has no numbers of an earlier run; run without --page.")
    if hasattr(module, "CSV"):
        found["conditions"], found["rows"] = read_rows(rows)
    if rest.is_file():
        found |= json.loads(rest.read_text(encoding="utf-8"))
    return found


def _interrupt(*_: object) -> None:
    raise KeyboardInterrupt


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, _interrupt)  # as Ctrl-C: what a page has started ends, too
    sys.exit(main(sys.argv[1:]))
