"""For scripts/realtime, once scenes are drawn: the ray tracer's picture, real time's, the difference."""

import sys
from pathlib import Path

import numpy as np
from velour.native import images

_TIMES, _GREY = 10, 0.214  # the difference, about the middle of what a screen shows


def main() -> int:
    traced, drawn = np.load(sys.argv[1])[..., :3]
    white = np.percentile(traced, 99.5)
    difference = _GREY + _TIMES * (drawn - traced) / white
    row = np.concatenate((traced / white, drawn / white, difference), axis=1)
    images.write(Path(sys.argv[2]), np.ascontiguousarray(np.clip(row, 0, 1), np.float32))
    return 0


if __name__ == "__main__":
    sys.exit(main())
