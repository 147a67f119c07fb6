"""Exit codes, sentences, hostile files, interruption."""

from __future__ import annotations

import errno
import os
import random
import shutil
import signal
import subprocess
import time

import inputs
import numpy as np
import pytest
from command_line import command, environment, hear_ctrl_c, program, refused, velour
from velour.core import files

NOISE = random.Random(1).randbytes(4096)
RENDER = ["render", "--mesh", "m.obj", "--material", "m", "--world", "w.hdr", "-o", "o.exr"]


OBSERVE = ["observe", *RENDER[1:-1], "o.json"]


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["paint"],
        ["info"],
        ["fit", "x"],
        ["fit", "x", "-o", "y", "--tolerance", "nan"],
        ["fit", "x", "-o", "y", "--max-lobes", "0"],
        ["fit", "x", "-o", "y", "--kernel", "box"],
        ["fit", "x", "-o", "y", "--model", "box"],
        ["fit", "x", "-o", "y", "--tol", "0.1"],
        ["compare", "x"],
        ["compare", "x", "y", "--ggx"],
        ["compare", "x", "--principled", "--ggx"],
        [*RENDER, "--size", "640"],
        [*RENDER, "--spp", "-1"],
        [*RENDER, "--split", "49"],
        [*RENDER, "--strategy", "luck"],
        [*RENDER, "--camera", "1,2,3"],
        [*OBSERVE, "--spp", "8"],
        [*OBSERVE, "--bounces", "-1"],
        [*RENDER, "--camera", "0,0,1,0,0,0,180"],
        [*RENDER, "--texture-scale", "2,0"],
        [*RENDER, "--texture-scale", "1,2,3"],
        [*RENDER, "--texture-offset", "1"],
        [*RENDER, "--samples", "8"],
        [*RENDER, "--samples", "8:8"],
        [*RENDER, "--samples", "-8:8"],
        [*RENDER, "--crop", "0:4"],
        [*RENDER, "--crop", "4:0,0:4"],
        ["merge", "part.exr"],
        ["merge", "-o", "whole.exr"],
    ],
)
def test_wrong_usage_is_2(arguments):
    status, out, err = velour(*arguments)
    assert (status, out) == (2, "")
    assert "usage: velour" in err


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["-o", "f"], "--microsurface"),
        (["weave", "--microsurface", "-o", "f"], "--microsurface"),
        (["--microsurface", "--texels", 8, "-o", "f"], "--texels"),
        (["weave", "--metal", "gold", "-o", "f"], "--metal"),
        (["weave", "--period", "1,1", "-o", "f"], "--period"),
        (["tartan", "-o", "f"], "tartan"),
        (["nowhere.ply", "-o", "f"], "nowhere.ply"),
        (["weave", "--views", "many", "-o", "f"], "many"),
    ],
)
def test_captures_that_cannot_be_are_refused_with_a_sentence(arguments, word, tmp_path):
    arguments[-1] = tmp_path / "f"
    assert word in refused("capture", *arguments)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("arguments", "status"), [(["info", "/nowhere/wool.binary"], 1), (["fit", "x"], 2), (["--version"], 0)]
)
def test_a_process_ends_as_main_returns(arguments, status):
    assert program(*arguments) == velour(*arguments)
    assert program(*arguments).status == status


def test_help_and_version():
    assert velour("--version").out.startswith("velour 0.")
    for verb in ("info", "fit", "compare", "render", "merge", "capture"):
        assert "--json-file" in velour(verb, "--help").out


def test_missing_library(tmp_path):
    library = str(tmp_path / "libvelour.so")
    assert "libvelour" in refused("info", "x", run=program, VELOUR_LIBRARY=library)


def test_a_missing_file_is_named():
    assert "/nowhere/wool.binary" in refused("info", "/nowhere/wool.binary")


def _merl_header(*sizes) -> bytes:
    return np.array(sizes, "<i4").tobytes()


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"\0",
        NOISE,
        b"\x76\x2f\x31\x01",
        b"\x76\x2f\x31\x01" + b"\xff" * 4096,
        b"tensor_file\0" + b"\xff" * 64,
        _merl_header(90, 90, 180),
        _merl_header(90, 90, 180) + b"\0" * 1000,
        _merl_header(-1, 90, 180) + b"\0" * 1000,
        _merl_header(2**30, 2**30, 2**30) + b"\0" * 1000,
    ],
    ids=lambda content: f"{len(content)} bytes {content[:4].hex()}",
)
@pytest.mark.parametrize("verb", ["info", "fit", "compare", "render"])
def test_hostile_files_end_in_a_sentence_with_the_name(content, verb, tmp_path, mesh_file, world_file):
    path = tmp_path / "hostile.dat"
    path.write_bytes(content)
    out = tmp_path / "out.exr"
    arguments = {
        "info": [path],
        "fit": [path, "-o", out],
        "compare": [path, path],
        "render": ["--mesh", mesh_file, "--world", world_file, "--material", path, "-o", out],
    }[verb]
    assert "hostile.dat" in refused(verb, *arguments)
    assert [p.name for p in tmp_path.iterdir()] == ["hostile.dat"]


