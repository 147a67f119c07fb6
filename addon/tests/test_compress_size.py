"""velour compress within an error, within memory, and after it was killed."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest
from command_line import command, environment, refused, velour
from kept import captured
from velour.native import Model

BYTES = 10000


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("size")


@pytest.fixture(scope="module")
def btf():
    return captured("corduroy", 12, 16, 16, 16)


@pytest.fixture(scope="module")
def large():
    """Enough points and pairs for a fit to take what it usually takes."""
    return captured("corduroy", 16, 24, 24, 16)


@pytest.fixture(scope="module", params=["srbf", "svd"])
def within(request, folder, btf):
    """A method, the error that was asked for, the report and the model."""
    path = folder / f"{request.param}.velour"
    asked = {"srbf": 0.25, "svd": 0.15}[request.param]
    arguments = ["--method", request.param, "--tolerance", asked, "--json"]
    return request.param, asked, velour("compress", btf, "-o", path, *arguments).json, path


def test_the_smallest_model_within_a_tolerance(folder, btf, within):
    method, asked, report, _ = within
    assert report["tolerance"] == asked
    assert asked * 0.9 < report["relative_l2"] <= asked
    assert not report["warnings"]
    assert 1 <= len(report["search"]) <= 6
    # The control: with four fifths of its bytes it is not within.
    arguments = ["--method", method, "--bytes", int(0.8 * report["parameter_bytes"]), "--json"]
    smaller = velour("compress", btf, "-o", folder / "smaller.velour", *arguments).json
    assert smaller["relative_l2"] > asked


def test_tensors_within_a_tolerance(folder, btf):
    """Sizes go in steps, and clusters are sought for one of them: not quite the smallest."""
    path, asked = folder / "tensors.velour", 0.15
    arguments = ["compress", btf, "-o", path, "--method", "kcta", "--json"]
    report = velour(*arguments, "--tolerance", asked).json
    assert report["relative_l2"] <= asked
    assert not report["warnings"]
    assert 1 <= len(report["search"]) <= 6
    # The control: with half of its bytes it is not within.
    assert velour(*arguments, "--bytes", report["parameter_bytes"] // 2).json["relative_l2"] > asked


def test_the_curve_is_stored_with_the_model(within):
    _, asked, report, path = within
    info = velour("info", path, "--json").json
    order, chosen = info["order"], info["order"]["chosen"]
    assert info["tolerance"] == asked
    assert info["relative_l2"] == pytest.approx(report["relative_l2"])
    assert (order, info["search"]) == (report["order"], report["search"])
    assert order["relative_l2"][chosen] == pytest.approx(report["relative_l2"], rel=1e-3)
    assert order["worst"][chosen] == pytest.approx(report["relative_l2"] / asked, rel=2e-3)
    assert order["parameter_bytes"] == sorted(order["parameter_bytes"])
    assert len(order["parameter_bytes"]) > 5
    tried = report["search"][-1]["parameter_bytes"]
    assert tried in order["parameter_bytes"]
    with Model.load(path) as model:
        assert model.info()["order"] == order


def test_without_a_tolerance_the_curve_goes_on(folder, btf):
    report = velour("compress", btf, "-o", folder / "plain.velour", "--bytes", BYTES // 4, "--json").json
    order = report["order"]
    assert report["tolerance"] == 0
    assert len(report["search"]) == 1
    assert order["worst"] == order["relative_l2"]
    assert order["parameter_bytes"][-1] > 1.5 * report["parameter_bytes"]
    assert order["relative_l2"][-1] < report["relative_l2"]


def test_what_cannot_be_met_says_what_would(folder, btf):
    path = folder / "bounded.velour"
    report = velour("compress", btf, "-o", path, "--tolerance", 0.05, "--bytes", BYTES // 4, "--json").json
    assert report["relative_l2"] > 0.05
    assert report["parameter_bytes"] <= BYTES // 4
    (warning,) = report["warning_codes"]
    assert warning["code"] in ("tolerance_needs_bytes", "tolerance_needs_more_bytes")
    assert warning["values"]["tolerance"] == 0.05
    (sentence,) = report["warnings"]
    assert "exceeds --tolerance (0.05)" in sentence


def test_a_ratio_is_bytes(folder, btf):
    raw = velour("info", btf, "--json").json["raw_bytes"]
    report = velour("compress", btf, "-o", folder / "ratio.velour", "--ratio", 100, "--json").json
    assert raw / 200 < report["parameter_bytes"] <= raw / 100
    assert velour("compress", btf, "-o", path_of(folder), "--ratio", 9, "--bytes", 9).status == 2


def path_of(folder):
    return folder / "never.velour"


def peak_megabytes(*arguments):
    """Peak memory of a separate process in millions of bytes, from its high-water mark. The peak that the
    system reports at its end would count this process as well, from which it was forked."""
    process = subprocess.Popen(command(*arguments), stdout=subprocess.DEVNULL, env=environment())
    peak = 0
    while process.poll() is None:
        with contextlib.suppress(OSError, IndexError):
            status = Path(f"/proc/{process.pid}/status").read_text()
            peak = max(peak, int(status.split("VmHWM:")[1].split()[0]))
        time.sleep(0.005)
    assert process.returncode == 0
    return peak * 1024 / 1e6


def test_memory_is_kept_to(folder, large):
    """What the fit holds beside the program, which has the library loaded."""
    program = peak_megabytes("info", large, "--quiet")
    arguments = ["compress", large, "-o", folder / "memory.velour", "--bytes", BYTES // 4, "--quiet"]
    assert peak_megabytes(*arguments, "--memory", 256_000_000) - program < 256
    assert peak_megabytes(*arguments, "--memory", 100_000_000) - program < 100
    assert peak_megabytes(*arguments) - program > 120  # the control: what it takes when it may


def test_tensors_keep_to_memory(folder, large):
    program = peak_megabytes("info", large, "--quiet")
    size = ["--method", "kcta", "--bytes", BYTES, "--memory", 64_000_000]
    assert peak_megabytes("compress", large, "-o", folder / "tensors.velour", *size, "--quiet") - program < 64


def test_too_little_memory_is_refused_with_the_least_that_would_do(folder, btf):
    for method in ("srbf", "svd", "kcta"):
        sentence = refused(
            "compress",
            btf,
            "-o",
            path_of(folder),
            "--method",
            method,
            "--bytes",
            BYTES,
            "--memory",
            1_000_000,
        )
        least = int(sentence.split("requires at least ")[1].split(" MB")[0])
        done = velour(
            "compress", btf, "-o", folder / "least.velour", "--method", method, "--bytes", BYTES,
            "--memory", least * 1_000_000, "--quiet",
        )  # fmt: skip
        assert done.status == 0


def test_memory_that_makes_another_model_says_so_and_what_would_not(folder, btf):
    def compressed(*memory):
        out = folder / "memory.velour"
        done = velour("compress", btf, "-o", out, "--bytes", BYTES, *memory, "--json", "--quiet")
        assert done.status == 0, done.err
        return done.json["warning_codes"], parameters(out)

    sentence = refused("compress", btf, "-o", path_of(folder), "--bytes", BYTES, "--memory", 1_000_000)
    least = int(sentence.split("requires at least ")[1].split(" MB")[0]) * 1_000_000
    no_warnings, unlimited = compressed()
    warnings, other = compressed("--memory", least)
    assert no_warnings == []
    (limited,) = warnings
    assert limited["code"] == "memory_limits_fit"
    assert limited["values"]["points"] < limited["values"]["usual"]
    assert other != unlimited
    warnings, same = compressed("--memory", limited["values"]["memory"])
    assert warnings == []
    assert same == unlimited


def parameters(path):
    """Values that the model gives, which its record of seconds and rates is no part of."""
    with Model.load(path) as model:
        wl = np.array([[0, 0, 1], [0.6, 0, 0.8], [0, -0.6, 0.8]], np.float32)
        return model.eval((0.28, 0, 0.96), wl)[0].tobytes()


def killed(btf, path, *arguments, kept=b".lobes."):
    """Ends a fit hard as soon as its checkpoint holds such a stage: lobes."""
    checkpoint = path.with_name(path.name + ".checkpoint")
    process = subprocess.Popen(command("compress", btf, "-o", path, *arguments, "--quiet"), env=environment())
    while process.poll() is None:
        if checkpoint.is_file() and kept in checkpoint.read_bytes():
            process.send_signal(signal.SIGKILL)
            process.wait()
        time.sleep(0.002)
    assert process.returncode < 0, "it was done before it could be killed"
    assert not path.exists()
    return checkpoint


@pytest.mark.parametrize(("method", "kept"), [("srbf", b".lobes."), ("kcta", b".shape")])
def test_a_killed_fit_goes_on(folder, btf, method, kept):
    arguments = ["--method", method, "--bytes", BYTES, "--seed", 5]
    whole, path = folder / f"whole-{method}.velour", folder / f"killed-{method}.velour"
    assert velour("compress", btf, "-o", whole, *arguments, "--quiet").status == 0
    checkpoint = killed(btf, path, *arguments, kept=kept)
    report = velour("compress", btf, "-o", path, *arguments, "--resume", "--json").json
    assert not report["warnings"]
    assert parameters(path) == parameters(whole)
    assert not checkpoint.exists()


def test_what_is_left_of_another_fit_is_ignored(folder, btf):
    path = folder / "stale.velour"
    checkpoint = killed(btf, path, "--bytes", BYTES)
    report = velour("compress", btf, "-o", path, "--bytes", BYTES // 4, "--resume", "--json").json
    (sentence,) = report["warnings"]
    assert "The fit was not resumed" in sentence
    assert str(checkpoint) in sentence
    assert not checkpoint.exists()
    checkpoint.write_bytes(b"v/1\x01" + os.urandom(500))
    report = velour("compress", btf, "-o", path, "--bytes", BYTES // 4, "--resume", "--json").json
    assert len(report["warnings"]) == 1


SHEET = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n"


@pytest.mark.parametrize(("tile", "shared"), [("sheet", True), ("net", False)])
def test_a_side_that_looks_as_another_costs_nothing(folder, tile, shared):
    if tile == "sheet":
        (folder / "sheet.obj").write_text(SHEET)
        btf = folder / "sheet.btf"
        common = ["--texels", 8, "--views", 12, "--lights", 12, "--samples", 4, "--sides", "two", "--quiet"]
        assert velour("capture", folder / "sheet.obj", *common, "-o", btf).status == 0
    else:
        btf = captured(tile, 8, 12, 12, 4, "two")
    model = folder / f"{tile}.velour"
    done = velour("compress", btf, "-o", model, "--bytes", 8000, "--quiet")
    assert done.status == 0, done.err
    info = velour("info", model, "--json").json
    above, below = (
        next(side for side in info["sides"] if side["view"] == side["light"] == name)
        for name in ("above", "below")
    )
    assert above["as"] is None
    assert below["as"] == (0 if shared else None)
    assert (below["parameter_bytes"] == 0) == shared
    assert sum(side["parameter_bytes"] for side in info["sides"]) == info["parameter_bytes"]
