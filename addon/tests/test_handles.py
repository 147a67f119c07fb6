"""The wrapper classes over the real library."""

from __future__ import annotations

import gc

import numpy as np
import pytest
from velour.native import (
    Measurement,
    Model,
    Observation,
    Scene,
    Status,
    VelourError,
    compare_job,
    fit_job,
    images,
    observe_job,
    render_job,
)

UP = np.array([[0.0, 0.0, 1.0]], np.float32)


def test_closing_twice_is_fine_and_use_after_it_is_refused(measurement_file):
    measurement = Measurement.load(measurement_file)
    measurement.close()
    measurement.close()
    assert measurement.closed
    with pytest.raises(VelourError, match="closed") as caught:
        measurement.info()
    assert caught.value.status == Status.INVALID_STATE


def test_closing_frees_once(measurement_file):
    measurement, freed = Measurement.load(measurement_file), []
    free, pointer = measurement._free, measurement.pointer.value
    measurement._free = lambda handle: (freed.append(handle.value), free(handle))
    measurement.close()
    measurement.close()
    assert freed == [pointer]


def test_handles_may_go_in_any_order(measurement_file):
    measurement = Measurement.load(measurement_file)
    job = fit_job(measurement, max_lobes=1)
    measurement.close()  # the job keeps what it needs
    job.run()
    model = job.result_model()
    job.close()
    assert model.info()["lobes"] > 0
    del model
    gc.collect()


def test_measurement_values(measurement_file):
    with Measurement.load(measurement_file) as measurement:
        f, valid = measurement.eval((0, 0, 1), np.array([[0, 0, 1], [0, 0, -1]], np.float32))
    assert valid.tolist() == [True, False]
    np.testing.assert_allclose(f[0], np.array([0.5, 0.2, 0.1]) / np.pi + 0.8, rtol=1e-3)
    assert not f[1].any()


def test_model_round_trip_through_bytes(model_file):
    with Model.load(model_file) as model, Model.from_bytes(model.bytes(), "packed") as copy:
        assert copy.info() == model.info()
        wl = np.random.default_rng(1).normal(size=(50, 3)).astype(np.float32)
        wl[:, 2] = abs(wl[:, 2])
        wl /= np.linalg.norm(wl, axis=1, keepdims=True)
        for ours, theirs in zip(model.eval((0.6, 0, 0.8), wl), copy.eval((0.6, 0, 0.8), wl), strict=True):
            np.testing.assert_array_equal(ours, theirs)


def test_sampled_directions_have_the_density_that_eval_reports(model_file):
    u = np.random.default_rng(2).random((200, 2), np.float32)
    with Model.load(model_file) as model:
        wl, pdf = model.sample((0.6, 0, 0.8), u)
        _, again = model.eval((0.6, 0, 0.8), wl)
    np.testing.assert_allclose(np.linalg.norm(wl, axis=1), 1, atol=1e-5)
    np.testing.assert_allclose(pdf, again, rtol=1e-4)
    assert (pdf > 0).all()


def test_bytes_that_are_no_model_name_what_they_were_called():
    with pytest.raises(VelourError, match=r"wool\.velour"):
        Model.from_bytes(b"not a model", "wool.velour")


def test_arrays_are_checked_before_the_call(model_file):
    with Model.load(model_file) as model:
        with pytest.raises(VelourError, match="wl"):
            model.eval((0, 0, 1), UP.astype(np.float64))
        with pytest.raises(VelourError, match="wv"):
            model.eval((0, 1), UP)


def test_progress_never_falls_and_ends_at_one(measurement_file):
    seen = []
    with Measurement.load(measurement_file) as measurement, fit_job(measurement, max_lobes=2) as job:
        job.run(seen.append)
    fractions = [state.fraction for state in seen]
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1
    assert seen[-1].state == "done"


class _CallbackError(Exception):
    pass


def _long_fit(measurement):
    return fit_job(measurement, model="scattered", max_lobes=64, tolerance=1e-6)


def test_a_progress_callback_that_raises_stops_the_job(measurement_file):
    def progress(_state):
        raise _CallbackError

    with Measurement.load(measurement_file) as measurement, _long_fit(measurement) as job:
        with pytest.raises(_CallbackError):
            job.start().wait(progress)
        assert job.poll().state == "cancelled"


def test_cancelled_jobs_say_so_and_can_run_again(measurement_file, model_file):
    with Measurement.load(measurement_file) as measurement, _long_fit(measurement) as job:
        job.start().cancel()
        with pytest.raises(VelourError) as caught:
            job.wait()
        assert caught.value.cancelled
        assert job.start().wait(timeout=0.05) is False
        job.cancel()


def test_closing_a_running_job_ends_it(measurement_file):
    with Measurement.load(measurement_file) as measurement:
        job = _long_fit(measurement).start()
    job.close()


def test_compare(measurement_file, model_file):
    with (
        Measurement.load(measurement_file) as measurement,
        Model.load(model_file) as model,
        compare_job(measurement, model) as job,
    ):
        report = job.run()
    assert 0 < report["relative_l2"] < 1


def _octahedron():
    positions = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], np.float32)
    triangles = np.array(
        [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]], np.uint32
    )
    return positions, triangles


