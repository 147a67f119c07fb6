"""Reports pages of measurements whose sources changed since the commit that they name. Never a failure."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

_COMMIT = re.compile(r"(?:one run|this page): [0-9-]+,\s+commit\s+([0-9a-f]{7,40})")
_FITS = ("brdf", "math", "model")
_PICTURES = ("light", "material", "math", "render", "scene")
_BTFS = ("btf", "capture", "math")
# Folders of native/src that the script of each page measures.
PAGES = {
    "docs/results/blender_export.md": ("capi", "scene"),
    "docs/results/blender_parity.md": _PICTURES,
    "docs/results/chart/README.md": _FITS + _PICTURES,
    "docs/results/chart_btf.md": _BTFS,
    "docs/results/equal_noise.md": _PICTURES,
    "docs/results/figures/README.md": _FITS + _PICTURES,
    "docs/results/for_scene.md": (*_FITS, *_PICTURES, "usage"),
    "docs/results/models.md": _FITS,
    "docs/results/night.md": _PICTURES,
    "docs/results/perceptual.md": _FITS + _PICTURES,
    "docs/results/performance.md": _PICTURES,
    "docs/results/viewport.md": _PICTURES,
    "docs/results/votf_numbers.md": (*_BTFS, *_PICTURES, "votf"),
}


def told(root: Path) -> list[str]:
    """A sentence for each page that may be outdated; a single one if these sources have no git history."""
    if _git(root, "rev-parse", "HEAD") is None:
        return ["Whether pages of measurements are old is not known: these sources have no git history."]
    sentences = []
    for page, folders in PAGES.items():
        if not (root / page).exists():
            continue
        found = _COMMIT.search((root / page).read_text(encoding="utf-8"))
        sources = [f"native/src/{folder}" for folder in dict.fromkeys(folders)]
        count = found and _git(root, "rev-list", "--count", f"{found[1]}..HEAD", "--", *sources)
        if count is None:
            sentences.append(f"{page}: it names no commit of this history, so its age is not known.")
        elif count != "0":
            sentences.append(
                f"{page}: measured at {found[1]}; {count} commits since then changed what it measures."
            )
    return sentences


def _git(root: Path, *arguments: str) -> str | None:
    """Output of a git command; None if it fails."""
    done = subprocess.run(["git", "-C", root, *arguments], capture_output=True, text=True)
    return done.stdout.strip() if done.returncode == 0 else None
