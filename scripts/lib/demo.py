"""scripts/demo: measurement, fit, renders in Blender, difference, report; then a BTF. With --votf: shells."""

from __future__ import annotations

import argparse
import contextlib
import shutil
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from bench import blender, charts, tiles
from bench.parts import Part, Parts
from bench.progress import Progress
from bench.run import read_rgb
from bench.shapes import Cloth, Sphere, Surface, smooth_mesh, structured_mesh
from bench.steps import Steps
from bench.velour_cli import ROOT
from velour.core import files
from velour.core.machine import machine
from velour.core.warning_table import COMMAND_LINE, sentences
from velour.native import (
    Measurement,
    Model,
    Scene,
    Tile,
    VelourError,
    fit_job,
    images,
    library,
    microsurface_job,
    render_job,
)

OUT = ROOT / "out/demo"
CAPTURE = Part(
    "capture",
    "the default measurement",
    {"capturing the default measurement": 7},
    ("microsurface.binary",),
)
_PICTURES = tuple(f"{n}.{suffix}" for n in ("model", "reference", "difference") for suffix in ("exr", "png"))
_START, _DRAW = "starting Blender", "drawing the difference and the plot"
MATERIAL = Part(
    "material",
    "the measured material",
    {
        "fitting the model": 1,
        _START: 2,
        "rendering the measurement": 15,
        "rendering the model": 14,
        "taking error against time": 8,
        _DRAW: 2,
    },
    ("model.velour", *_PICTURES, "error_against_time.png"),
)
_START_BTF, _DRAW_BTF = "starting Blender for a BTF", "drawing the BTF's difference"
BTF = Part(
    "btf",
    "the BTF of a weave",
    {
        _START_BTF: 2,
        "capturing a tile of weave": 9,
        "fitting a model to its BTF": 21,
        "rendering the BTF": 7,
        "rendering the model of the BTF": 6,
        _DRAW_BTF: 1,
    },
    ("tile.btf", *_PICTURES),
)
VOTF = Part(
    "votf",
    "the wire net",
    {"fitting the metal": 3, "tracing the shell": 5, "rendering the shell": 10, "rendering the geometry": 20},
    ("metal.velour", "net.velour", *_PICTURES),
)


def main() -> int:
    args = _parser().parse_args()
    parts = Parts(Progress(rate=1.0), args.fresh)
    tasks = _tasks(args.files)
    has_btf = not args.files and not args.votf
    found = [VOTF if args.votf else MATERIAL] * len(tasks)
    for part in [CAPTURE] * (not args.files) + found + [BTF] * has_btf:
        part.announce(parts.progress)
    try:
        default, capture = (None, {}) if args.files else default_measurement(parts)
        for source, folder in tasks:
            if args.votf:
                _show_votf(folder / "votf", source or default, parts)
            else:
                _show_material(folder, source or default, capture, parts)
        if has_btf:
            _show_btf(OUT / "btf", parts)
    except KeyboardInterrupt:
        return 130
    except (VelourError, OSError, blender.BlenderError) as error:
        print(f"demo: {error}", file=sys.stderr)
        return 1
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="demo")
    parser.add_argument("--fresh", action="store_true")
    parser.add_argument("--votf", action="store_true")
    parser.add_argument("files", metavar="FILE", nargs="*", type=Path)
    return parser


def _tasks(given: list[Path]) -> list[tuple[Path | None, Path]]:
    """Pairs of measurement (None: the default one) and output folder."""
    if len(given) < 2:
        return [(given[0] if given else None, OUT)]
    folders = [OUT / path.stem for path in given]
    if len(set(folders)) < len(folders):
        folders = [OUT / f"{number}-{path.stem}" for number, path in enumerate(given, 1)]
    return list(zip(given, folders, strict=True))


def default_measurement(parts: Parts) -> tuple[Path, dict]:
    """A rough metal under a virtual goniometer; and what its capture took."""
    path = OUT / "microsurface.binary"

    def make(steps: Steps) -> dict:
        steps.begin(*CAPTURE.steps)
        with microsurface_job(path, seed=1) as job:  # the rest are the library's defaults
            return job.run()

    OUT.mkdir(parents=True, exist_ok=True)
    report = parts.make(CAPTURE, OUT, {}, make)
    return path, {"capture_seconds": report["seconds"], "cached": report["kept"]}


def _report(folder: Path, report: dict) -> None:
    """Writes report.json and tells which pictures were made."""
    report |= {"version": library.system()["version"], "machine": machine()}
    files.write_json(folder / "report.json", report)
    for name in ("model", "reference", "difference"):
        print(f"        {folder / name}.png, .exr")
    print(f"        {folder / 'report.json'}")


