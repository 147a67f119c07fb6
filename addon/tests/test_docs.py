"""The documents agree with the tree: links lead somewhere, names exist, citations have an entry."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from conftest import ROOT

PAGES = [ROOT / "README.md", ROOT / "CHANGELOG.md", *sorted((ROOT / "docs").rglob("*.md"))]
SOURCES = [
    path
    for folder in ("native/src", "native/include", "addon/velour")
    for path in (ROOT / folder).rglob("*")
    if path.suffix in (".h", ".cpp", ".py")
]


@pytest.fixture(scope="module")
def code() -> str:
    return "\n".join(path.read_text(encoding="utf-8") for path in SOURCES)


@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.name)
def test_links_lead_somewhere(page):
    targets = re.findall(r"\]\(([^)#]+)[^)]*\)", page.read_text(encoding="utf-8"))
    missing = [t for t in targets if "://" not in t and not (page.parent / t).exists()]
    assert missing == []


def test_places_that_the_next_engineer_is_sent_to_exist():
    text = (ROOT / "docs/next_engineer.md").read_text(encoding="utf-8")
    places = re.findall(r"`((?:native|addon|scripts|blend-tests)/[\w./-]+)`", text)
    assert len(places) > 40
    assert [place for place in places if not (ROOT / place).exists()] == []


def test_code_names_of_the_equations_exist(code):
    text = (ROOT / "docs/equations.md").read_text(encoding="utf-8")
    names = {name.split("::")[-1] for name in re.findall(r"`([A-Za-z_:]+)`", text)}
    assert names
    assert sorted(name for name in names if not re.search(rf"\b{name}\b", code)) == []


def test_what_the_code_cites_is_in_the_bibliography(code):
    cited = set(re.findall(r"\[([A-Z][A-Za-z]*\d\d)\b[^]\n]*\]", code))
    known = set(re.findall(r"^@\w+\{(\w+),", (ROOT / "docs/references.bib").read_text(), flags=re.MULTILINE))
    assert "T09" in cited
    assert cited - known == set()


def test_every_option_of_the_command_line_is_documented():
    text = (ROOT / "docs/command_line.md").read_text(encoding="utf-8")
    verbs = (ROOT / "addon/velour/core/cli").glob("*.py")
    source = "\n".join(path.read_text() for path in verbs if path.name != "compress.py")
    options = set(re.findall(r'add_argument\(\s*(?:"-o", )?"(--[a-z-]+)"', source)) - {
        "--output",
        "--version",
    }
    assert options > {"--tolerance", "--world-rotation", "--json-file"}
    assert sorted(option for option in options if option not in text) == []


def test_no_private_paths():
    private = re.compile(r"(?<![\w.~])/(root|home|tmp|opt|mnt)/")
    assert [path.name for path in map(Path, PAGES) if private.search(path.read_text(encoding="utf-8"))] == []