def test_instances_at_once_are_as_one_by_one():
    matrices = np.zeros((3, 3, 4), np.float32)
    for i, matrix in enumerate(matrices):
        matrix[:, :3], matrix[:, 3] = (0.5 + 0.2 * i) * np.eye(3), (2 * i, i, 0)
    pictures = []
    for at_once in (True, False):
        with Scene() as scene:
            mesh, _ = scene.add_mesh(*_octahedron(), smooth=np.zeros(8, np.uint8))
            materials = [scene.add_principled_material(base_color=(0.8, 0.4, 0.2))]
            if at_once:
                scene.add_instances(
                    np.full(len(matrices), mesh, np.uint32), matrices, materials, hidden=("shadows",)
                )
            else:
                for matrix in matrices:
                    scene.add_instance(mesh, matrix, materials, hidden=("shadows",))
            scene.set_world_color((1, 1, 1))
            scene.frame_camera(1.0)
            scene.commit()
            assert scene.info()["instances"] == 3
            with render_job(scene, width=16, height=16, spp=8) as job:
                job.run()
                pictures.append(job.read_pass("Combined"))
    assert pictures[0][..., 3].max() == 1
    np.testing.assert_array_equal(*pictures)


def test_instances_that_are_no_matrices_are_refused():
    with Scene() as scene:
        meshes = np.full(2, scene.add_mesh(*_octahedron())[0], np.uint32)
        material = scene.add_principled_material()
        with pytest.raises(VelourError, match="n x 3 x 4 is needed"):
            scene.add_instances(meshes, np.zeros((2, 4, 4), np.float32), [material])
        with pytest.raises(VelourError, match="meshes has shape"):
            scene.add_instances(meshes[:1], np.zeros((2, 3, 4), np.float32), [material])
        with pytest.raises(VelourError, match="not finite"):
            scene.add_instances(meshes, np.full((2, 3, 4), np.nan, np.float32), [material])


def _lit_octahedron(**principled) -> Scene:
    scene = Scene()
    mesh, dropped = scene.add_mesh(*_octahedron(), smooth=np.zeros(8, np.uint8))
    assert dropped == 0
    scene.add_instance(mesh, np.eye(4), [scene.add_principled_material(**principled)])
    scene.set_world_color((1, 1, 1))
    scene.frame_camera(1.0)
    scene.commit()
    return scene


def test_render_and_read_passes():
    with (
        _lit_octahedron(base_color=(0.8, 0.4, 0.2)) as scene,
        render_job(scene, width=24, height=24, spp=16) as job,
    ):
        report = job.run()
        combined, depth = job.read_pass("Combined"), job.read_pass("Depth")
        assert scene.info()["triangles"] == 8
        with pytest.raises(VelourError, match="passes are"):
            job.read_pass("Shadow")
        with pytest.raises(VelourError, match="buffer"):
            job.read_pass("Depth", np.empty(3, np.float32))
    assert report["nan_samples"] == 0
    assert combined.shape == (24, 24, 4)
    assert depth.shape == (24, 24, 1)
    middle = combined[12, 12, :3]
    assert middle[0] > middle[1] > middle[2] > 0


def test_degenerate_triangles_are_counted():
    positions, triangles = _octahedron()
    triangles = np.concatenate([triangles, [[0, 0, 1]]]).astype(np.uint32)
    with Scene() as scene:
        assert scene.add_mesh(positions, triangles)[1] == 1


def test_an_uncommitted_scene_is_refused():
    with Scene() as scene, pytest.raises(VelourError):
        render_job(scene, width=8, height=8).run()


def test_pictures_round_trip(tmp_path):
    pixels = np.random.default_rng(3).random((5, 7, 3), np.float32)
    images.write(tmp_path / "p.exr", pixels)
    np.testing.assert_allclose(images.read(tmp_path / "p.exr"), pixels, rtol=1e-6)
    assert [path.name for path in tmp_path.iterdir()] == ["p.exr"]


def test_picture_errors():
    reference = np.full((4, 4, 3), 2.0, np.float32)
    assert images.compare(reference, reference) == (0.0, 0.0)
    rmse, relmse = images.compare(reference + np.float32(0.5), reference)
    assert rmse == pytest.approx(0.5)
    assert relmse == pytest.approx(0.25 / (4 + 0.04))
    with pytest.raises(VelourError, match="must agree"):
        images.compare(reference, reference[:2].copy())


def test_observations_grow_by_merging(tmp_path):
    with Scene() as scene, Observation.of_nothing() as seen:
        square = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32)
        mesh, _ = scene.add_mesh(square, np.array([[0, 1, 2], [0, 2, 3]], np.uint32))
        scene.add_instance(mesh, np.eye(4)[:3], [scene.add_principled_material(roughness=0.5)])
        scene.set_world_color((1, 1, 1))
        scene.look_at((0, -1, 2), (0, 0, 0), 0.3, 1.0)
        scene.commit()
        with observe_job(scene, 0, width=16, height=16, threads=2) as job:
            report = job.run()
            with job.result_observation() as frame:
                seen.merge(frame)
                seen.merge(frame)
        info = seen.info()
        seen.save(tmp_path / "scene.json")
        with Observation.load(tmp_path / "scene.json") as read:
            assert read.info() == info
    assert (info["frames"], info["weight"]) == (2, 2 * report["weight"])
    assert info["light_density"] == pytest.approx(1 / (4 * np.pi), rel=1e-5)
    assert info["views"][0] < np.degrees(np.arctan(0.5)) < info["views"][1]


def test_what_cannot_be_observed_is_refused():
    with Scene() as scene, pytest.raises(VelourError, match="committed"):
        observe_job(scene, 0)
    with Observation.of_nothing() as seen:
        assert (seen.info()["frames"], seen.info()["views"]) == (0, None)
