"""Runs in the Python that has Mitsuba: renders one scene with several numbers of samples.

The first argument is the task as JSON, the second the file for the report. A timed picture is rendered twice:
the second time, its kernels are already compiled.
"""

from __future__ import annotations

import json
import sys
import time

import drjit as dr
import mitsuba as mi


def main(task: dict, report: str) -> None:
    mi.set_variant(task["variant"])
    dr.set_thread_count(task["threads"])
    scene = mi.load_dict(_scene(task))
    seconds = [_picture(scene, **picture) for picture in task["pictures"]]
    text = json.dumps({"version": mi.__version__, "variant": mi.variant(), "seconds": seconds})
    with open(report, "w") as file:
        file.write(text)


def _picture(scene, rays: int, seed: int, out: str, timed: bool) -> float:
    if timed:
        _timed(scene, rays, seed + 1)
    picture, seconds = _timed(scene, rays, seed)
    mi.util.write_bitmap(out, picture, write_async=False)
    return seconds


def _timed(scene, rays: int, seed: int):
    start = time.perf_counter()
    picture = mi.render(scene, spp=rays, seed=seed)
    dr.eval(picture)  # before this, the work is only recorded
    dr.sync_thread()
    return picture, time.perf_counter() - start


def _scene(task: dict) -> dict:
    turn = mi.ScalarTransform4f
    # Rotates our y-up meshes into the z-up world: (x, y, z) -> (x, -z, y).
    upright = turn().rotate([1, 0, 0], 90) if task["up"] == "y" else turn()
    # Mitsuba's map has +y at the top and +z in the middle column, ours +z at the top and +x in the middle.
    world = turn([[0, 0, 1, 0], [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
    half = task["directions"] // 2
    return {
        "type": "scene",
        "integrator": {"type": "direct", "bsdf_samples": half, "emitter_samples": half},
        "sensor": _sensor(task),
        "emitter": {"type": "envmap", "filename": task["world"], "to_world": world},
        "shape": {
            "type": "obj",
            "filename": task["mesh"],
            "to_world": upright,
            "bsdf": {"type": "measured", "filename": task["measurement"]},
        },
    }


def _sensor(task: dict) -> dict:
    *places, fov = map(float, task["camera"].split(","))
    width, height = task["size"]
    film = {
        "type": "hdrfilm",
        "width": width,
        "height": height,
        "rfilter": {"type": "box"},
        "pixel_format": "rgb",
        "component_format": "float32",
    }
    return {
        "type": "perspective",
        "fov": fov,
        "fov_axis": "y",
        "to_world": mi.ScalarTransform4f().look_at(places[:3], places[3:], [0, 0, 1]),
        "film": film,
        "sampler": {"type": task["sampler"]},
    }


if __name__ == "__main__":
    main(json.loads(sys.argv[1]), sys.argv[2])
