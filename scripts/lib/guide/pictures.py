"""Pictures as a page can carry them."""

from __future__ import annotations

from pathlib import Path

from PIL import Image

MOST_BYTES = 150_000
# Palettes, the best first: its colours, and whether they are dithered.
_PALETTES = ((256, True), (256, False), (128, False), (64, False))
_OF_A_RENDER = 20_000  # colours; panels have a few hundred, which dithering would blur


def keep(path: Path, to: Path) -> None:
    """With the best palette that a page can carry: a third of the bytes, or less."""
    to.parent.mkdir(parents=True, exist_ok=True)
    with Image.open(path) as opened:
        picture = opened.convert("RGB")
    is_render = picture.getcolors(_OF_A_RENDER) is None
    for colors, is_dithered in _PALETTES:
        if is_dithered and not is_render:
            continue
        _with_palette(picture, colors, is_dithered).save(to, optimize=True)
        if to.stat().st_size <= MOST_BYTES:
            print(
                f"  {to.name}: {picture.width} x {picture.height}, {to.stat().st_size // 1000} kB", flush=True
            )
            return
    raise SystemExit(f"guide: {to} has {to.stat().st_size} bytes; {MOST_BYTES} is the most for a page.")


def _with_palette(picture: Image.Image, colors: int, is_dithered: bool) -> Image.Image:
    palette = picture.quantize(colors, method=Image.Quantize.MEDIANCUT)
    if not is_dithered:
        return palette
    return picture.quantize(palette=palette, dither=Image.Dither.FLOYDSTEINBERG)
