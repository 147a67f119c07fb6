"""Writes docs/reference/inputs.md: how Velour handles files of other programs, from the reader tests."""

from __future__ import annotations

import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ET
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

from markdown_table import table
from velour.core import files
from velour_cli import ROOT

_PAGE = ROOT / "docs/reference/inputs.md"
_PROGRAMS = (
    "image/test_image",
    "image/test_portable_picture",
    "scene/test_mesh",
    "brdf/test_brdf",
    "btf/test_btf",
)
_MARK = "input|"
_HEAD = """# Files of other programs

What Velour does with files that it did not write. The table is made by `scripts/inputs` from the tests of
the readers: each line is what a test has just proven. *Refused* means one sentence that names the file, what
was found and what to do, and exit status 1.

Within Blender pictures look as Cycles shows them: what a header says of orientation, exposure, primaries and
windows is told, not followed. On the command line and in measured sets the file decides, as below.

"""


def main() -> int:
    found: dict[tuple[str, str], str] = {}
    for program in _PROGRAMS:
        found |= _recorded(ROOT / "build/release/native/tests/unit" / program)
    rows = [[*variant, verdict] for variant, verdict in sorted(found.items(), key=lambda item: item[0])]
    files.write_text(_PAGE, _HEAD + table(["format", "variant", "verdict"], rows))
    print(_PAGE)
    return 0


def _recorded(program: Path) -> dict[tuple[str, str], str]:
    """Verdicts by format and variant. Raises CalledProcessError if a test fails."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.xml"
        subprocess.run(
            [program, f"--gtest_output=xml:{report}"],
            check=True,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        properties = ET.parse(report).getroot().iter("property")
        return {
            tuple(each.get("name").removeprefix(_MARK).split("|", 1)): each.get("value")
            for each in properties
            if each.get("name").startswith(_MARK)
        }


if __name__ == "__main__":
    sys.exit(main())
