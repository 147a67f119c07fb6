"""What artists are told of a fit of a BTF before they begin it."""

from __future__ import annotations

from pathlib import Path

from .fit_size import Extent, fit_memory, most_bytes
from .fit_time import fit_of, time_text


def fit_text(info: dict, asked: dict, threads: int, folder: Path) -> str:
    """`info`: of the BTF; `asked`: options of compress_job(); `folder`: what fits are remembered in."""
    of, method, size = Extent.of(info), asked["method"], asked["bytes"]
    searched = asked["tolerance"] > 0
    memory = fit_memory(of, method, size, searched, threads)
    time = time_text(folder, fit_of(info, asked, threads))
    parts = [time[0].upper() + time[1:], f"about {memory / 1e6:,.0f} MB of memory beside the program"]
    if searched and not size:
        parts.append("a model as large as the error takes")
    else:
        parts.append(f"a model of {_size(most_bytes(of, method, size))} at most")
    return "; ".join(parts)


def _size(count: int) -> str:
    return f"{count / 1e6:,.2f} MB" if count >= 100_000 else f"{count / 1e3:.0f} kB"
