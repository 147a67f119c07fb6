"""Pictures of measurements for browsers, and the cache that keeps them."""

import os
import shutil
import threading

import inputs
import numpy as np
import pytest
from velour.core.measurement_files import find_measurements
from velour.core.thumbnail_job import ThumbnailJob
from velour.core.thumbnails import SIDE, thumbnail, thumbnail_folder
from velour.native import Status, VelourError, images

DISC = np.hypot(*np.mgrid[-1 : 1 : SIDE * 1j, -1 : 1 : SIDE * 1j]) < 0.8  # of the ball


@pytest.fixture
def folder(tmp_path):
    made = tmp_path / "measurements"
    made.mkdir()
    return made


def _only(folder):
    (file,) = find_measurements(folder).files
    return file


def _cache(folder):
    return folder.parent / "cache"


def _of(folder, check=lambda: None):
    return thumbnail(_only(folder), _cache(folder), check)


def _kept(folder):
    return list(thumbnail_folder(_cache(folder)).glob("*.npz"))


def _refuse():
    raise AssertionError("it is made anew")


def test_a_ball_of_the_measurement(folder, measurement_file):
    shutil.copy(measurement_file, folder)
    made = _of(folder)
    assert made.sentence is None
    assert made.facts == {"kind": "measurement", "format": "merl", "isotropic": True}
    assert made.pixels.shape == (SIDE, SIDE, 4)
    assert made.pixels.dtype == np.uint8
    red, _green, blue, alpha = made.pixels.transpose(2, 0, 1).astype(float)
    assert alpha.min() == 255
    assert np.median(red[DISC]) > 1.5 * np.median(blue[DISC])  # (0.5, 0.2, 0.1)
    assert np.array_equal(red[:8, :8], blue[:8, :8])  # the backdrop is gray


def test_a_model_looks_like_its_measurement(folder, tmp_path, measurement_file, model_file):
    shutil.copy(model_file, folder)
    other = tmp_path / "other"
    other.mkdir()
    shutil.copy(measurement_file, other)
    model, measured = _of(folder), _of(other)
    assert model.facts["kind"] == "model"
    difference = np.abs(model.pixels.astype(float) - measured.pixels)[..., :3]
    assert difference.mean() < 6
    assert np.abs(model.pixels.astype(float)[::-1] - measured.pixels)[..., :3].mean() > 12  # upside down


def test_made_once_whatever_the_name_and_anew_for_another_content(folder, model_file, measurement_file):
    shutil.copy(model_file, folder / "a.velour")
    first = _of(folder)
    again = _of(folder, _refuse)
    assert np.array_equal(again.pixels, first.pixels)
    assert again.facts == first.facts
    os.rename(folder / "a.velour", folder / "b.velour")
    assert np.array_equal(_of(folder, _refuse).pixels, first.pixels)
    shutil.copy(measurement_file, folder / "b.velour")  # a file is what it holds
    with pytest.raises(AssertionError, match="made anew"):
        _of(folder, _refuse)


def _write_set(folder, color):
    """A BTF of one color: but for the pictures, all are the same to the last byte."""
    folder.mkdir(exist_ok=True)
    lines = ["file,theta_l,phi_l,theta_v,phi_v"]
    for pair in range(4):
        images.write(folder / f"{pair}.exr", np.full((2, 2, 3), color, np.float32))
        lines.append(f"{pair}.exr,{30 * (pair % 2)},0,{30 * (pair // 2)},0")
    (folder / "btf.csv").write_text("\n".join(lines) + "\n")


def _middle(thumbnail):
    side = SIDE // 2
    return thumbnail.pixels[side - 4 : side + 4, side - 4 : side + 4, :3].astype(float).mean((0, 1))


def test_sets_with_equal_indices_have_pictures_of_their_own(folder):
    _write_set(folder / "red", (0.4, 0.02, 0.02))
    _write_set(folder / "blue", (0.02, 0.02, 0.4))
    blue, red = (
        _middle(thumbnail(file, _cache(folder), lambda: None)) for file in find_measurements(folder).files
    )
    assert red[0] > 2 * red[2]
    assert blue[2] > 2 * blue[0]


