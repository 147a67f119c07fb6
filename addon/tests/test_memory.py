"""What a render says that it will take: beside what it took, and against limits."""

from __future__ import annotations

import json
import os
import re
import subprocess

import numpy as np
import pytest
from command_line import command, environment, program, refused, velour
from velour.core.memory_limit import Limit, memory_limit
from velour.native import images

MOST = 1.5  # times the measured peak


@pytest.fixture
def small(mesh_file, world_file, model_file, tmp_path) -> dict:
    return {"mesh": mesh_file, "material": model_file, "world": world_file, "size": "32x24",
            "output": tmp_path / "o.exr"}  # fmt: skip


def render(scene: dict, *more):
    options = [word for name, value in scene.items() for word in (f"--{name}", value)]
    return ["render", *options, "--spp", 1, "--threads", 2, "--no-cache", *more]


@pytest.fixture
def large(measurement_file, tmp_path):
    """{part of the estimate: what makes it large}, each made when it is asked for."""

    def mesh():
        n = 300
        across, up = np.meshgrid(np.linspace(-1, 1, n + 1), np.linspace(-1, 1, n + 1))
        points = np.stack([across, 0.1 * np.sin(7 * across), up], axis=-1).reshape(-1, 3)
        corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n) + 1).reshape(-1, 1)
        with open(tmp_path / "grid.obj", "wb") as file:
            np.savetxt(file, points, "v %.6f %.6f %.6f")
            np.savetxt(file, corner + np.array([0, n + 1, n + 2, 1]), "f %d %d %d %d")
        return {"mesh": tmp_path / "grid.obj"}

    def ply():
        """What scanners write: 13 bytes a triangle."""
        n = 400
        across, up = np.meshgrid(np.linspace(-1, 1, n + 1), np.linspace(-1, 1, n + 1))
        points = np.stack([across, 0.1 * np.sin(7 * across), up], axis=-1).reshape(-1, 3).astype("<f4")
        corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).reshape(-1, 1)
        faces = np.zeros(2 * n * n, [("count", "u1"), ("index", "<i4", 3)])
        faces["count"] = 3
        faces["index"] = corner[np.r_[: n * n, : n * n]] + np.repeat(
            [(0, n + 1, n + 2), (0, n + 2, 1)], n * n, axis=0
        )
        head = f"""ply
format binary_little_endian 1.0
element vertex {len(points)}
property float x
property float y
property float z
element face {len(faces)}
property list uchar int vertex_indices
end_header
"""
        (tmp_path / "grid.ply").write_bytes(head.encode() + points.tobytes() + faces.tobytes())
        return {"mesh": tmp_path / "grid.ply"}

    def strips():
        """4 bytes a triangle."""
        n = 400000
        points = np.random.default_rng(0).random((1000, 3), np.float32)
        strip = np.r_[n, np.arange(n) % 1000].astype("<i4")
        head = f"""ply
format binary_little_endian 1.0
element vertex {len(points)}
property float x
property float y
property float z
element tristrips 1
property list int int vertex_indices
end_header
"""
        (tmp_path / "strips.ply").write_bytes(head.encode() + points.tobytes() + strip.tobytes())
        return {"mesh": tmp_path / "strips.ply"}

    def dense():
        """Short numbers, relative corners and smoothing groups: 10 bytes a triangle."""
        with open(tmp_path / "dense.obj", "wb") as file:
            np.savetxt(file, np.arange(60000).reshape(-1, 3) % 7, "v %d %d %d")
            file.write(b"s 1\n" + b"f -1 -2 -3\n" * 150000)
        return {"mesh": tmp_path / "dense.obj"}

    def ascii_ply():
        with open(tmp_path / "grid.ply", "wb") as file:
            file.write(b"ply\nformat ascii 1.0\nelement vertex 30000\nproperty float x\nproperty float y\n")
            file.write(
                b"property float z\nelement face 150000\nproperty list uchar int vertex_indices\nend_header\n"
            )
            np.savetxt(file, np.arange(90000).reshape(-1, 3) % 7, "%d %d %d")
            file.write(b"3 0 1 2\n" * 150000)
        return {"mesh": tmp_path / "grid.ply"}

    def world():
        images.write(tmp_path / "large.exr", np.full((1024, 2048, 3), 0.5, np.float32))
        return {"world": tmp_path / "large.exr"}

    return {
        "mesh": mesh,
        "ply": ply,
        "strips": strips,
        "dense": dense,
        "ascii_ply": ascii_ply,
        "material": lambda: {"material": measurement_file},
        "world": world,
        "picture": lambda: {"size": "1600x1200"},
    }


@pytest.mark.parametrize(
    "what", ["mesh", "ply", "strips", "dense", "ascii_ply", "material", "world", "picture"]
)
def test_the_estimate_is_no_less_than_the_peak_and_not_much_more(what, small, large):
    told = program(*render(small | large[what](), "--json")).json["memory"]
    part = what if what in told["parts"] else "mesh"
    assert list(told["parts"]) == ["program", "mesh", "material", "world", "picture", "rays"]
    assert told["estimated"] == sum(told["parts"].values())
    assert told["peak"] <= told["estimated"] <= MOST * told["peak"]
    assert told["estimated"] - told["parts"][part] < told["peak"], "the part does not show"


def test_a_render_that_goes_on_from_a_side_file_takes_more(small):
    wide = render(small | {"size": "1600x1200"}, "--spp", 16)
    assert velour(*wide, "--time-limit", 1e-9).status == 3
    told = program(*wide, "--json").json["memory"]
    assert told["peak"] <= told["estimated"] <= MOST * told["peak"] + told["parts"]["rays"]
    assert told["estimated"] - 112 * 1600 * 1200 < told["peak"]


