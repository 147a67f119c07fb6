"""Pictures as a page can carry them."""

from __future__ import annotations

from pathlib import Path

from PIL import Image

COLORS = 256
MOST_BYTES = 150_000


def keep(path: Path, to: Path) -> None:
    """With a palette: a third of the bytes."""
    with Image.open(path) as picture:
        small = picture.convert("RGB").quantize(COLORS, method=Image.Quantize.MEDIANCUT)
    to.parent.mkdir(parents=True, exist_ok=True)
    small.save(to, optimize=True)
    if to.stat().st_size > MOST_BYTES:
        raise SystemExit(
            f"guide: {to} has {to.stat().st_size} bytes; {MOST_BYTES} is the most that a page carries."
        )
    print(f"  {to.name}: {small.width} x {small.height}, {to.stat().st_size // 1000} kB", flush=True)
