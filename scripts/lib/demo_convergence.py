"""Error against time of the sampling strategies on the demo's own scene."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from velour.native import Model, Scene, images, render_job

SIZE = (160, 120)
REFERENCE_SPP = 2048
SPP = (8, 32, 128)
STRATEGIES = ("uniform", "cosine", "srbf", "light", "mis")


def measure(scene_file: Path, model_file: Path) -> dict[str, list[tuple[float, float]]]:
    """Strategy -> (seconds, relmse), against a long render of the same model: sampling error alone."""
    with _scene(scene_file, model_file) as scene:
        reference, _ = _render(scene, strategy="mis", spp=REFERENCE_SPP, seed=1)
        return {name: [_point(scene, reference, name, spp) for spp in SPP] for name in STRATEGIES}


def _point(scene: Scene, reference: np.ndarray, strategy: str, spp: int) -> tuple[float, float]:
    picture, seconds = _render(scene, strategy=strategy, spp=spp, seed=2)
    return seconds, images.compare(picture, reference)[1]


def _render(scene: Scene, **options) -> tuple[np.ndarray, float]:
    with render_job(scene, width=SIZE[0], height=SIZE[1], **options) as job:
        report = job.run()
        return job.read_pass("Combined")[..., :3].copy(), report["seconds"]


@contextmanager
def _scene(scene_file: Path, model_file: Path) -> Iterator[Scene]:
    """The scene that demo_scene.py wrote down in Blender."""
    data = np.load(scene_file)
    with Scene() as scene, Model.load(model_file) as model:
        subject = scene.add_model_material(model)
        ground = scene.add_principled_material(base_color=data["ground_color"], roughness=0.9, specular=0.2)
        for name, material in (("subject", subject), ("ground", ground)):
            mesh, _ = scene.add_mesh(data[f"{name}_positions"], data[f"{name}_triangles"])
            scene.add_instance(mesh, data[f"{name}_matrix"], [material])
        scene.set_world_file(str(data["world"]))
        scene.set_camera("perspective", data["camera_matrix"], data["camera_window"])
        scene.commit()
        yield scene