def test_recorded_rays_are_estimated(small):
    """They are not recorded if the limit leaves no memory for them."""
    many = render(small | {"size": "160x120"}, "--spp", 1024, "--json")
    free = program(*many).json
    assert free["ray_share"] > 0
    rays = free["memory"]["parts"]["rays"]
    assert rays == 160 * 120 // 16 * 1024 // 8 * 9 * 36
    assert free["memory"]["peak"] <= free["memory"]["estimated"]
    tight = program(*many, "--memory", free["memory"]["estimated"] - rays // 2).json
    assert tight["ray_share"] is None
    assert tight["memory"]["parts"]["rays"] == 0
    assert tight["memory"]["peak"] <= tight["memory"]["estimated"] <= MOST * tight["memory"]["peak"]


def test_a_terminal_is_told_the_estimate(small):
    """With the level that a log has by default; stdout has the JSON alone."""
    reader, terminal = os.openpty()
    arguments = command(*render(small, "--json"))
    done = subprocess.run(arguments, stdout=subprocess.PIPE, stderr=terminal, env=environment(), timeout=300)
    said = os.read(reader, 1 << 16).decode()
    os.close(terminal)
    os.close(reader)
    assert re.match(r"velour: Estimated memory: \d+ MiB.*: program \d+ MiB, .* rays \d+ KiB\.\r\n", said)
    assert json.loads(done.stdout)["memory"]
    assert velour(*render(small)).err == ""


def test_more_than_the_limit_is_refused_before_anything_is_rendered(small):
    sentence = refused(*render(small | {"size": "20000x20000"}, "--memory", "2G"))
    for words in (
        "needs about 3",
        "picture 35.8 GiB",
        "more than the limit of 2.0 GiB (--memory)",
        "--crop",
    ):
        assert words in sentence
    result = velour(*render(small, "--memory", "2G", "--log-level", "info"))
    assert result.status == 0
    assert "Estimated memory: " in result.err
    assert " of 2.0 GiB (--memory): program " in result.err
    assert "more than the limit of 1 MiB (the Slurm job)" in refused(*render(small), SLURM_MEM_PER_NODE="1")


@pytest.mark.parametrize("size", ["", "G", "-1", "1.5G", "2X", "2GB", "16777216T"])
def test_sizes_that_are_none_are_wrong_usage(size, small):
    assert velour(*render(small, f"--memory={size}")).status == 2


def system(tmp_path, cgroup: str, **limits) -> dict:
    """The root of a system whose process is in `cgroup`; limits by file, __ for slashes."""
    (tmp_path / "proc/self").mkdir(parents=True)
    (tmp_path / "proc/self/cgroup").write_text(cgroup)
    for name, text in limits.items():
        path = tmp_path / "sys/fs/cgroup" / name.replace("__", "/").replace("_dot_", ".")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"{text}\n")
    return tmp_path


def test_the_least_limit_of_the_groups_around_the_process_holds(tmp_path):
    limits = {"a__memory_dot_max": 5 << 30, "a__b__memory_dot_max": "max", "a__b__c__memory_dot_max": 6 << 30}
    root = system(tmp_path, "0::/a/b/c\n", **limits)
    assert memory_limit({}, root) == Limit(5 << 30, "the cgroup")
    assert memory_limit({"SLURM_MEM_PER_NODE": "4096"}, root) == Limit(4 << 30, "the Slurm job")
    assert memory_limit({"SLURM_MEM_PER_NODE": "8192"}, root) == Limit(5 << 30, "the cgroup")


def test_cgroups_of_version_1(tmp_path):
    name = "memory__job__memory_dot_limit_in_bytes"
    root = system(tmp_path, "4:cpu:/\n3:memory:/job\n0::/\n", **{name: 3 << 30})
    assert memory_limit({}, root) == Limit(3 << 30, "the cgroup")
    (root / "sys/fs/cgroup/memory/job/memory.limit_in_bytes").write_text("9223372036854771712\n")
    assert memory_limit({}, root) is None


def test_a_container_whose_group_has_another_name_inside(tmp_path):
    root = system(tmp_path, "0::/host/name\n", memory_dot_max=2 << 30)
    assert memory_limit({}, root) == Limit(2 << 30, "the cgroup")


def test_the_limit_on_addresses(tmp_path):
    """ulimit -v, by which some engines limit jobs; libraries and stacks reserve addresses without memory."""
    root = system(tmp_path, "")
    (root / "proc/self/status").write_text("VmSize:\t 900 kB\nVmRSS:\t 500 kB\n")
    row = "Max address space         {}              unlimited            bytes     \n"
    (root / "proc/self/limits").write_text(row.format("unlimited"))
    assert memory_limit({}, root) is None
    (root / "proc/self/limits").write_text(row.format(1 << 20))
    assert memory_limit({}, root) == Limit((1024 - 400) << 10, "ulimit -v, less what is reserved")


@pytest.mark.parametrize(
    ("environment", "gib"),
    [
        ({"SLURM_MEM_PER_CPU": "1024", "SLURM_CPUS_ON_NODE": "8"}, 8),
        ({"SLURM_MEM_PER_CPU": "1024"}, None),
        ({"SLURM_MEM_PER_NODE": "0"}, None),
        ({"SLURM_MEM_PER_NODE": "2048", "SLURM_MEM_PER_CPU": "9", "SLURM_CPUS_ON_NODE": "9"}, 2),
        ({}, None),
    ],
)
def test_limits_of_slurm_jobs(environment, gib, tmp_path):
    limit = memory_limit(environment, tmp_path)
    assert (limit and limit.size) == (gib and gib << 30)
