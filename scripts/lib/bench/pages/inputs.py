"""What Velour does with files of other programs, from the tests of the readers: docs/reference/inputs.md."""

from __future__ import annotations

import subprocess
import textwrap
import xml.etree.ElementTree as ET

from .. import page
from ..run import BUILT, Run
from ..velour_cli import ROOT

SETTINGS = {}
_PROGRAMS = (
    "image/test_image",
    "image/test_portable_picture",
    "scene/test_mesh",
    "brdf/test_brdf",
    "btf/test_btf",
)
_MARK = "input|"


def measure(run: Run) -> None:
    found: dict[str, dict[str, str]] = {}
    for program in _PROGRAMS:
        report = run.work / "report.xml"
        command = [BUILT / "tests/unit" / program, f"--gtest_output=xml:{report}"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for each in ET.parse(report).getroot().iter("property"):
            if each.get("name").startswith(_MARK):
                file_format, variant = each.get("name").removeprefix(_MARK).split("|", 1)
                found.setdefault(file_format, {})[variant] = each.get("value")
    page.write(ROOT / "docs/reference", "inputs.md", page.text("inputs", {"formats": _lists(found)}))


def _lists(found: dict[str, dict[str, str]]) -> str:
    """A heading per format, with a line per variant: what Velour does with it. Formats that are refused as a
    whole share a heading."""
    others: dict[str, list[str]] = {}
    for file_format in sorted(found):
        if list(found[file_format]) == ["any"]:
            others.setdefault(found[file_format]["any"], []).append(file_format)
    parts = [_list(name, found[name]) for name in sorted(found) if list(found[name]) != ["any"]]
    if others:
        parts.append(_list("Others", {", ".join(names): verdict for verdict, names in others.items()}))
    return "\n".join(parts)


def _list(title: str, verdicts: dict[str, str]) -> str:
    lines = (f"- {variant}: {verdict}" for variant, verdict in sorted(verdicts.items()))
    wrapped = (textwrap.fill(line, 120, subsequent_indent="  ", break_on_hyphens=False) for line in lines)
    return "\n".join((f"## {title}\n", *wrapped)) + "\n"
