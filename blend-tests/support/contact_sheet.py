"""Pictures of steps on one sheet, each above its caption. No Blender is needed to import this."""

import numpy as np

from . import framebuffer

_COLUMNS = 3
_MARGIN = 12  # pixels between pictures
_PAPER, _INK = 32, 230
_RING = (9, 13)  # radii of the mark of a click
_RING_COLOR = (255, 120, 0)


def marked(pixels, x, y):
    """A copy with a ring around a place. pixels: [height x width x 3] bytes, the lowest row first."""
    rows, columns = np.ogrid[: pixels.shape[0], : pixels.shape[1]]
    distance = np.hypot(rows - y, columns - x)
    found = pixels.copy()
    found[(distance >= _RING[0]) & (distance <= _RING[1])] = _RING_COLOR
    return found


def sheet(pictures, captions, columns=_COLUMNS):
    """[height x width x 3] bytes: pictures of the same size at half of it, the first at the upper left.

    captions: [height x width] in [0, 1], one a picture."""
    halves = [_half(picture) for picture in pictures]
    height, width = halves[0].shape[:2]
    line = max(caption.shape[0] for caption in captions)
    cell = (height + line + 2 * _MARGIN, width + _MARGIN)
    rows = -(-len(pictures) // columns)
    found = np.full((rows * cell[0] + _MARGIN, columns * cell[1] + _MARGIN, 3), _PAPER, np.uint8)
    for number, (picture, caption) in enumerate(zip(halves, captions, strict=True)):
        bottom = (rows - 1 - number // columns) * cell[0] + _MARGIN
        left = number % columns * cell[1] + _MARGIN
        found[bottom + line + _MARGIN // 2 :][:height, left : left + width] = picture
        letters = caption[:, :width, None]
        place = found[bottom : bottom + letters.shape[0], left : left + letters.shape[1]]
        place[:] = np.round(_PAPER + (_INK - _PAPER) * letters)
    return found


def _half(pixels):
    height, width = (side // 2 for side in pixels.shape[:2])
    blocks = pixels[: 2 * height, : 2 * width].reshape(height, 2, width, 2, 3)
    return blocks.mean(axis=(1, 3)).round().astype(np.uint8)


def write(folder, name, found):
    """Writes a sheet to FOLDER/NAME.png, and with those of other tests beside FOLDER to NAME.png there."""
    folder.mkdir(parents=True, exist_ok=True)
    framebuffer.write_png(folder / f"{name}.png", found)
    np.save(folder / f"{name}.npy", found)
    all_of_them = [np.load(path) for path in sorted(folder.parent.glob(f"*/{name}.npy"))]
    framebuffer.write_png(folder.parent / f"{name}.png", stacked(all_of_them))


def stacked(sheets):
    """Sheets below each other, the first at the top."""
    width = max(sheet.shape[1] for sheet in sheets)
    padded = [
        np.pad(sheet, ((0, 0), (0, width - sheet.shape[1]), (0, 0)), constant_values=_PAPER)
        for sheet in sheets
    ]
    return np.concatenate(padded[::-1])
