"""Where results are kept that can always be made again."""

from __future__ import annotations

import os
from pathlib import Path


def user_cache_folder() -> Path:
    """${XDG_CACHE_HOME:-~/.cache}/velour; it need not exist."""
    base = os.environ.get("XDG_CACHE_HOME", "")
    # The XDG specification: a relative path counts as unset.
    return (Path(base) if os.path.isabs(base) else Path.home() / ".cache") / "velour"
