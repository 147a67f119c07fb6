"""Pictures as a page can carry them."""

from __future__ import annotations

from pathlib import Path

from PIL import Image

COLORS = 256
MOST_BYTES = 150_000
_OF_A_RENDER = 20_000  # colours; panels have a few hundred


def keep(path: Path, to: Path) -> None:
    """With a palette: a third of the bytes. Renders are dithered where that is not too much."""
    to.parent.mkdir(parents=True, exist_ok=True)
    with Image.open(path) as opened:
        picture = opened.convert("RGB")
    palette = picture.quantize(COLORS, method=Image.Quantize.MEDIANCUT)
    if picture.getcolors(_OF_A_RENDER) is None:
        picture.quantize(palette=palette, dither=Image.Dither.FLOYDSTEINBERG).save(to, optimize=True)
    if picture.getcolors(_OF_A_RENDER) is not None or to.stat().st_size > MOST_BYTES:
        palette.save(to, optimize=True)
    if to.stat().st_size > MOST_BYTES:
        raise SystemExit(f"guide: {to} has {to.stat().st_size} bytes; {MOST_BYTES} is the most for a page.")
    print(f"  {to.name}: {picture.width} x {picture.height}, {to.stat().st_size // 1000} kB", flush=True)
