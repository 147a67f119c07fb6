"""Tables for shaders, and a scene as a graphics processor has it; drawing: blend-tests/window_realtime.py."""

import os
import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest
from inputs import BTF_MODEL
from velour.core.mesh_arrays import MeshArrays
from velour.core.mesh_queue import MeshQueue
from velour.native import (
    Model,
    Scene,
    TextureSlot,
    Tile,
    VelourError,
    btf_maps_job,
    light_map_job,
    lobe_rows_job,
    principled_rows_job,
    render_job,
    shell_maps_job,
    votf_job,
)
from velour.realtime import RealtimeScene, UnshownError
from velour.realtime.job_line import JobLine
from velour.realtime.kept_tables import KeptTables, Part
from velour.realtime.lamps import lamp_pixels
from velour.realtime.pictures import GpuTexture
from velour.realtime.projection import jitter, view_projection
from velour.realtime.shaders import PICTURES
from velour.realtime.tables import LobeTables, PrincipledTables
from velour.realtime.tile_widths import TileWidths


class _View:
    kind, window = "perspective", (-0.5, 0.5, -0.25, 0.25)
    clip_start, clip_end, width, height = 0.1, 100.0, 200, 100
    camera_to_world = np.array(((1, 0, 0, 2), (0, 1, 0, 3), (0, 0, 1, 4)), float)


def _square(**more):
    corners = np.array(((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)), np.float32)
    triangles = np.array(((0, 1, 2), (0, 2, 3)), np.uint32)
    return MeshArrays(corners, triangles, np.arange(4, dtype=np.uint32), **more)


def _added(*squares):
    scene = RealtimeScene()
    queue = MeshQueue(scene, None)
    for square in squares:
        queue.add(square, "Square")
    queue.numbers()
    return scene


def test_light_map_of_a_constant_world_is_that_world_everywhere():
    with Scene() as scene:
        scene.set_world_color((0.5, 1.0, 2.0))
        with light_map_job(scene) as job:
            report = job.run()
            table = job.result_table()
    assert report["lobes"] == 1
    assert report["mixture"][0][3:] == [0, 0.5, 1.0, 2.0]
    entries = table[0, :29, :3].astype(int)
    for x, y, side in entries:
        map_pixels = table[y - 1 : y + side + 1, x - 1 : x + side + 1, :3]
        np.testing.assert_allclose(map_pixels, np.broadcast_to((0.5, 1.0, 2.0), map_pixels.shape), rtol=2e-3)


def test_rows_of_a_white_diffuse_material_reflect_nearly_all_light():
    with principled_rows_job((1, 1, 1), roughness=1.0, specular=0.0) as job:
        report = job.run()
        table = job.result_table()
    assert report["isotropic"]
    assert table.shape == (report["side"], 2 * report["lobes"], 4)
    albedo = table[:80, 1::2, :3].sum(axis=1)
    np.testing.assert_allclose(albedo, 1, atol=0.03)


# Light between facets makes rough colored metals a little darker than their color.
@pytest.mark.parametrize(("lobe", "off"), [("single", 2e-5), ("separable", 2e-5), ("whole", 0.008)])
@pytest.mark.parametrize("metallic", [0.0, 0.4, 1.0])
def test_rows_go_in_step_with_the_base_color(metallic, lobe, off):
    """That is how pictures of it are drawn: between the rows of black and those of white."""

    def rows(color):
        with principled_rows_job(color, metallic=metallic, roughness=0.4, lobe=lobe) as job:
            job.run()
            return job.result_table()

    color = (0.2, 0.5, 0.9)
    black, white, found = rows((0, 0, 0)), rows((1, 1, 1)), rows(color)
    np.testing.assert_allclose(found[:, ::2], black[:, ::2], atol=1e-5)
    between = black[:, 1::2, :3] + (white - black)[:, 1::2, :3] * color
    np.testing.assert_allclose(found[:, 1::2, :3], between, atol=off)
    assert np.abs(white - black)[:, 1::2].max() > 0.1


