"""scripts/velour works from anywhere."""

from __future__ import annotations

import os
import subprocess

from conftest import ROOT, STAGE

LAUNCHER = ROOT / "scripts/velour"


def _run(*arguments, cwd, **env):
    return subprocess.run(
        [LAUNCHER, *map(str, arguments)], cwd=cwd, capture_output=True, text=True, env={**os.environ, **env}
    )


def test_from_another_folder_with_a_decoy(tmp_path, model_file):
    (tmp_path / "velour.py").write_text("raise SystemExit('the wrong velour')")
    done = _run("info", model_file, "--json", cwd=tmp_path, VELOUR_STAGE=str(STAGE))
    assert (done.returncode, done.stderr) == (0, "")


def test_through_a_link(tmp_path, model_file):
    link = tmp_path / "velour"
    link.symlink_to(LAUNCHER)
    done = subprocess.run(
        [link, "info", model_file],
        capture_output=True,
        text=True,
        env={**os.environ, "VELOUR_STAGE": str(STAGE)},
    )
    assert done.returncode == 0, done.stderr


def test_not_built(tmp_path):
    done = _run("info", "x", cwd=tmp_path, VELOUR_STAGE=str(tmp_path))
    assert done.returncode == 1
    assert "scripts/build" in done.stderr
