"""The pages of the user guide, taken apart. No Blender is needed to import this."""

import re
from pathlib import Path

FOLDER = Path(__file__).resolve().parents[2] / "docs/guide"
PAGES = sorted(FOLDER.glob("*.md"))
_BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_BOLD = re.compile(r"\*\*([^*]+)\*\*")
_ITALIC = re.compile(r"\*([^*]+)\*")


def snippets(page):
    """[(language, text)] in the order in which they stand."""
    return _BLOCK.findall(page.read_text(encoding="utf-8"))


def pictures(page):
    """[(alternative text, path)]"""
    found = re.findall(r"!\[([^]]*)\]\(([^)]+)\)", page.read_text(encoding="utf-8"))
    return [(text, page.parent / path) for text, path in found]


def our_labels(page):
    """What stands in bold: names that Velour shows."""
    return _BOLD.findall(_prose(page))


def blenders_labels(page):
    """What stands in italics: names that Blender shows; each part of a path."""
    return [part for path in _ITALIC.findall(_BOLD.sub("", _prose(page))) for part in path.split(" > ")]


def menu_paths(page):
    """[(a path in Blender's menus, our entry at its end)]"""
    return re.findall(r"(?<!\*)\*([^*]+)\* > \*\*([^*]+)\*\*", _prose(page))


def messages(page):
    """What Velour says, quoted."""
    return re.findall(r'"([^"]+)"', _prose(page))


def _prose(page):
    """In one line, without snippets; of links and pictures their text."""
    text = _BLOCK.sub("", page.read_text(encoding="utf-8"))
    return " ".join(re.sub(r"!?\[([^]]*)\]\([^)]*\)", r"\1", text).split())
