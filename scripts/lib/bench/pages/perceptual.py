"""What a tolerance of the fit looks like: FLIP between renders of models and of their measurements."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .. import charts, flip_metric, project
from ..reference import silhouette
from ..run import Run
from ..scenes import STUDIO, SUNSET, Scene, write_sphere

CSV = "perceptual/perceptual.csv"
PAGES = {"perceptual.md": "perceptual"}
SETTINGS = {
    "size": ((200, 150), (64, 48)),
    "spp": (96, 16),
    # Fits with a loose tolerance are often far better than that; few lobes show what large errors look like.
    "tolerances": ((0.005, 0.01, 0.02, 0.04, 0.08, 0.16), (0.02,)),
    "materials": (99, 1),
    "worlds": ((STUDIO, SUNSET), (SUNSET,)),
}
DEFAULT, FEW = (0.02, 16), (0.02, 2)  # tolerance, maximum number of lobes
# Bounds of the mean and of the 99th percentile, as CIELAB differences on uniform gray: observers do not
# notice 1 [MT11]; 2.3 is a just noticeable difference [MVO94].
THRESHOLDS = (1.0, 2.3)


def measure(run: Run) -> dict:
    own, subjects = run.settings, run.materials()
    mean, percentile = map(flip_metric.of_lightness, THRESHOLDS)
    bunny = project.mesh(run.data, "bunny")
    meshes = {"sphere": (run.made("sphere.obj", write_sphere), "z"), "bunny": (bunny, "y")}
    orders = [*((tolerance, DEFAULT[1]) for tolerance in own.tolerances), FEW]
    count = len(subjects) * len(meshes) * len(own.worlds) * (2 * len(orders) + 1)
    run.expect(own.spp, count=count)
    silhouettes: dict[str, np.ndarray] = {}  # they depend only on the mesh
    rows = []
    for name, measurement in subjects:
        for order in orders:
            model, fit = run.fit(measurement, "parametric", tolerance=order[0], max_lobes=order[1])
            for mesh, world in ((mesh, world) for mesh in meshes for world in own.worlds):
                scene = Scene(f"{mesh}, {name}, {world}", *meshes[mesh], run.world(world), model)
                if mesh not in silhouettes:
                    silhouettes[mesh] = silhouette(run, scene, own.size)
                about = {"material": name, "scene": f"{mesh}, {world}", "tolerance": order[0]}
                about |= {"max_lobes": order[1], "relative_l2": fit["relative_l2"]}
                rows.append(about | _seen(run, scene, measurement, silhouettes[mesh], order == DEFAULT))
    thresholds = {"mean_threshold": mean, "percentile_threshold": percentile}
    return {"conditions": run.conditions(**thresholds), "rows": rows}


def _seen(run: Run, scene: Scene, measurement: Path, where: np.ndarray, with_noise: bool) -> dict:
    """Model against measurement, both with directions sampled from the model; and the measurement against
    itself with another seed."""

    def picture(of: Scene, seed: int = run.seed) -> np.ndarray:
        return run.render(of, run.settings.spp, seed=seed, strategy="product").pixels

    reference = picture(scene.measured(measurement))
    found = dict(
        zip(("flip_mean", "flip_99"), flip_metric.of_object(reference, picture(scene), where), strict=True)
    )
    if with_noise:
        other = picture(scene.measured(measurement), run.seed + 1)
        found |= dict(
            zip(("noise_mean", "noise_99"), flip_metric.of_object(reference, other, where), strict=True)
        )
    return found


def values(found: dict) -> dict:
    rows, (mean, percentile) = found["rows"], _thresholds(found)
    orders: dict[tuple, list[dict]] = {}
    for row in rows:
        row["is_below"] = row["flip_mean"] < mean and row["flip_99"] < percentile
        orders.setdefault((row["tolerance"], row["max_lobes"]), []).append(row)
    at = orders[DEFAULT]
    return {
        "mean_threshold": mean,
        "percentile_threshold": percentile,
        "materials_measured": len({row["material"] for row in rows}),
        "worlds_named": " and ".join(dict.fromkeys(f"`{row['scene'].split(', ')[1]}`" for row in rows)),
        "below": sum(row["is_below"] for row in at),
        "at_default": len(at),
        "means_below": sum(row["flip_mean"] < mean for row in at),
        "orders": [_of_order(*item) for item in orders.items()],
    }


def _thresholds(found: dict) -> list[float]:
    return [float(found["conditions"][f"{name}_threshold"]) for name in ("mean", "percentile")]


def draw(output: Path, found: dict) -> None:
    rows, panels = found["rows"], []
    for material in dict.fromkeys(row["material"] for row in rows):
        own = [row for row in rows if row["material"] == material]
        panels.append(
            (material, {"mean": _worst(own, "flip_mean"), "99th percentile": _worst(own, "flip_99")})
        )
    chart, axes = output / "perceptual/flip_by_error.png", ("relative L2 of the fit", "FLIP")
    charts.curves(chart, panels, *axes, levels=_thresholds(found))


def _of_order(order: tuple[float, int], rows: list[dict]) -> dict:
    """Median and maximum of each number."""
    tolerance, lobes = order
    found = {"order": f"{tolerance:g}" + (f", {lobes} lobes" if lobes != DEFAULT[1] else "")}
    for value in ("relative_l2", "flip_mean", "flip_99"):
        values = [row[value] for row in rows]
        found[value] = np.median(values), max(values)
    return found | {"below": sum(row["is_below"] for row in rows), "count": len(rows)}


def _worst(rows: list[dict], value: str) -> list[tuple[float, float]]:
    """The worst scene of each fit of a material: (error of the fit, value)."""
    errors = sorted({row["relative_l2"] for row in rows})
    return [(error, max(row[value] for row in rows if row["relative_l2"] == error)) for error in errors]