def write_difference(folder: Path) -> tuple[float, float]:
    """Writes difference.{exr,png} of model.exr and reference.exr; returns rmse and relmse."""
    model, reference = (read_rgb(folder / f"{name}.exr") for name in ("model", "reference"))
    for name in ("difference.exr", "difference.png"):
        images.write(folder / name, np.ascontiguousarray(np.abs(model - reference)))
    return images.compare(model, reference)


def save_fit(measurement_file: Path, model_file: Path) -> dict:
    """Returns the report of the fit."""
    with Measurement.load(measurement_file) as measurement, fit_job(measurement) as job:
        report = job.run()
        with job.result_model() as model:
            model.save(model_file)
    return report


def _show_material(folder: Path, measurement: Path, capture: dict, parts: Parts) -> None:
    """A model of a measurement, renders of both in Blender, and a plot. `capture`: what measuring took."""
    folder.mkdir(parents=True, exist_ok=True)
    make = lambda steps: _make_material(folder, measurement, steps)  # noqa: E731
    made = parts.make(MATERIAL, folder, {"measurement": measurement}, make)
    report = made["numbers"] | {"capture_seconds": None, "cached": False, **capture, "kept": made["kept"]}
    errors = ", ".join(f"{a} deg {e:.3f}" for a, e in report["by_view_angle"].items() if e is not None)
    print(f"fit     {report['lobes']} lobes, {report['bytes']} bytes, {report['fit_seconds']:.1f} s")
    print(f"        error {errors}")
    for warning in made["warnings"]:
        print(f"        {warning}")
    speed = report["samples_per_second"] / 1e6
    print(f"render  {report['render_seconds']:.1f} s, {speed:.1f} M samples/s, relmse {report['relmse']:.2g}")
    print(f"        {folder / 'error_against_time.png'}")
    _report(folder, report)


def _make_material(folder: Path, measurement: Path, steps: Steps) -> dict:
    model = folder / "model.velour"
    steps.begin("fitting the model")
    fit = save_fit(measurement, model)
    steps.begin(_START)
    names = {"model": model, "measurement": measurement, "folder": folder}
    task = {name: str(path.resolve()) for name, path in names.items()}
    rendered = blender.run("demo", task, folder / "blender.log", hear=steps.hear)
    steps.begin(_DRAW)
    rmse, relmse = write_difference(folder)
    title = "sampling error of the demo's scene at a quarter of its size"
    chart, axes = folder / "error_against_time.png", ("seconds", "relmse against the reference")
    charts.curves(chart, [("", rendered["curves"])], *axes, title=title)
    numbers = {name: fit[name] for name in ("relative_l2", "by_view_angle", "lobes", "bytes")}
    numbers |= {
        "fit_seconds": fit["seconds"],
        "render_seconds": rendered["seconds"],
        "relmse": relmse,
        "rmse": rmse,
    }
    numbers["samples_per_second"] = rendered["samples_per_second"]
    return {"numbers": numbers, "warnings": sentences(fit["warning_codes"], COMMAND_LINE)}


def _show_btf(folder: Path, parts: Parts) -> None:
    """A tile, its BTF, a model of it, and two renders in Blender."""
    report = parts.make(BTF, folder, {}, lambda steps: _make_btf(folder, steps))
    sizes = {name: report[f"{name}_bytes"] / 1e6 for name in ("btf", "model")}
    print(f"capture {report['capture_seconds']:.1f} s, {sizes['btf']:.0f} MB")
    print(f"fit     {report['compress_seconds']:.1f} s, {sizes['model']:.2f} MB")
    print(f"render  {report['model_seconds']:.1f} s, relmse {report['relmse']:.2g}")
    _report(folder, report)


def _make_btf(folder: Path, steps: Steps) -> dict:
    shutil.rmtree(folder, ignore_errors=True)  # a capture overwrites nothing
    folder.mkdir(parents=True)
    steps.begin(_START_BTF)
    report = blender.run("demo", {"folder": str(folder.resolve())}, folder / "blender.log", hear=steps.hear)
    steps.begin(_DRAW_BTF)
    report["rmse"], report["relmse"] = write_difference(folder)
    return report


# A ball and a cloth of net over a floor, as shells and in real geometry.
_SIZE, _SAMPLES = (768, 432), 64
_ROWS = 12  # tiles from pole to pole of the ball
_CLOTH = 10  # tiles per side of the cloth


