"""Plots error against lobes and error against bytes, with a panel per material."""

from __future__ import annotations

from pathlib import Path

import plots
from model_runs import PEERS, TOLERANCE, Result

# Number of lobes that a renderer evaluates for each peer, comparable to those of a fit.
_PEER_LOBES = {"ggx": 1, "principled": 2}


def draw(folder: Path, results: list[Result]) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    lobes = {result.name: _by_lobes(result) for result in results}
    plots.errors_by_size(folder / "error_by_lobes.png", lobes, "lobes (scattered: a view)", TOLERANCE)
    sizes = {result.name: _by_bytes(result) for result in results}
    plots.errors_by_size(folder / "error_by_bytes.png", sizes, "bytes", TOLERANCE)


def _by_lobes(result: Result) -> dict[str, list[tuple[float, float]]]:
    curves = {
        model: [(bound, report["relative_l2"]) for bound, report in of.items()]
        for model, of in result.lobes.items()
    }
    return curves | {peer: [(_PEER_LOBES[peer], result.rows[peer].report["relative_l2"])] for peer in PEERS}


def _by_bytes(result: Result) -> dict[str, list[tuple[float, float]]]:
    curves = {
        model: [(report["bytes"], report["relative_l2"]) for report in of.values()]
        for model, of in result.sizes.items()
    }
    peers = {peer: result.rows[peer] for peer in PEERS}
    return curves | {peer: [(row.bytes, row.report["relative_l2"])] for peer, row in peers.items()}