@pytest.mark.parametrize("option", ["--mesh", "--world", "--reference"])
def test_hostile_scene_files(option, tmp_path, mesh_file, world_file, model_file):
    path = tmp_path / "hostile.dat"
    path.write_bytes(b"v nan nan\nf 1 2 99999999999\n" + NOISE)
    scene = ["--mesh", mesh_file, "--world", world_file]
    arguments = [*scene, "--material", model_file, "-o", tmp_path / "o.exr"]
    assert "hostile.dat" in refused("render", *arguments, option, path)


def test_a_model_that_was_cut_off(model_file, tmp_path):
    whole = model_file.read_bytes()
    path = tmp_path / "cut.velour"
    for part in (0.1, 0.5, 0.9):
        path.write_bytes(whole[: int(part * len(whole))])
        assert "cut.velour" in refused("info", path)


def test_reference_of_another_size(tmp_path, mesh_file, world_file, model_file):
    scene = ["--mesh", mesh_file, "--world", world_file]
    arguments = [*scene, "--material", model_file, "-o", tmp_path / "o.exr"]
    assert "32x16" in refused("render", *arguments, "--reference", world_file)


def test_output_that_cannot_be_written_is_said_before_the_work(measurement_file, tmp_path):
    start = time.monotonic()
    assert "does not exist" in refused("fit", measurement_file, "-o", tmp_path / "no/such/folder/m.velour")
    assert "is a folder" in refused("fit", measurement_file, "-o", tmp_path)
    assert time.monotonic() - start < 5


def test_what_no_picture_can_be_written_as_is_said_before_the_work(
    tmp_path, mesh_file, world_file, model_file
):
    options = "--mesh", mesh_file, "--material", model_file, "--world", world_file, "--spp", "1000000"
    sentence = refused("render", *options, "-o", tmp_path / "night.tif")
    assert "night.tif can only be written as .exr or .png" in sentence


def test_devices_and_pipes_are_not_replaced(tmp_path, model_file):
    pipe = tmp_path / "pipe.gltf"
    os.mkfifo(pipe)
    for verb in (["info", model_file, "--json-file"], ["export", model_file, "--to", "gltf", "-o"]):
        assert "pipe.gltf is not a regular file; choose another name" in refused(*verb, pipe)
        assert pipe.is_fifo()


def test_inputs_are_not_replaced(tmp_path, model_file, mesh_file, world_file):
    before = world_file.read_bytes()
    scene = ["--mesh", mesh_file, "--material", model_file, "--world", world_file]
    assert "would replace the input" in refused("render", *scene, "-o", world_file)
    assert world_file.read_bytes() == before
    folder = tmp_path / "set"
    folder.mkdir()
    (folder / "btf.json").write_text("{}")
    assert "would replace a file of the input" in refused("compress", folder, "-o", folder / "btf.json")
    assert (folder / "btf.json").read_text() == "{}"
    votf = ["votf", mesh_file, "--material", model_file]
    assert "would replace the input" in refused(*votf, "-o", mesh_file)
    assert "would replace the input" in refused(*votf, "-o", tmp_path / "s.velour", "--json-file", model_file)


def test_outputs_do_not_replace_each_other(tmp_path, model_file, mesh_file, world_file):
    (tmp_path / "link").symlink_to(tmp_path)
    scene = ["render", "--mesh", mesh_file, "--material", model_file, "--world", world_file]
    picture, same = tmp_path / "o.exr", tmp_path / "link/o.exr"
    for option in (("--denoise", "--noisy-image", same), ("--json-file", same)):
        assert f"{option[-2]} name the same file, {picture}" in refused(*scene, "-o", picture, *option)
    model = tmp_path / "m.velour"
    assert "name the same file" in refused("fit", model_file, "-o", model, "--json-file", model)
    assert "only be written as .obj" in refused("tile", "weave", "-o", tmp_path / "weave.mtl")
    assert list(tmp_path.glob("*.*")) == []


def test_names_that_are_not_utf8_end_in_a_sentence(tmp_path, mesh_file, model_file):
    strange = os.fsdecode(bytes(tmp_path) + b"/m\xfcll.obj")
    shutil.copy(mesh_file, strange)
    votf = ("votf", strange, "--material", model_file, "--texels", 8, "--check-views", 0)
    result = velour(*votf, "-o", tmp_path / "s.velour")
    assert result.status == 0, result.err
    assert velour("info", tmp_path / "s.velour", "--json").json["shell"]["source"].endswith("/m?ll.obj")
    assert "\\udcfc" not in refused("tile", os.fsdecode(b"\xfc"), "-o", tmp_path / "t.obj")
    assert "instruction set" in refused("info", model_file, "--simd", os.fsdecode(b"\xfc"))


