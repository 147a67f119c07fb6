"""The scenes of the chart: those of the figures under two environments, and one under a synthetic sky."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import figure_scenes
import synthetic_sky
from renders import Renders
from scenes import Scene

STUDIO, SUNSET, SKY = "studio_small_03", "venice_sunset", "synthetic sky"


@dataclass(frozen=True)
class ChartScene:
    scene: Scene
    measurement: Path
    material: str
    world: str

    @property
    def file_name(self) -> str:
        return self.scene.name.replace(", ", "-").replace(" ", "_").lower()


def scenes(data: Path, renders: Renders, worlds: tuple[str, ...]) -> list[ChartScene]:
    subjects = figure_scenes.subjects(data, renders)
    found = [_scene(subject, subject.scene(world, data), world) for subject in subjects for world in worlds]
    sky = renders.settings.folder / "synthetic_sky.exr"
    if not sky.is_file():
        synthetic_sky.write(sky)
    bunny = subjects[0]
    lit = Scene(f"{bunny.name}, {SKY}", bunny.mesh, "y", sky, bunny.model)
    return [*found, _scene(bunny, lit, SKY)]


def _scene(subject: figure_scenes.Subject, scene: Scene, world: str) -> ChartScene:
    return ChartScene(scene, subject.measurement, subject.measurement.stem.replace("_", "-"), world)


def sun_lobes(scene: Scene, renders: Renders) -> synthetic_sky.SunLobes:
    """What product sampling keeps of the synthetic sun, read from the mixture that a small render caches."""
    folder = renders.settings.folder / "sun"
    folder.mkdir(exist_ok=True)
    renders.render(scene, 8, size=(16, 12), strategy="product", cache=str(folder))
    return synthetic_sky.sun_lobes(max(folder.glob("sky-*.exr"), key=lambda path: path.stat().st_mtime))
