"""Fits, comparisons and costs for docs/results/models.md, kept under a hash of all that they depend on."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from renders import Renders, flags
from velour.core import files
from velour.native import Measurement, fit_job, table
from velour_cli import ROOT, velour, velour_to_file

MODELS = table.MODELS
PEERS = ("ggx", "principled")
TOLERANCE = 0.02
_PROGRAM = ROOT / "build/release/native/bench/evaluation_cost"
_UNBOUND = 1e-6  # a tolerance that no fit meets, so that only the requested bound stops it


@dataclass(frozen=True)
class Row:
    """One model of one material."""

    report: dict  # report of the fit, or of the comparison with a peer
    cost: dict  # nanoseconds
    info: dict  # info of the model file; empty for peers

    @property
    def bytes(self) -> int:
        """Size of the file, or of the parameters of a peer, which has no file."""
        return self.report.get("bytes", self.report["parameter_bytes"])


@dataclass(frozen=True)
class Result:
    """One material."""

    name: str
    bytes: int  # size of the measurement
    noise: Mapping[str, float | None]
    cost: dict  # evaluation cost of the measurement itself
    rows: dict[str, Row]
    lobes: dict[str, dict[int, dict]]  # model: maximum number of lobes: report of the fit
    sizes: dict[str, dict[int, dict]]  # model: maximum bytes: report; without bounds that no model meets
    unturned: dict  # report of the per-view fit that mixes slices without aligning them


class ModelRuns:
    def __init__(self, renders: Renders):
        self._kept = renders
        self._common = {"seed": renders.settings.seed, "threads": renders.settings.threads}

    def announce(self, materials: int, points: int) -> None:
        self._kept.progress.expect(1, 1 + materials * (2 + len(MODELS) * (points + 2) + 2 * len(PEERS)))

    def result(self, name: str, measurement: Path, extent) -> Result:
        rows = {model: self._model(name, measurement, model) for model in MODELS}
        compared = {peer: self._peer(name, measurement, peer) for peer in PEERS}
        points = {
            bound: {
                model: {value: self._fit(name, measurement, model, {bound: value}) for value in values}
                for model in MODELS
            }
            for bound, values in (("max-lobes", extent.lobes), ("bytes", extent.bytes))
        }
        sizes = {m: {b: r for b, r in of.items() if "refused" not in r} for m, of in points["bytes"].items()}
        return Result(
            name=name,
            bytes=measurement.stat().st_size,
            noise=next(iter(compared.values())).report["noise_by_view_angle"],
            cost=self._cost(name, measurement),
            rows=rows | compared,
            lobes=points["max-lobes"],
            sizes=sizes,
            unturned=self._unturned(name, measurement),
        )

    def floor(self) -> dict:
        """Cost of the calls alone, without arithmetic."""
        return self._cost("nothing", "floor")

    def _model(self, name: str, measurement: Path, model: str) -> Row:
        report = self._fit(name, measurement, model, {})
        path = self._path(measurement, model, {})
        return Row(report, self._cost(f"{name}, {model}", path), velour("info", path))

    def _peer(self, name: str, measurement: Path, peer: str) -> Row:
        def run(report: Path) -> dict:
            return velour_to_file(report, "compare", measurement, f"--{peer}")

        report = self._keep(f"{peer} of {name}", "peer", {"measurement": measurement, "peer": peer}, run)
        return Row(report, self._cost(f"{name}, {peer}", measurement, peer), {})

    def _parameters(self, measurement: Path, model: str, bounds: dict) -> dict:
        tolerance = _UNBOUND if "max-lobes" in bounds else TOLERANCE
        own = {"measurement": measurement, "model": model, "tolerance": tolerance, **bounds}
        return {**own, **self._common}

    def _path(self, measurement: Path, model: str, bounds: dict) -> Path:
        return self._kept.stem("fit", self._parameters(measurement, model, bounds)).with_suffix(".velour")

    def _fit(self, name: str, measurement: Path, model: str, bounds: dict) -> dict:
        """The report of a fit; {"refused": True} if no model of the measurement is that small."""
        parameters = self._parameters(measurement, model, bounds)
        options = {key: value for key, value in parameters.items() if key != "measurement"}
        out = self._path(measurement, model, bounds)

        def run(report: Path) -> dict:
            try:
                return velour_to_file(report, "fit", measurement, "-o", out, *flags(options))
            except subprocess.CalledProcessError as error:
                if error.returncode != 1 or "bytes" not in bounds:
                    raise
                files.write_json(report, {"refused": True})
                return {"refused": True}

        bound = "".join(f", {key} {value}" for key, value in bounds.items())
        return self._keep(f"{model} fit of {name}{bound}", "fit", parameters, run)

    def _unturned(self, name: str, measurement: Path) -> dict:
        options = {"model": "scattered", "tolerance": TOLERANCE, "align_views": 0, **self._common}

        def run(report: Path) -> dict:
            with Measurement.load(measurement) as source, fit_job(source, **options) as job:
                found = job.run()
            files.write_json(report, found)
            return found

        return self._keep(f"unturned fit of {name}", "unturned", {"measurement": measurement, **options}, run)

    def _cost(self, name: str, file: Path | str, peer: str = "") -> dict:
        """Nanoseconds; empty if the program is not built."""
        if not _PROGRAM.is_file():
            return {}

        def run(report: Path) -> dict:
            command = [_PROGRAM, file, *([peer] if peer else [])]
            found = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)
            files.write_json(report, found)
            return found

        parameters = {"file": file, "peer": peer, "program": _PROGRAM}
        return self._keep(f"cost of {name}", "cost", parameters, run)

    def _keep(self, label: str, name: str, parameters: dict, run) -> dict:
        return self._kept.keep(label, name, parameters, run, 1)
