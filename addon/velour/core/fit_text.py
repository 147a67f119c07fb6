"""What artists are told of a fit of a BTF before they begin it."""

from __future__ import annotations

from pathlib import Path

from ..native import Btf, compress_size
from .fit_time import fit_of, time_text
from .sizes import data_size


def fit_text(btf: Btf, asked: dict, threads: int, folder: Path) -> str:
    """`asked`: options of compress_job(); `folder`: what fits are remembered in."""
    size = compress_size(btf, threads=threads, **asked)
    time = time_text(folder, fit_of(btf.info(), asked, threads))
    parts = [time[0].upper() + time[1:], f"about {data_size(size.memory)} of memory beside the program"]
    if asked["tolerance"] > 0 and not asked["bytes"]:
        parts.append("a model as large as the error takes")
    else:
        parts.append(f"a model of {data_size(size.bytes)} at most")
    return "; ".join(parts)