def test_principled_colors_are_of_the_working_space_already_and_models_are_not():
    buffers = SimpleNamespace(
        Buffer=lambda _kind, _size, values: values, GPUTexture=lambda _size, format, data: data
    )
    gpu, twice = SimpleNamespace(types=buffers), 2 * np.eye(3, dtype=np.float32)
    with principled_rows_job((0.2, 0.5, 0.9)) as job:
        job.run()
        table = job.result_table()
        np.testing.assert_array_equal(PrincipledTables(gpu, job, twice)._rows, table.reshape(-1))
        table[:, 1::2, :3] *= 2
        np.testing.assert_array_equal(LobeTables(gpu, job, twice)._rows, table.reshape(-1))


def test_a_picture_of_a_base_color_is_drawn_and_others_are_counted_as_simpler():
    pixels = np.linspace(0, 1, 8 * 4 * 3, dtype=np.float32).reshape(4, 8, 3)
    with RealtimeScene() as scene:
        color, number = scene.texture(pixels), scene.texture(pixels, channel=0)
        slot = TextureSlot(color, ((2, 0, 0), (0, 1, 0.5)))
        scene.add_textured_material({"base_color": slot}, roughness=0.3)
        scene.add_textured_material({"base_color": slot._replace(uv_set=1)})
        scene.add_textured_material({"base_color": slot, "roughness": TextureSlot(number)})
        assert [look.is_simpler for look in scene.looks] == [False, True, True]
        assert [len(look.parts) for look in scene.looks] == [2, 1, 2]
    np.testing.assert_array_equal(color.colors[..., :3], pixels)


class _Job:
    """A job that makes a table. It is done once `is_done` is set."""

    def __init__(self, is_done=True):
        self.is_done, self.closed = is_done, False

    def start(self):
        return self

    def poll(self):
        return SimpleNamespace(state="done" if self.is_done else "running")

    def wait(self, timeout):
        return self.is_done

    def close(self):
        self.closed = True


def test_tables_are_made_once_and_go_when_nothing_shows_them():
    kept, made, job = KeptTables(), [], _Job(is_done=False)
    parts = [Part("a", lambda _gpu, job, _working: made.append(job) or job)]
    kept.ask("a", lambda: job)
    assert not kept.has(None, parts, None)
    job.is_done = True
    for _export in range(2):
        kept.ask("a", lambda: pytest.fail("asked for again"))
        assert kept.has(None, parts, None)
    assert made == [job]
    assert job.closed
    late = _Job(is_done=False)
    kept.ask("b", lambda: late)
    assert kept.has(None, [], None)
    assert late.closed, "nothing shows what it is for"
    again = _Job(is_done=False)
    kept.ask("a", lambda: again)
    kept.close()
    assert again.closed


class _SlowJob:
    """Runs until it is ended or cancelled."""

    def __init__(self):
        self.state, self.starts, self.closed = "ready", 0, False

    def poll(self):
        return SimpleNamespace(state=self.state)

    def start(self):
        self.state, self.starts = "running", self.starts + 1

    def wait(self, timeout):
        return self.state == "done"

    def cancel(self):
        if self.state == "running":
            self.state = "cancelled"

    def close(self):
        self.closed = True


def test_jobs_run_one_at_a_time_and_begin_anew_after_a_pause():
    line, first, second = JobLine(), _SlowJob(), _SlowJob()
    for job in (first, second):
        line.add(job)
    assert (first.starts, second.starts) == (0, 0), "nothing begins by itself"
    line.go_on()
    line.go_on()
    assert (first.starts, second.starts) == (1, 0)
    line.pause()
    assert first.state == "cancelled"
    assert not line.has(first), "a cancelled job has neither a result nor failed"
    line.go_on()
    assert first.starts == 2
    first.state = "done"
    line.go_on()
    assert line.has(first)
    assert second.starts == 1
    line.drop(first)
    assert first.closed
    line.pause()
    assert second.state == "cancelled"


