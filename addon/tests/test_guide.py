"""The pictures of the user guide: there, described, small, and of something."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import ROOT
from support import guide

MOST_BYTES, MOST_BYTES_IN_ALL = 150_000, 1_500_000
MOST_WIDTH = 1000
IMAGES = ROOT / "docs/guide/images"


def _is_blank(pixels: np.ndarray) -> bool:
    """Few colors, or one that all but a hundredth of the pixels have."""
    flat = np.round(pixels.reshape(-1, pixels.shape[-1]) * 255).astype(np.int64)
    colors, counts = np.unique(flat, axis=0, return_counts=True)
    return len(colors) < 8 or counts.max() > 0.99 * counts.sum()


def _pictures() -> list[tuple[str, object]]:
    return [picture for page in guide.PAGES for picture in guide.pictures(page)]


def test_pages_are_found():
    assert len(guide.PAGES) == 12
    assert len(_pictures()) > 12


@pytest.mark.parametrize("path", sorted({path for _, path in _pictures()}), ids=lambda path: path.stem)
def test_a_picture_shows_something(path):
    from velour.native import images

    pixels = images.read(path)
    assert not _is_blank(pixels)
    assert 200 < pixels.shape[1] <= MOST_WIDTH
    assert path.stat().st_size < MOST_BYTES


def test_a_blank_picture_is_seen(tmp_path):
    from velour.native import images

    almost = np.zeros((100, 100, 3), np.float32)
    almost[0, :50] = np.linspace(0, 1, 50)[:, None]  # a mouse pointer, say
    for name, pixels in (("gray.exr", np.full((100, 100, 3), 0.2, np.float32)), ("almost.exr", almost)):
        images.write(tmp_path / name, pixels)
        assert _is_blank(images.read(tmp_path / name))


def test_pictures_are_described_and_few():
    assert [path for text, path in _pictures() if len(text) < 20] == []
    assert sorted(IMAGES.glob("*")) == sorted({path for _, path in _pictures()})  # none is left over
    assert sum(path.stat().st_size for path in IMAGES.glob("*")) < MOST_BYTES_IN_ALL


def test_every_page_is_in_the_index():
    index = (guide.FOLDER / "README.md").read_text(encoding="utf-8")
    assert [
        page.name for page in guide.PAGES if page.name != "README.md" and f"({page.name})" not in index
    ] == []
