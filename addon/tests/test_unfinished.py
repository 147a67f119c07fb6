"""Renders that SIGTERM or the time limit ends: the side file, the exit status, the next run."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest
from command_line import command, environment, refused, velour
from velour.core.picture_parts import SAMPLES, open_part
from velour.native import images

UNFINISHED = 3
AT_ONCE = ("--time-limit", 1e-9)  # after the first pass of one camera ray


@pytest.fixture
def arguments(mesh_file, world_file, model_file, tmp_path):
    return [
        "render", "--mesh", mesh_file, "--material", model_file, "--world", world_file, "--size", "32x24",
        "--threads", 2, "-o", tmp_path / "o.exr",
    ]  # fmt: skip


@pytest.fixture
def side(tmp_path):
    return tmp_path / "o.unfinished.exr"


def largest_difference(one, other) -> float:
    return float(np.abs(images.read(one) - images.read(other)).max() / images.read(other).max())


def test_the_next_run_goes_on_to_the_uninterrupted_picture(arguments, side, tmp_path):
    out, whole = tmp_path / "o.exr", tmp_path / "whole.exr"
    few = [*arguments, "--spp", 37, "--split", 5]
    assert velour(*few, "-o", whole, "--quiet").status == 0
    for samples in ("0:5", "0:10"):
        status, said, err = velour(*few, *AT_ONCE, "--json")
        assert (status, said) == (UNFINISHED, "")
        assert f"has samples {samples}. Run the same command again to continue." in err
        assert not out.exists()
        assert images.header(side)["texts"][SAMPLES] == samples
    assert velour(*few, "--json").json["samples"] == [[0, 37]]
    assert largest_difference(out, whole) < 1e-6
    assert images.header(out) == images.header(whole)
    assert not side.exists()


def test_what_the_side_file_has_is_in_the_picture(arguments, side, tmp_path):
    few = [*arguments, "--spp", 37, "--split", 5]
    assert velour(*few, "-o", tmp_path / "whole.exr", "--quiet").status == 0
    assert velour(*few, *AT_ONCE).status == UNFINISHED
    part, texts = open_part(side), images.header(side)["texts"]
    images.write_part(side, 2 * part.read(), part.frame, texts)
    assert velour(*few, "--quiet").status == 0
    twice = images.read(tmp_path / "o.exr").mean() / images.read(tmp_path / "whole.exr").mean()
    assert twice == pytest.approx(1 + 1 / 8, rel=0.05)  # one of eight camera rays counts twice


def test_parts_go_on_too(arguments, side, tmp_path):
    part = [*arguments, "--spp", 64, "--samples", "16:64", "--crop", "3:20,5:24"]
    assert velour(*part, "-o", tmp_path / "whole.exr", "--quiet").status == 0
    assert velour(*part, *AT_ONCE).status == UNFINISHED
    assert images.header(side)["texts"][SAMPLES] == "16:24"
    assert velour(*part, "--quiet").status == 0
    assert largest_difference(tmp_path / "o.exr", tmp_path / "whole.exr") < 1e-6
    assert images.header(tmp_path / "o.exr") == images.header(tmp_path / "whole.exr")


def test_the_side_file_of_another_render_is_refused(arguments, side):
    assert velour(*arguments, *AT_ONCE).status == UNFINISHED
    kept = side.read_bytes()
    for more, word in [
        (("--seed", 1), "seed differs"),
        (("--samples", "8:64"), "its pixels or samples differ"),
        (("--samples", "0:8"), "its pixels or samples differ"),
        (("--crop", "0:4,0:4"), "its pixels or samples differ"),
    ]:
        sentence = refused(*arguments, *more)
        assert f"{side} belongs to another render" in sentence
        assert word in sentence
    assert side.read_bytes() == kept


def test_pictures_with_a_noise_target_begin_anew(arguments, side, tmp_path):
    noisy = [*arguments, "--noise", 0.2]
    result = velour(*noisy, *AT_ONCE)
    assert result.status == UNFINISHED
    assert "starts over" in result.err
    assert SAMPLES not in images.header(side)["texts"]
    assert velour(*noisy, "--quiet").status == 0
    assert not side.exists()
    assert velour(*noisy, "-o", tmp_path / "whole.exr", "--quiet").status == 0
    np.testing.assert_array_equal(images.read(tmp_path / "o.exr"), images.read(tmp_path / "whole.exr"))


def test_a_noise_target_does_not_remove_the_samples_of_another_render(arguments, side, tmp_path):
    assert velour(*arguments, *AT_ONCE).status == UNFINISHED
    kept = side.read_bytes()
    for preview in (("--noise", 0.2), ("--noise", 0.2, "-o", tmp_path / "o.png")):
        assert f"{side} belongs to another render; remove it" in refused(*arguments, *preview)
    assert side.read_bytes() == kept
    side.unlink()
    assert velour(*arguments, "--noise", 0.2, *AT_ONCE).status == UNFINISHED
    assert f"{side} belongs to another render; remove it" in refused(*arguments, "--noise", 0.3)


def _processor_seconds(pid: int) -> float:
    user, system = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[11:13]
    return (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")


def _terminated(arguments) -> tuple[int, str]:
    """Status and last line of a render that gets SIGTERM in the midst of its samples."""
    process = subprocess.Popen(
        command(*arguments, "--log-level", "info"), env=environment(), stderr=subprocess.PIPE, text=True
    )
    try:
        for line in process.stderr:
            if "Rendering" in line:
                break
        begun = _processor_seconds(process.pid)
        while process.poll() is None and _processor_seconds(process.pid) < begun + 0.2:
            time.sleep(0.01)
        process.send_signal(signal.SIGTERM)
        start = time.monotonic()
        _, err = process.communicate(timeout=300)
        assert time.monotonic() - start < 20
        return process.returncode, err.strip().splitlines()[-1]
    finally:
        process.kill()


def test_sigterm_leaves_the_samples_that_it_says(arguments, side, tmp_path):
    long = [*arguments, "--spp", 2**24, "--strategy", "mis"]  # no pilot: the samples begin at once
    status, sentence = _terminated(long)
    assert status == UNFINISHED, sentence
    assert not (tmp_path / "o.exr").exists()
    begin, end = open_part(side).ranges[0]
    assert f"has samples 0:{end}." in sentence
    assert begin == end % 8 == 0 < end < 2**24
    fresh = tmp_path / "fresh.exr"
    assert velour(*long, "--samples", f"0:{end}", "-o", fresh, "--quiet").status == 0
    np.testing.assert_array_equal(images.read(side), images.read(fresh))

    assert _terminated(long)[0] == UNFINISHED
    assert open_part(side).ranges[0][1] > end
