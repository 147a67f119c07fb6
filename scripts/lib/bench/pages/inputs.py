"""What Velour does with files of other programs, from the tests of the readers: docs/reference/inputs.md."""

from __future__ import annotations

import subprocess
import textwrap
import xml.etree.ElementTree as ET

from .. import page
from ..project import BUILT, ROOT
from ..run import Run

SETTINGS = {}
_PROGRAMS = ("image/test_image", "image/test_portable_picture", "scene/test_scene")
_PROGRAMS += ("brdf/measure/test_brdf_measure", "btf/measure/test_btf_measure")
_MARK = "input|"
# Measurements, whose own pages state what is read.
_ELSEWHERE = (
    "BSDF XML of Radiance and WINDOW",
    "BTF images named by angles",
    "CSV index of a BTF",
    "Cornell .brdf",
    "MERL .binary",
)


def measure(run: Run) -> None:
    found: dict[str, dict[str, str]] = {}
    for program in _PROGRAMS:
        report = run.work / "report.xml"
        command = [BUILT / "tests/unit" / program, f"--gtest_output=xml:{report}"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for each in ET.parse(report).getroot().iter("property"):
            if each.get("name").startswith(_MARK):
                file_format, variant = each.get("name").removeprefix(_MARK).split("|", 1)
                if file_format not in _ELSEWHERE:
                    found.setdefault(file_format, {})[variant] = each.get("value")
    # Formats that are refused as a whole share a section.
    others = found.pop("Others", {})
    for name in sorted(found):
        if list(found[name]) == ["any"]:
            others[name] = found.pop(name)["any"]
    sections = sorted(found.items())
    if others:
        sections.append(("Others", others))
    formats = [{"name": name, "lines": _lines(own)} for name, own in sections]
    page.write(ROOT / "docs/reference", "inputs.md", page.text("inputs", {"formats": formats}))


def _lines(variants: dict[str, str]) -> str:
    """A line per verdict, with the variants that it applies to."""
    verdicts: dict[str, list[str]] = {}
    for variant, verdict in sorted(variants.items()):
        verdicts.setdefault(verdict.replace(", by both builds alike", ""), []).append(
            "any file" if variant == "any" else variant
        )
    lines = (
        f"- {verdict[:1].upper()}{verdict[1:]}: {'; '.join(found)}" for verdict, found in verdicts.items()
    )
    return "\n".join(
        textwrap.fill(line, 120, subsequent_indent="  ", break_on_hyphens=False) for line in lines
    )
