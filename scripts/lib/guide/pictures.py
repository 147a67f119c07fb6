"""Compresses pictures for the pages."""

from __future__ import annotations

from pathlib import Path

from PIL import Image

MOST_BYTES = 150_000
_OF_PANELS = 2000  # maximum number of colors of panels; more are a render, which a palette would degrade
_PALETTES = (256, 128, 64)  # numbers of colors, the best first
_QUALITIES = (94, 90, 86, 80)


def keep(path: Path, folder: Path) -> Path:
    """Saves a picture at the best quality within MOST_BYTES: panels as PNG with a palette, renders as JPEG.
    Returns the file."""
    with Image.open(path) as opened:
        picture = opened.convert("RGB")
    is_render = picture.getcolors(_OF_PANELS) is None
    kinds = ("jpg", "png") if is_render else ("png", "jpg")
    to, other = (folder / f"{path.stem}.{kind}" for kind in kinds)
    folder.mkdir(parents=True, exist_ok=True)
    for level in _QUALITIES if is_render else _PALETTES:
        (_save_jpeg if is_render else _save_png)(picture, to, level)
        if to.stat().st_size <= MOST_BYTES:
            print(
                f"  {to.name}: {picture.width} x {picture.height}, {to.stat().st_size // 1000} kB", flush=True
            )
            other.unlink(missing_ok=True)
            return to
    raise SystemExit(f"guide: {to} has {to.stat().st_size} bytes; {MOST_BYTES} is the most for a page.")


def _save_png(picture: Image.Image, to: Path, colors: int) -> None:
    picture.quantize(colors, method=Image.Quantize.MEDIANCUT).save(to, optimize=True)


def _save_jpeg(picture: Image.Image, to: Path, quality: int) -> None:
    """Without chroma subsampling, for the text of panels."""
    picture.save(to, quality=quality, subsampling=0)
