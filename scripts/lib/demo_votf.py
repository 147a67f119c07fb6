"""The demonstration of shells: a ball and a cloth of net over a floor, beside the same in real geometry."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from pathlib import Path

import demo_material
import numpy as np
from demo_difference import write_difference
from demo_parts import Part, Parts
from steps import Steps
from velour.core import files
from velour.core.machine import machine
from velour.native import Model, Scene, Tile, images, library, render_job, votf_job
from votf_shapes import Cloth, Sphere, Surface, smooth_mesh, structured_mesh

_SIZE = (768, 432)
_SAMPLES = 64
_ROWS = 12  # tiles from pole to pole of the ball
_CLOTH = 10  # tiles per side of the cloth
_UNMOVED = ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0))


PART = Part(
    "votf",
    "the wire net",
    {"fitting the metal": 3, "tracing the shell": 5, "rendering the shell": 10, "rendering the geometry": 20},
    (
        "metal.velour",
        "net.velour",
        *(f"{name}.{suffix}" for name in ("model", "reference", "difference") for suffix in ("exr", "png")),
    ),
)


def demonstrate(folder: Path, measurement: Path, parts: Parts) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    report = parts.make(PART, folder, {"measurement": measurement}, lambda s: _make(folder, measurement, s))
    report |= {"version": library.system()["version"], "machine": machine()}
    files.write_json(folder / "report.json", report)
    _tell(folder, report)


def _make(folder: Path, measurement: Path, steps: Steps) -> dict:
    metal = folder / "metal.velour"
    steps.begin("fitting the metal")
    demo_material.save_fit(measurement, metal)
    return make_pictures(folder, metal, _SIZE, _SAMPLES, steps.begin)


def make_pictures(
    folder: Path, material: Path, size: tuple[int, int], samples: int, begin: Callable[[str], None]
) -> dict:
    """`material`: a model of a BRDF, for the net. `begin` is called with the name of each step."""
    report = {}
    with contextlib.ExitStack() as handles:
        plain = handles.enter_context(Model.load(material))
        tile = handles.enter_context(Tile.create("net"))
        begin("tracing the shell")
        shell, report["votf"] = _with_shell(plain, tile)
        handles.enter_context(shell)
        shell.save(folder / "net.velour")
        for name, model in (("model", shell), ("reference", plain)):
            begin(f"rendering the {'shell' if model is shell else 'geometry'}")
            with Scene() as scene:
                _add_objects(scene, tile, model, name == "reference")
                report[name] = _render(scene, folder / name, size, samples)
    report["rmse"], report["relmse"] = write_difference(folder)
    return report


def _with_shell(model: Model, tile: Tile) -> tuple[Model, dict]:
    with Scene() as scene:
        mesh, materials = tile.add_to(scene)
        scene.add_instance(mesh, _UNMOVED, materials)
        scene.commit()
        info = tile.info()
        with votf_job(scene, model, origin=(0, 0), period=info["period"], source=info["kind"]) as job:
            report = job.run()
            return job.result_model(), report


def _add_objects(scene: Scene, tile: Tile, model: Model, geometry: bool) -> None:
    net = scene.add_model_material(model)
    period = tile.info()["period"][0]
    for surface, place in _placed(period):
        if geometry:
            number, _ = scene.add_mesh(**structured_mesh(surface, tile.mesh()._asdict(), period))
        else:
            number, _ = scene.add_mesh(**smooth_mesh(surface))
        scene.add_instance(number, place, [net])
    if not geometry:
        scene.set_shell_tile(net, period)
    gray = scene.add_principled_material(base_color=(0.35, 0.35, 0.35), roughness=0.8)
    side = 20 * _ball(period).radius
    corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32) * np.float32(side)
    floor, _ = scene.add_mesh(positions=corners, triangles=np.array([[0, 1, 2], [0, 2, 3]], np.uint32))
    scene.add_instance(floor, _UNMOVED, [gray])
    radius = _ball(period).radius
    scene.add_light("sun", (4, 3.8, 3.5), _sun(), angle=0.02)
    scene.set_world_color((0.3, 0.33, 0.4))
    eye, middle = np.array([0.6, -7.2, 3.4]) * radius, np.array([1.1, 0, 0.85]) * radius
    scene.look_at(tuple(eye), tuple(middle), 0.5, _SIZE[0] / _SIZE[1])
    scene.commit()


def _ball(period: float) -> Sphere:
    return Sphere(_ROWS, period)


def _placed(period: float) -> list[tuple[Surface, tuple]]:
    """The ball stands on the floor; the cloth hangs beside it with its corners just above the floor."""
    radius, cloth = _ball(period).radius, Cloth(_CLOTH, period)
    lowest = float(cloth.frame(np.array([[0.0, 0.0], [_CLOTH / 2, 0.0]]))[0][:, 2].min())
    gap = 0.02 * radius
    return [
        (_ball(period), _moved(0, 0, 1.07 * radius)),
        (cloth, _moved(2.3 * radius, 0.1 * radius, gap + 0.07 * radius - lowest)),
    ]


def _moved(x: float, y: float, z: float) -> tuple:
    return ((1, 0, 0, x), (0, 1, 0, y), (0, 0, 1, z))


def _sun() -> tuple:
    """Transform of a sun from the left and above; its rays go along -z of the transform."""
    z = np.array([-0.45, -0.55, 0.7])
    z /= np.linalg.norm(z)
    x = np.cross([0, 0, 1.0], z)
    x /= np.linalg.norm(x)
    y = np.cross(z, x)
    return tuple((x[i], y[i], z[i], 0) for i in range(3))


def _render(scene: Scene, stem: Path, size: tuple[int, int], samples: int) -> dict:
    options = {"width": size[0], "height": size[1], "spp": samples, "bounces": 2, "split": 1}
    with render_job(scene, strategy="mis", **options) as job:
        seconds = job.run()["seconds"]
        pixels = np.ascontiguousarray(job.read_pass("Combined")[..., :3])
    for suffix in (".exr", ".png"):
        images.write(stem.with_suffix(suffix), pixels)
    return {"seconds": seconds, "bytes": scene.info()["bytes"]}


def _tell(folder: Path, report: dict) -> None:
    print(f"votf    {report['votf']['seconds']:.1f} s, {report['votf']['bytes'] / 1e6:.2f} MB")
    for name, what in (("model", "shell"), ("reference", "geometry")):
        print(f"{what:8}{report[name]['seconds']:.1f} s, {report[name]['bytes'] / 1e6:.0f} MB")
    print(f"        relmse {report['relmse']:.2g}")
    for name in ("model", "reference", "difference"):
        print(f"        {folder / name}.png, .exr")
    print(f"        {folder / 'report.json'}")