def test_a_set_whose_pictures_are_replaced_has_a_new_one(folder):
    _write_set(folder / "set", (0.4, 0.02, 0.02))
    index = folder / "set/btf.csv"
    times = index.stat().st_atime_ns, index.stat().st_mtime_ns
    red = _middle(_of(folder))
    assert red[0] > 2 * red[2]
    _write_set(folder / "set", (0.02, 0.02, 0.4))
    os.utime(index, ns=times)
    blue = _middle(_of(folder))
    assert blue[2] > 2 * blue[0]


@pytest.mark.parametrize("damage", [b"", b"PK\x05\x06" + bytes(18), b"no archive at all", None])
def test_a_damaged_cache_is_mended(folder, model_file, damage):
    shutil.copy(model_file, folder)
    first = _of(folder)
    (kept,) = _kept(folder)
    kept.write_bytes(kept.read_bytes()[:-100] if damage is None else damage)
    assert np.array_equal(_of(folder).pixels, first.pixels)
    assert np.array_equal(_of(folder, _refuse).pixels, first.pixels)


def test_arrays_of_another_size_are_not_taken(folder, model_file):
    shutil.copy(model_file, folder)
    first = _of(folder)
    (kept,) = _kept(folder)
    np.savez_compressed(kept, pixels=np.zeros((2, 2, 4), np.uint8), facts=np.frombuffer(b"{}", np.uint8))
    assert np.array_equal(_of(folder).pixels, first.pixels)


def test_who_cannot_write_the_cache_goes_without(folder, model_file, tmp_path):
    shutil.copy(model_file, folder)
    (tmp_path / "cache").write_bytes(b"a file where the folder would be")
    assert _of(folder).pixels is not None


@pytest.mark.parametrize("name", ["a.binary", "a.bsdf", "a.brdf", "a.velour", "a.btf"])
def test_a_broken_file_is_a_sentence(folder, name):
    (folder / name).write_bytes(b"nothing of the kind" * 20)
    made = _of(folder)
    assert made.pixels is None
    assert name in made.sentence
    assert made.sentence.endswith(".")
    assert not _kept(folder)


def test_a_file_that_is_gone_is_a_sentence(folder, model_file):
    shutil.copy(model_file, folder / "a.velour")
    file = _only(folder)
    os.remove(file.path)
    made = thumbnail(file, _cache(folder), lambda: None)
    assert made.pixels is None
    assert "a.velour cannot be read" in made.sentence


def _several(folder, model_file):
    """All of different contents."""
    for path in (inputs.BTF_MODEL, inputs.BRUSHED_MODEL, model_file):
        shutil.copy(path, folder)
    return find_measurements(folder).files


def test_a_job_hands_on_each_in_order(folder, model_file):
    files = _several(folder, model_file)
    received = []
    job = ThumbnailJob(files, _cache(folder), lambda *made: received.append(made)).start()
    fractions = []
    assert job.wait(lambda state: fractions.append(state.fraction))
    assert [file for file, _made in received] == list(files)
    assert all(made.pixels is not None for _file, made in received)
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1.0


def test_a_job_without_files_is_done(folder):
    job = ThumbnailJob((), _cache(folder), _refuse).start()
    assert job.wait()
    assert job.poll().fraction == 1.0


@pytest.mark.parametrize("end", [ThumbnailJob.cancel, ThumbnailJob.close])
def test_a_cancelled_job_makes_no_more(folder, model_file, end):
    files = _several(folder, model_file)
    received, first = [], threading.Event()

    def receive(file, _made):
        received.append(file)
        first.set()

    job = ThumbnailJob(files, _cache(folder), receive).start()
    assert first.wait(60)
    end(job)
    with pytest.raises(VelourError) as cancelled:
        job.wait()
    assert cancelled.value.status == Status.CANCELLED
    while job.poll().running:
        pass
    assert len(received) < len(files)
