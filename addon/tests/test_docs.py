"""The documents agree with the tree: links lead somewhere, names exist, citations have an entry."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from conftest import ROOT
from PIL import Image, PngImagePlugin
from velour.native.table import STRATEGIES

PAGES = [ROOT / "README.md", ROOT / "CHANGELOG.md", *sorted((ROOT / "docs").rglob("*.md"))]
_REFERENCE = ROOT / "docs/reference"
COMMAND_LINE_PAGES = [_REFERENCE / "command_line.md", *sorted(_REFERENCE.glob("cli_*.md"))]
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
    targets = re.findall(r"\]\(([^)]+)\)", page.read_text(encoding="utf-8"))
    assert [t for t in targets if "://" not in t and not _is_there(page, t)] == []


def _is_there(page: Path, target: str) -> bool:
    """The file of a link and, of a page, the heading."""
    name, _, anchor = target.partition("#")
    path = page.parent / name if name else page
    return path.exists() and (not anchor or anchor in _anchors(path.read_text(encoding="utf-8")))


def _anchors(text: str) -> set[str]:
    """The anchors that GitHub makes of headings: later ones of the same words are numbered."""
    found = set()
    for heading in re.findall(r"^#+ (.+)$", re.sub(r"^```.*?^```", "", text, flags=re.M | re.S), flags=re.M):
        words = re.sub(r"[^\w\- ]", "", re.sub(r"\[(.*?)\]\(.*?\)", r"\1", heading).lower()).replace(" ", "-")
        found.add(next(each for each in _numbered(words) if each not in found))
    return found


def _numbered(words: str) -> Iterator[str]:
    yield words
    yield from (f"{words}-{number}" for number in itertools.count(1))


def test_a_link_to_nowhere_is_seen(tmp_path):
    page = tmp_path / "page.md"
    page.write_text(
        "# Its `title`\n\n## Of [this](that.md), too\n\n## Its title\n\n```sh\n# a comment\n```\n"
    )
    there = ("page.md", "#its-title", "#its-title-1", "page.md#of-this-too")
    assert [target for target in there if not _is_there(page, target)] == []
    nowhere = ("other.md", "other.md#its-title", "#its-title-2", "#a-comment", "page.md#of-that")
    assert [target for target in nowhere if _is_there(page, target)] == []


def test_every_page_is_in_the_index():
    index = (ROOT / "docs/README.md").read_text(encoding="utf-8")
    docs = ROOT / "docs"
    pages = [str(path.relative_to(docs)) for path in docs.rglob("*.md") if path != docs / "README.md"]
    assert len(pages) > 60
    assert [name for name in pages if f"({name})" not in index] == []


def test_pages_are_in_one_of_four_folders():
    names = {path.name for path in (ROOT / "docs").iterdir()}
    assert names == {"README.md", "references.bib", "guide", "reference", "engine", "results"}


def test_every_folder_of_code_says_what_it_is_for():
    """Folders inside the layers of native/src are described by the README of the folder at the top."""
    folders = {path.parent for path in SOURCES} - {ROOT / "native/include/velour", ROOT / "addon/velour"}
    assert len(folders) > 20
    native = ROOT / "native/src"
    folders = {native / f.relative_to(native).parts[0] if native in f.parents else f for f in folders}
    assert [str(folder) for folder in folders if not (folder / "README.md").is_file()] == []


def test_every_operator_is_documented():
    """But for those that only panels use."""
    page = (ROOT / "docs/reference/operators.md").read_text(encoding="utf-8")
    table = set(re.findall(r"`(velour\.\w+)`", "\n".join(re.findall(r"^\| `velour.*", page, flags=re.M))))
    classes = [
        text
        for path in (ROOT / "addon/velour/operators").glob("*.py")
        for text in re.split(r"^class ", path.read_text(encoding="utf-8"), flags=re.M)
    ]
    names = {
        name
        for text in classes
        if '"INTERNAL"}' not in text
        for name in re.findall(r'bl_idname = "(velour\..+)"', text)
    }
    assert len(names) > 20
    assert names ^ table == set()


def test_every_strategy_is_in_the_glossary():
    text = (ROOT / "docs/reference/glossary.md").read_text(encoding="utf-8")
    assert f"directions of light are sampled: {', '.join(STRATEGIES)} |" in text


def test_places_that_the_next_engineer_is_sent_to_exist():
    pages = [ROOT / "docs/engine" / name for name in ("adding.md", "architecture.md")]
    text = "".join(page.read_text(encoding="utf-8") for page in pages)
    places = re.findall(r"`((?:native|addon|scripts|blend-tests)/[\w./-]+)`", text)
    assert len(places) > 60
    assert [place for place in places if not (ROOT / place).exists()] == []


def test_code_names_of_the_equations_exist(code):
    text = (ROOT / "docs/engine/equations.md").read_text(encoding="utf-8")
    names = {name.split("::")[-1] for name in re.findall(r"`([A-Za-z_:]+)`", text)}
    assert names
    assert sorted(name for name in names if not re.search(rf"\b{name}\b", code)) == []


def test_what_the_code_cites_is_in_the_bibliography(code):
    cited = set(re.findall(r"\[([A-Z][A-Za-z]*\d\d)\b[^]\n]*\]", code))
    known = set(re.findall(r"^@\w+\{(\w+),", (ROOT / "docs/references.bib").read_text(), flags=re.MULTILINE))
    assert "T09" in cited
    assert cited - known == set()


def test_every_verb_is_linked_to_its_page():
    source = (ROOT / "addon/velour/core/cli/main.py").read_text(encoding="utf-8")
    verbs = set(re.findall(r'^    "(\w+)": ', source, flags=re.M))
    page = COMMAND_LINE_PAGES[0].read_text(encoding="utf-8")
    linked = set(re.findall(r"^\| `(\w+) .*\]\(cli_", page, flags=re.M))
    assert len(verbs) > 10
    assert verbs ^ linked == set()


def test_every_option_of_the_command_line_is_documented():
    text = "".join(page.read_text(encoding="utf-8") for page in COMMAND_LINE_PAGES)
    verbs = (ROOT / "addon/velour/core/cli").glob("*.py")
    source = "\n".join(path.read_text() for path in verbs)
    options = set(re.findall(r'add_argument\(\s*(?:"-o", )?"(--[a-z-]+)"', source)) - {
        "--output",
        "--version",
    }
    assert options > {"--tolerance", "--world-rotation", "--json-file", "--companding"}
    assert sorted(option for option in options if option not in text) == []


PRIVATE = re.compile(r"(?<![\w.~])/(root|home|tmp|opt|mnt)/")


def test_no_private_paths():
    assert [page.name for page in PAGES if PRIVATE.search(page.read_text(encoding="utf-8"))] == []


def _says_where(path: Path) -> bool:
    """Whether what a picture holds beside its pixels names a private path."""
    with Image.open(path) as picture:
        picture.load()  # what stands behind the pixels, too
        return bool(PRIVATE.search(str(picture.info)))


def test_no_private_paths_in_pictures(tmp_path):
    pictures = [path for ending in ("png", "jpg") for path in (ROOT / "docs").rglob(f"*.{ending}")]
    assert len(pictures) > 40
    assert [path.name for path in pictures if _says_where(path)] == []
    told = PngImagePlugin.PngInfo()
    told.add_text("Software", "cut /tmp/a.png", zip=True)
    Image.new("RGB", (1, 1)).save(tmp_path / "told.png", pnginfo=told)
    assert _says_where(tmp_path / "told.png")