def test_words_are_no_inputs(tmp_path, monkeypatch, model_file):
    """Results are replaced in folders whose names are a verb, a tile, or the value of an option."""
    monkeypatch.chdir(tmp_path)
    for name in ("tile", "weave", "gravel", "gltf"):
        (tmp_path / name).mkdir()
    votf = ["votf", "gravel", "--material", model_file, "--texels", 8, "--check-views", 0]
    calls = [("tile", "weave", "-o", f"{name}/weave.obj") for name in ("tile", "weave")]
    for call in [
        *calls,
        ("export", model_file, "--to", "gltf", "-o", "gltf/m.gltf"),
        [*votf, "-o", "gravel/s.velour"],
    ] * 2:
        status, _, err = velour(*call)
        assert status == 0, err


def test_a_full_disk_is_named_with_the_file(tmp_path):
    def full(_path):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with pytest.raises(OSError, match=r"report\.json") as caught:
        files.write_atomic(tmp_path / "report.json", full)
    assert caught.value.errno == errno.ENOSPC
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_lets_nobody_write_is_said_before_the_work(tmp_path, mesh_file, world_file, model_file):
    """One of the kernel's own: root may write to any other."""
    scene = ["--mesh", mesh_file, "--material", model_file, "--world", world_file]
    long = ["render", *scene, "--size", "4096x4096", "--spp", 10**6]
    for more in (["-o", "/proc/self/o.exr"], ["-o", tmp_path / "o.exr", "--json-file", "/proc/self/o.json"]):
        sentence = refused(*long, *more)
        assert more[-1] in sentence
        assert "is not writable" in sentence
    assert not list(tmp_path.iterdir())


def test_a_failed_fit_leaves_the_old_model(tmp_path):
    model = tmp_path / "m.velour"
    model.write_text("old")
    bad = tmp_path / "bad.binary"
    bad.write_bytes(b"bad")
    refused("fit", bad, "-o", model)
    assert model.read_text() == "old"


def _interrupted(arguments, stage: str) -> int:
    """The status of a run whose user, at a terminal, presses Ctrl-C when its progress bar shows the stage."""
    reader, terminal = os.openpty()
    process = subprocess.Popen(
        command(*arguments), env=environment(), stderr=terminal, preexec_fn=hear_ctrl_c
    )
    os.close(terminal)
    try:
        said = _until(reader, f"% {stage}")
        assert process.poll() is None, said
        process.send_signal(signal.SIGINT)
        start = time.monotonic()
        said = _until(reader)
        status = process.wait(timeout=120)
        assert time.monotonic() - start < 3
        assert said.split("\r\x1b[K")[-1] == "velour: Interrupted.\r\n"  # in place of the bar
        return status
    finally:
        process.kill()
        os.close(reader)


def _until(reader: int, word: str | None = None) -> str:
    """What the process says up to the word, or to its end."""
    said = ""
    while word is None or word not in said:
        try:
            said += os.read(reader, 4096).decode()
        except OSError:  # nobody has the terminal open any more
            break
    return said


def test_interrupted_render(tmp_path, mesh_file, world_file, model_file):
    out = tmp_path / "o.exr"
    arguments = ["render", "--mesh", mesh_file, "--world", world_file, "--material", model_file, "-o", out]
    assert _interrupted([*arguments, "--size", "1024x1024", "--spp", 100000], "render") == 130
    assert not list(tmp_path.iterdir())


def test_interrupted_fit(tmp_path):
    sharp = inputs.write_merl(tmp_path / "sharp.binary", sharpness=5000.0, gloss=500.0)
    out = tmp_path / "m.velour"
    out.write_text("old")
    arguments = ["fit", sharp, "-o", out, "--model", "scattered", "--max-lobes", 64, "--tolerance", 1e-6]
    assert _interrupted(arguments, "fitting") == 130
    assert out.read_text() == "old"
    assert {p.name for p in tmp_path.iterdir()} == {"m.velour", "sharp.binary"}


def test_interrupted_capture(tmp_path):
    arguments = ["capture", "--microsurface", "--rays", 10**11, "-o", tmp_path / "c.binary"]
    assert _interrupted(arguments, "tracing") == 130
    assert not list(tmp_path.iterdir())


def test_a_damaged_observation_is_refused_with_its_field(tmp_path, mesh_file, model_file, world_file):
    path = tmp_path / "scene.json"
    path.write_text('{"format": "velour-observation", "version": 1}')
    assert "'view'" in refused("info", path)
    scene = ["--mesh", mesh_file, "--material", model_file, "--world", world_file]
    sentence = refused("observe", *scene, "-o", tmp_path / "new.json", "--merge", path)
    assert str(path) in sentence
    assert not (tmp_path / "new.json").exists()