_WORKERS_SHARE = """
import sys, threading, time
from pathlib import Path
import numpy as np
from velour.native import Model, Scene, light_map_job, lobe_rows_job, principled_rows_job

def workers_seconds():
    tasks = Path("/proc/self/task").iterdir()
    others = (task for task in tasks if int(task.name) != threading.get_native_id())
    return sum(int((task / "schedstat").read_text().split()[0]) for task in others) * 1e-9

threads = int(sys.argv[2])
pixels = np.random.default_rng(1).random((64, 128, 3), np.float32)
with Scene() as scene, Model.load(sys.argv[1]) as model:
    scene.set_world_pixels(pixels)
    before, workers_before = time.process_time(), workers_seconds()
    for job in (
        light_map_job(scene, None, threads),
        lobe_rows_job(model, threads),
        principled_rows_job((0.5, 0.5, 0.5), threads),
    ):
        with job:
            job.run()
    print((workers_seconds() - workers_before) / (time.process_time() - before))
"""


@pytest.mark.skipif(len(os.sched_getaffinity(0)) < 2, reason="one processor makes no other threads")
@pytest.mark.parametrize(("threads", "low", "high"), [(1, 0.0, 0.05), (0, 0.1, 1.0)])
def test_jobs_of_tables_take_no_more_threads_than_they_may(threads, low, high, model_file):
    """Checks the share of CPU time that the jobs use in threads other than their own, which have ended."""
    command = [sys.executable, "-c", _WORKERS_SHARE, str(model_file), str(threads)]
    path = os.pathsep.join(sys.path)
    done = subprocess.run(
        command, check=True, capture_output=True, text=True, env={**os.environ, "PYTHONPATH": path}
    )
    assert low <= float(done.stdout) <= high, done.stdout


def test_tables_are_known_by_what_they_are_made_of(model_file):
    def keys(change=lambda scene: None, color=0.5, turned=0.0):
        pixels = np.full((2, 2, 3), color, np.float32)
        with RealtimeScene() as scene, Model.load(model_file) as model:
            change(scene)
            slot = TextureSlot(scene.texture(pixels), ((1, 0, turned), (0, 1, 0)))
            scene.add_textured_material({"base_color": slot}, roughness=0.3)
            scene.add_model_material(model)
            scene.set_world_pixels(pixels)
            scene.place_world(2.0)
            return [part.key for look in scene.looks for part in look.parts], scene.world_key

    parts, world = keys()
    assert len(set(parts)) == 3
    assert keys() == (parts, world)
    for other_parts, other_world in (keys(color=0.6), keys(turned=0.1)):
        assert [a == b for a, b in zip(parts, other_parts, strict=True)] == [True, False, True]
        assert (other_world == world) == (other_world == keys(turned=0.1)[1])
    twice = keys(lambda scene: scene.set_working_space(2 * np.eye(3, dtype=np.float32)))
    assert not set(twice[0]) & set(parts)
    assert twice[1] != world


def test_large_pictures_are_drawn_as_means():
    pixels = np.random.default_rng(1).random((4500, 5000, 1), np.float32)
    made = GpuTexture.from_pixels(pixels)
    assert made.colors.shape == (1500, 1666, 4)
    np.testing.assert_allclose(made.colors[0, 0, 1], pixels[:3, :3].mean(), rtol=1e-6)


@pytest.mark.parametrize("shape", [(1, 4096, 3), (4096, 1, 4), (2, 5000, 1), (1, 2049, 3)])
def test_strips_keep_their_short_side(shape):
    made = GpuTexture.from_pixels(np.full(shape, 0.25, np.float32))
    assert min(made.colors.shape[:2]) == min(shape[:2])
    assert max(made.colors.shape[:2]) <= 2048
    np.testing.assert_allclose(made.colors[..., :3], 0.25)


def test_jobs_without_a_table_say_so():
    with Scene() as scene:
        scene.look_at((0, 0, 3), (0, 0, 0), 1.0, 1.0)
        scene.commit()
        with render_job(scene, width=2, height=2, spp=1) as job:
            job.run()
            with pytest.raises(VelourError, match="does not produce a table"):
                job.result_table()