def _show_votf(folder: Path, measurement: Path, parts: Parts) -> None:
    def make(steps: Steps) -> dict:
        steps.begin("fitting the metal")
        save_fit(measurement, folder / "metal.velour")
        return make_votf_pictures(folder, folder / "metal.velour", _SIZE, _SAMPLES, steps.begin)

    folder.mkdir(parents=True, exist_ok=True)
    report = parts.make(VOTF, folder, {"measurement": measurement}, make)
    print(f"votf    {report['votf']['seconds']:.1f} s, {report['votf']['bytes'] / 1e6:.2f} MB")
    for name, what in (("model", "shell"), ("reference", "geometry")):
        print(f"{what:8}{report[name]['seconds']:.1f} s, {report[name]['bytes'] / 1e6:.0f} MB")
    print(f"        relmse {report['relmse']:.2g}")
    _report(folder, report)


def make_votf_pictures(
    folder: Path, material: Path, size: tuple[int, int], samples: int, begin: Callable[[str], None]
) -> dict:
    """`material`: a model of a BRDF, for the net. `begin` is called with the name of each step."""
    report = {}
    with contextlib.ExitStack() as handles:
        plain, tile = (handles.enter_context(h) for h in (Model.load(material), Tile.create("net")))
        begin("tracing the shell")
        with Scene() as scene:
            tiles.add(tile, scene)
            shell, report["votf"] = tiles.with_shell(scene, tile.info(), plain)
        handles.enter_context(shell)
        shell.save(folder / "net.velour")
        for name, model in (("model", shell), ("reference", plain)):
            begin(f"rendering the {'shell' if model is shell else 'geometry'}")
            with Scene() as scene:
                _add_objects(scene, tile, model, name == "reference")
                report[name] = _render(scene, folder / name, size, samples)
    report["rmse"], report["relmse"] = write_difference(folder)
    return report


def _add_objects(scene: Scene, tile: Tile, model: Model, geometry: bool) -> None:
    net, period = scene.add_model_material(model), tile.info()["period"][0]
    for surface, place in _placed(period):
        structure = (
            structured_mesh(surface, tile.mesh()._asdict(), period) if geometry else smooth_mesh(surface)
        )
        scene.add_instance(scene.add_mesh(**structure)[0], place, [net])
    if not geometry:
        scene.set_shell_tile(net, period)
    radius = Sphere(_ROWS, period).radius
    corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32) * np.float32(20 * radius)
    floor, _ = scene.add_mesh(positions=corners, triangles=np.array([[0, 1, 2], [0, 2, 3]], np.uint32))
    gray = scene.add_principled_material(base_color=(0.35, 0.35, 0.35), roughness=0.8)
    scene.add_instance(floor, tiles.UNMOVED, [gray])
    scene.add_light("sun", (4, 3.8, 3.5), tiles.sun((-0.45, -0.55, 0.7)), angle=0.02)
    scene.set_world_color((0.3, 0.33, 0.4))
    eye, middle = np.array([0.6, -7.2, 3.4]) * radius, np.array([1.1, 0, 0.85]) * radius
    scene.look_at(tuple(eye), tuple(middle), 0.5, _SIZE[0] / _SIZE[1])
    scene.commit()


def _placed(period: float) -> Iterator[tuple[Surface, tuple]]:
    """The ball stands on the floor; the cloth hangs beside it with its corners just above the floor."""
    ball, cloth = Sphere(_ROWS, period), Cloth(_CLOTH, period)
    lowest = float(cloth.frame(np.array([[0.0, 0.0], [_CLOTH / 2, 0.0]]))[0][:, 2].min())
    for surface, place in ((ball, (0, 0, 1.07)), (cloth, (2.3, 0.1, 0.09 - lowest / ball.radius))):
        yield surface, tuple((*tiles.UNMOVED[i][:3], place[i] * ball.radius) for i in range(3))


def _render(scene: Scene, stem: Path, size: tuple[int, int], samples: int) -> dict:
    options = {"width": size[0], "height": size[1], "spp": samples, "bounces": 2, "split": 1}
    with render_job(scene, strategy="mis", **options) as job:
        seconds = job.run()["seconds"]
        pixels = np.ascontiguousarray(job.read_pass("Combined")[..., :3])
    for suffix in (".exr", ".png"):
        images.write(stem.with_suffix(suffix), pixels)
    return {"seconds": seconds, "bytes": scene.info()["bytes"]}


if __name__ == "__main__":
    start = time.monotonic()
    status = main()
    if status == 0:
        print(f"        {time.monotonic() - start:.0f} s in all")
    sys.exit(status)
