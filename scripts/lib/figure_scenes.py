"""The three scenes of the dissertation's figures 7.11 to 7.13."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import data_files
import headless_blender
from renders import Renders, key
from scenes import Scene

_SUZANNE_LEVELS = 3  # 62,976 triangles, about as many as the bunny's


@dataclass(frozen=True)
class Subject:
    figure: str
    name: str
    mesh: Path
    measurement: Path
    model: Path
    fit: dict

    def scene(self, world: str, data: Path) -> Scene:
        """The scene with the model, which is both evaluated and sampled."""
        return Scene(f"{self.name}, {world}", self.mesh, "y", data_files.world(data, world), self.model)


def subjects(data: Path, renders: Renders) -> list[Subject]:
    """The subjects whose inputs exist. Prints which are omitted."""
    found = [
        ("7.11", "bunny", data_files.mesh(data, "bunny"), data_files.merl(data, "blue-metallic-paint")),
        ("7.12", "buddha", data_files.mesh(data, "buddha"), data / "brdf/krylon_blue.brdf"),
    ]
    if suzanne := _suzanne(renders):
        found.append(("7.13", "Suzanne", suzanne, data_files.merl(data, "nickel")))
    return [_fitted(*subject, renders) for subject in found]


def _fitted(figure: str, mesh_name: str, mesh: Path, measurement: Path, renders: Renders) -> Subject:
    model, fit = renders.fit(measurement)
    material = measurement.stem.replace("_", "-")
    return Subject(figure, f"{mesh_name}, {material}", mesh, measurement, model, fit)


def _suzanne(renders: Renders) -> Path | None:
    """Blender's own monkey, subdivided, in place of the Venus, which is not available."""
    path = renders.settings.folder / f"suzanne-{key({'levels': _SUZANNE_LEVELS})}.obj"
    partial = path.with_suffix(".partial.obj")
    task = {"path": str(partial), "levels": _SUZANNE_LEVELS}
    if not path.is_file():
        try:
            headless_blender.run("export_suzanne.py", task, renders.settings.folder / "suzanne.log")
            partial.replace(path)
        except headless_blender.BlenderError as error:
            print(f"Suzanne is left out: {error}")
            return None
    return path