def test_meshes_get_a_vertex_a_corner_and_no_normal_where_they_are_flat():
    smooth = np.array((1, 0), np.uint8)
    up = np.tile(np.array((0, 0, 1), np.float32), (4, 1))
    slots = np.array((0, 1), np.uint32)
    with _added(_square(vertex_normals=up, smooth=smooth, material_slots=slots), _square()) as scene:
        first, second = scene.meshes
    np.testing.assert_array_equal(first.positions, _square().positions)
    assert first.normals[[0, 2, 3]].max() == 0, "corners of the flat triangle"
    np.testing.assert_array_equal(first.normals[1], (0, 0, 1))
    assert second.slots is None


def test_instances_carry_matrices_and_maps_of_texture_coordinates():
    with _added(_square()) as scene:
        scene.add_textured_material({})
        matrix = np.arange(12, dtype=np.float32).reshape(3, 4)
        scene.add_instances(np.zeros(2, np.uint32), np.stack((matrix, matrix + 1)), [0])
        scene.add_instance(0, matrix, [0], [[[2, 0, 1], [0, 2, 0]]])
        scene.add_instances(np.zeros(1, np.uint32), matrix[None], [0], hidden=("camera",))
        scene.add_instance(0, matrix, [0], hidden=("holdout",))
        many, one, holdout = scene.groups
        assert scene.draws == 4
    np.testing.assert_array_equal(many.rows[1, :3], matrix + 1)
    np.testing.assert_array_equal(many.rows[0, 3:, :3], ((1, 0, 0), (0, 1, 0)))
    np.testing.assert_array_equal(one.rows[0, 3:, :3], ((2, 0, 1), (0, 2, 0)))
    assert (many.rows[:, 4, 3].max(), holdout.rows[0, 4, 3]) == (0, 1)


def test_materials_are_replaced_as_in_the_scene_of_the_library():
    with RealtimeScene() as scene:
        red = scene.add_textured_material({}, base_color=(1, 0, 0), emission=(1, 2, 3))
        scene.set_gain(red, (2, 2, 2))
        green = scene.add_textured_material({}, base_color=(0, 1, 0))
        assert (red, green) == (0, 1)
        scene.replace_material(red)
        assert len(scene.looks) == 1
        assert scene.looks[0].emission == (0, 0, 0)
        assert scene.gains == [(1, 1, 1)]


@pytest.fixture(scope="module")
def wires(tmp_path_factory, model_file):
    """A model with the outline of a coarse net."""
    path = tmp_path_factory.mktemp("wires") / "wires.velour"
    with Tile.create("net") as tile, Scene() as scene, Model.load(model_file) as model:
        mesh, materials = tile.add_to(scene)
        scene.add_instance(mesh, np.eye(3, 4), materials)
        scene.commit()
        with votf_job(
            scene, model, texels=48, period=tile.info()["period"], reference_height=0, source="net"
        ) as job:
            job.run()
            with job.result_model() as outlined:
                outlined.save(path)
    return path


def test_maps_of_an_outline_tell_where_it_is(wires):
    with Model.load(wires) as model, shell_maps_job(model) as job:
        report = job.run()
        table = job.result_table().reshape(report["layers"], 50, 50, 4)
        assert [48, 48, report["layers"]] == model.info()["shell"]["points"]
        assert [report["bottom"], report["top"]] == model.info()["shell"]["heights"]
    np.testing.assert_array_equal(table[:, :, 0], table[:, :, 48])
    assert (table[0, ..., 0] > 0).all(), "there is wire at the bottom"
    assert (table[..., 0] < 0).any(), "there is no wire"


def test_models_without_outline_have_no_maps_of_it(model_file):
    with Model.load(model_file) as model, pytest.raises(VelourError, match="no silhouette"):
        shell_maps_job(model)


