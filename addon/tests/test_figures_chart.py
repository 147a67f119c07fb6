"""scripts/figures and scripts/chart --btf on the test data: what made-up data does not show."""

from __future__ import annotations

import csv
import os
import signal
import subprocess

import pytest
from campaigns import only_kept, run_script, script_command, script_environment
from command_line import hear_ctrl_c

pytestmark = pytest.mark.long


def test_a_run_that_is_stopped_leaves_whole_files_and_goes_on(data_folder, tmp_path):
    # A group of its own: Ctrl-C reaches the script and the render.
    process = subprocess.Popen(
        script_command("figures", tmp_path),
        env=script_environment(data_folder),
        stdout=subprocess.PIPE,
        text=True,
        start_new_session=True,
        preexec_fn=hear_ctrl_c,
    )
    for line in process.stdout:
        if "32 spp" in line:
            break
    os.killpg(process.pid, signal.SIGINT)
    process.communicate(timeout=300)
    assert process.returncode == 130
    done = {path.stem for path in (tmp_path / "kept").glob("render-*.json")}
    assert done
    assert all((tmp_path / f"kept/{stem}.exr").is_file() for stem in done)
    assert not list((tmp_path / "kept").glob(".*"))
    assert run_script("figures", tmp_path, data=data_folder).returncode == 0
    for number in ("7.11", "7.12"):
        assert (tmp_path / f"reference-{number}-standard-error.exr").is_file()


def test_ways_to_compress_are_compared_at_equal_bytes(data_folder, tmp_path):
    done = run_script("btf_chart", tmp_path, "--methods=svd,svd-view", data=data_folder)
    assert done.returncode == 0, done.stdout + done.stderr
    with open(tmp_path / "out/chart_btf.csv", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["tile"] == "weave"]
    assert {row["method"] for row in rows} == {"svd", "svd-view"}
    for row in rows:
        assert int(row["bytes"]) * int(row["ratio"]) <= 1.01 * 12 * 12 * 37 * 37 * 6
        assert 0 < float(row["picture"]) < 1
        assert 5 < float(row["psnr_unseen"]) < 60
    assert any(float(row["render_seconds"] or 0) > 0 for row in rows)
    assert only_kept(run_script("btf_chart", tmp_path, "--methods=svd,svd-view", data=data_folder).stdout)
