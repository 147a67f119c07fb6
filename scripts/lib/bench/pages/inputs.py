"""What Velour does with files of other programs, from the tests of the readers: docs/reference/inputs.md."""

from __future__ import annotations

import subprocess
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
    found: dict[tuple[str, ...], str] = {}
    for program in _PROGRAMS:
        report = run.work / "report.xml"
        command = [BUILT / "tests/unit" / program, f"--gtest_output=xml:{report}"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for each in ET.parse(report).getroot().iter("property"):
            if each.get("name").startswith(_MARK):
                variant = each.get("name").removeprefix(_MARK).split("|", 1)
                found[tuple(variant)] = each.get("value")
    rows = [{"format": f, "variant": v, "verdict": verdict} for (f, v), verdict in sorted(found.items())]
    text = page.table(rows, "format | variant | verdict", "{format} | {variant} | {verdict}")
    page.write(ROOT / "docs/reference", "inputs.md", page.text("inputs", {"table": text}))