def test_tiles_are_as_wide_as_texture_coordinates_say():
    square = _square()
    widths = TileWidths(square.positions, 2 * square.positions[:, :2], square.triangles, None)
    wide, turned = np.diag((2.0, 3.0, 7.0, 1.0))[:3], np.array(((0, -2, 0, 5), (2, 0, 0, 0), (0, 0, 2, 0)))
    found = widths.of_instances(np.stack((np.eye(3, 4), wide, turned)), 0, 0, 1.0, 1.0)
    np.testing.assert_allclose(found, (0.5, 0.5 * np.sqrt(6), 1.0))
    np.testing.assert_allclose(widths.of_instances(np.eye(3, 4)[None], 0, 0, 4.0, 0.25), 0.5)
    assert widths.of_instances(np.eye(3, 4)[None], 1, 1, 1.0, 1.0) == 0


def test_tops_of_shells_are_lifted_and_know_their_tiles(wires):
    uvs = np.array(((0, 0), (2, 0), (2, 2), (0, 2)), np.float32)
    with _added(_square(corner_uvs=uvs), _square()) as scene, Model.load(wires) as model:
        outlined = scene.add_model_material(model)
        for mesh in (0, 1):
            scene.add_instance(mesh, 3 * np.eye(3, 4), [outlined])
        placed, plain = scene.groups
        scene.set_shell_tile(outlined, 0.25)
        scene.clear_instances()
        scene.add_instance(0, 3 * np.eye(3, 4), [outlined])
        given = scene.groups[0]
        lifts = scene.meshes[0].lifts
        np.testing.assert_array_equal(lifts / np.linalg.norm(lifts, axis=1, keepdims=True), [(0, 0, 1)] * 4)
    assert placed.in_shell
    np.testing.assert_allclose(placed.rows[:, 3, 3], 1.5)
    assert not plain.in_shell, "without texture coordinates there is no shell"
    np.testing.assert_allclose(given.rows[:, 3, 3], 0.25)


def test_outlines_that_come_or_go_ask_for_another_export(wires, model_file):
    with _added(_square()) as scene, Model.load(wires) as outlined, Model.load(model_file) as plain:
        for model, is_stale in ((plain, False), (plain, False), (outlined, True)):
            scene.add_model_material(model)
            if len(scene.looks) > 1:
                scene.replace_material(0)
            assert scene.is_stale == is_stale


def test_what_real_time_does_not_show_is_refused():
    with RealtimeScene() as scene:
        with pytest.raises(UnshownError, match="BTF"):
            scene.add_btf_material(None)
        with pytest.raises(UnshownError, match="measurements"):
            scene.add_measurement_material(None)


def test_more_lamps_on_btfs_than_the_shader_holds_are_refused():
    with RealtimeScene() as scene, Model.load(BTF_MODEL) as model:
        scene.add_textured_material({}, base_color=(1, 0, 0))
        for _ in range(9):
            scene.add_light("sun", (1, 1, 1), np.eye(3, 4))
        scene.check()
        scene.add_model_material(model)
        with pytest.raises(UnshownError, match="more than 8 lights"):
            scene.check()
        scene.lamps.pop()
        scene.check()


def test_a_point_goes_where_the_window_says():
    matrix, eye = view_projection(_View)
    assert eye == (2, 3, 4, 1)
    x, y, _z, w = matrix @ (2 + 0.5 * 7, 3 - 0.25 * 7, 4 - 7, 1)  # the window's lower right, 7 m ahead
    np.testing.assert_allclose((x / w, y / w), (1, -1), atol=1e-12)
    for depth, clip in ((0.1, -1), (100.0, 1)):
        _x, _y, z, w = matrix @ (2, 3, 4 - depth, 1)
        assert z / w == pytest.approx(clip)
    shifted, _eye = view_projection(_View, (0.5, 0))
    x, _y, _z, w = shifted @ (2, 3, 0, 1)
    assert x / w == pytest.approx(0.5 * 2 / 200)


