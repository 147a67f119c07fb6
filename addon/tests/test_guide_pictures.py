"""Pictures of the guide: panels keep their colors, renders have no palette, and both are small."""

from __future__ import annotations

import numpy as np
import pytest
from guide import pages
from PIL import Image


def _keep(pixels: np.ndarray, folder) -> np.ndarray:
    """What a page shows of it."""
    Image.fromarray(pixels).save(folder / "taken.png")
    kept = pages.keep(folder / "taken.png", folder / "images")
    assert [*(folder / "images").iterdir()] == [kept]
    assert kept.stat().st_size <= pages.MOST_BYTES
    with Image.open(kept) as shown:
        return np.asarray(shown.convert("RGB")).astype(int)


def test_a_panel_is_kept_as_it_is(tmp_path):
    panel = np.full((60, 80, 3), 61, np.uint8)
    panel[20:30, 10:70] = np.arange(60)[:, None] + np.array([84, 30, 12])
    np.testing.assert_array_equal(_keep(panel, tmp_path), panel)
    assert [path.name for path in (tmp_path / "images").iterdir()] == ["taken.png"]


def test_a_render_is_neither_dithered_nor_in_steps(tmp_path):
    """A sky: no row has two brightnesses, and each differs little from the next."""
    rows, columns = np.mgrid[0:256, 0:320]
    sky = np.stack((rows, 0.5 * rows + 60 + columns / 20, 0.3 * rows + 100), axis=-1).astype(np.uint8)
    shown = _keep(sky, tmp_path)
    assert [path.name for path in (tmp_path / "images").iterdir()] == ["taken.jpg"]
    assert np.abs(shown - sky).max() <= 4
    assert len(np.unique(shown[..., 0])) > 240


def test_pages_follow_a_picture_that_becomes_a_render(tmp_path, monkeypatch):
    monkeypatch.setattr(pages, "GUIDE", tmp_path)
    (tmp_path / "page.md").write_text("![a](images/taken.png) ![b](images/taken_too.png)\n")
    rng = np.random.default_rng(1)
    for pixels in (np.zeros((60, 80, 3), np.uint8), rng.integers(0, 256, (60, 80, 3), np.uint8)):
        Image.fromarray(pixels).save(tmp_path / "taken.png")
        pages.link(pages.keep(tmp_path / "taken.png", tmp_path / "images"))
    assert [path.name for path in (tmp_path / "images").iterdir()] == ["taken.jpg"]
    assert (tmp_path / "page.md").read_text() == "![a](images/taken.jpg) ![b](images/taken_too.png)\n"


def test_what_is_too_large_gets_worse_until_it_fits(tmp_path):
    rng = np.random.default_rng(1)
    grain = np.clip(
        rng.normal(128, 24, (400, 400, 1)) + np.zeros(3) + rng.normal(0, 6, (400, 400, 3)), 0, 255
    )
    _keep(grain.astype(np.uint8), tmp_path)
    with pytest.raises(SystemExit, match="is the most for a page"):
        _keep(rng.integers(0, 256, (1000, 660, 3), np.uint8), tmp_path)
