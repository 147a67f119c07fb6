"""Text for the artist before the fit of a BTF."""

from __future__ import annotations

from pathlib import Path

from ..native import Btf, compress_size
from .fit_time import fit_of, time_text
from .sizes import data_size


def fit_text(btf: Btf, asked: dict, threads: int, folder: Path) -> str:
    """`asked`: options of compress_job(); `folder`: where fits are recorded."""
    size = compress_size(btf, threads=threads, **asked)
    time = time_text(folder, fit_of(btf.info(), asked, threads))
    parts = [time[0].upper() + time[1:], f"about {data_size(size.memory)} of additional memory"]
    if asked["tolerance"] > 0 and not asked["bytes"]:
        parts.append("the smallest model within Max Error")
    else:
        parts.append(f"model size at most {data_size(size.bytes)}")
    return "; ".join(parts)
