"""scripts/setup, scripts/fuzz and the configuration of a build, in a copy of the scripts."""

from __future__ import annotations

import shutil
import subprocess

import pytest
from conftest import ROOT

# What the scripts call before anything is built, without a compiler.
_TOOLS = ("awk", "bash", "basename", "cat", "dirname", "env", "grep", "mkdir", "readlink", "sed", "tail")


@pytest.fixture
def project(tmp_path):
    """A project without a build folder."""
    root = tmp_path / "project"
    (root / "scripts/lib").mkdir(parents=True)
    for name in ("setup", "fuzz", "packages.txt", "lib/common.sh"):
        shutil.copy(ROOT / "scripts" / name, root / "scripts" / name)
    return root


def test_who_has_sudo_can_fuzz_without_clang(project, tmp_path):
    (programs := tmp_path / "programs").mkdir()
    for name in _TOOLS:
        (programs / name).symlink_to(shutil.which(name))
    called = tmp_path / "called.txt"
    for name, line in {
        "id": "echo 1000",
        "dpkg-query": "printf installed",
        "sudo": f'[[ $1 == -v ]] || ( printf "as root: " >>{called}; "$@" )',
        "apt-get": f'echo "${{@:4}}" >>{called}',  # after its general options
    }.items():
        (programs / name).write_text(f"#!/bin/bash\n{line}\n")
        (programs / name).chmod(0o755)
    command, only = [project / "scripts/fuzz"], {"PATH": str(programs)}
    done = subprocess.run(command, env=only, capture_output=True, text=True)
    assert done.returncode == 3, done.stderr  # the installation leaves no clang behind
    assert called.read_text().splitlines() == [
        "as root: update",
        "as root: install --no-install-recommends clang libclang-rt-dev",
    ]


def test_a_moved_project_is_configured_again(project):
    (project / "CMakeLists.txt").write_text("cmake_minimum_required(VERSION 3.25)\nproject(moved NONE)\n")

    def configure(root, *options):
        script = f'. {root}/scripts/lib/common.sh; configure "$root/build" -S "$root" -B "$root/build" "$@"'
        subprocess.run(["bash", "-c", script, "configure", *options], check=True)
        return (root / "build/CMakeCache.txt").read_text()

    assert "kept" in configure(project, "-DOPTION=kept")
    assert "kept" in configure(project)
    moved = project.rename(project.with_name("moved"))
    assert f"CMAKE_HOME_DIRECTORY:INTERNAL={moved}\n" in configure(moved)