def test_pictures_are_taken_all_over_a_pixel():
    places = np.array([jitter(i) for i in range(PICTURES)])
    assert np.abs(places[0]).max() < 0.02
    for axis in (0, 1):
        np.testing.assert_array_equal(np.sort(places[:, axis]), (np.arange(PICTURES) + 0.5) / PICTURES - 0.5)
    apart = np.abs(places[:, None] - places[None])
    apart = np.linalg.norm(np.minimum(apart, 1 - apart), axis=2) + np.eye(PICTURES)
    assert apart.min() > 0.17, "of 32 places 0.19 is the most there can be"


def test_lamps_keep_power_and_place():
    matrix = np.array(((1, 0, 0, 5), (0, 1, 0, 6), (0, 0, 1, 7)), float)
    point = lamp_pixels("point", (4 * np.pi, 0, 0), matrix, {"size": (0.5, 0)})
    np.testing.assert_allclose(point[:2], ((5, 6, 7, 1), (1, 0, 0, 0.25)), rtol=1e-6)
    sun = lamp_pixels("sun", (3, 2, 1), matrix, {"angle": 0.2})
    np.testing.assert_allclose(sun[:2], ((0, 0, 1, 0), (3, 2, 1, 0.01)), atol=1e-7)


def test_lamps_keep_their_shape():
    area = lamp_pixels("rectangle", (1, 1, 1), np.eye(3, 4), {"size": (1, 1), "spread": np.pi / 2})
    focus = 1 / (1 - np.pi / 4)  # of radiance (1 - tan) along the normal
    np.testing.assert_allclose(area[1:3, [0, 3]], ((focus / np.pi, 1 / np.pi), (0, 1)), atol=1e-6)
    wide = lamp_pixels("disk", (1, 1, 1), np.eye(3, 4), {"size": (1, 1), "spread": np.pi})
    assert wide[2, 3] == 0
    spot = {"size": (0, 0), "angle": 1.0, "cone_scale": (2.0, 0.5), "cosine": 1}
    scaled = lamp_pixels("spot", (1, 1, 1), np.eye(3, 4), spot)
    np.testing.assert_allclose(scaled[3:], ((0.5, 0, 0, 0), (0, 2, 0, 1)), atol=1e-7)
    even = lamp_pixels("spot", (1, 1, 1), np.eye(3, 4), {**spot, "cone_scale": (1.0, 1.0)})
    assert not even[3:, :3].any()


@pytest.mark.parametrize(
    ("size", "spread", "count"), [((4, 1), 0.5, 1), ((1, 4), 0.5, 1), ((1, 1), 0.5, 0), ((4, 1), np.pi, 0)]
)
def test_long_lamps_of_a_spread_are_counted_as_simpler(size, spread, count):
    with RealtimeScene() as scene:
        scene.add_light("rectangle", (1, 1, 1), np.eye(3, 4), size=size, spread=spread)
        assert scene.simpler_lamps == count
        scene.clear_lights()
        assert scene.simpler_lamps == 0


def test_models_of_btfs_have_no_rows():
    with pytest.raises(VelourError, match="no lobe table"):
        lobe_rows_job(Model.load(BTF_MODEL))


def test_maps_of_a_btf_hold_its_terms():
    with Model.load(BTF_MODEL) as model, btf_maps_job(model) as job:
        report = job.run()
        table = job.result_table()
        coefficients = model.info()["coefficients"]
    (side,) = report["sides"]
    assert len(side["terms"]) == coefficients
    assert side["layers"] == -(-coefficients // 4) + 1
    assert report["levels"][0][1:] == [16, 16]
    assert table.shape[0] == side["layers"] * 18
    relief = table.reshape(side["layers"], 18, -1, 4)[-1, 1:17, 1:17, 0]
    assert relief.min() >= side["bottom"] - 1e-6
    assert relief.max() <= side["top"] + 1e-6


def test_only_btfs_of_srbfs_have_maps(model_file):
    with Model.load(model_file) as model, pytest.raises(VelourError, match="method SRBF"):
        btf_maps_job(model)
