"""The scenes of the figures and of the chart."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

# The view of Velour's default camera on the bunny at 4:3, for programs with another default camera.
BUNNY_CAMERA = "-0.0168,-0.2817,0.1101,-0.0168,0.0015,0.1101,40"


@dataclass(frozen=True)
class Scene:
    """Command line options that describe a scene."""

    name: str
    mesh: Path
    up: str
    world: Path
    material: Path  # a model, or a measurement itself
    proposal: Path | None = None  # for a measurement: the model that its directions are sampled from
    camera: str | None = None

    @property
    def options(self) -> dict:
        names = ("mesh", "up", "world", "material", "proposal", "camera")
        return {name: getattr(self, name) for name in names if getattr(self, name) is not None}

    def measured(self, measurement: Path) -> Scene:
        """The same scene with the measurement itself; the model only generates samples."""
        return replace(self, name=f"{self.name} measured", material=measurement, proposal=self.material)
