"""Nodes of a farm on this machine: a shared folder of limited size, and for each node a Velour of its own."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

from ..project import ROOT

GOOD, MISSING, OLDER = "good", "missing", "older"
_STAMP = 'result.stamp_data_add_field("velour.version", version_text())'
_BALLAST = ".ballast"
_OURS = ("PYTHONPATH", "PYTHONSAFEPATH", "BLENDER_USER_SCRIPTS")
_STARTER = """\
#!/bin/sh
# Each node has a Velour of its own; nodes cannot differ otherwise, as they share this machine.
BLENDER_USER_SCRIPTS="{folder}/${{SLURMD_NODENAME:-{good}}}" PATH="{programs}:$PATH" exec "{blender}" "$@"
"""


class Site:
    """`blender`: starts the Blender of the node that runs it. `output`: the images, on a small disk."""

    def __init__(self, folder: Path, stage: Path, nodes: list[str], mib: int):
        self.folder, self.nodes = folder, nodes
        self.output, self.blender = folder / "frames", folder / "blender"
        _unmount(self.output)
        shutil.rmtree(folder, ignore_errors=True)
        self.output.mkdir(parents=True)
        self.has_disk = _mount(self.output, mib)
        (folder / GOOD).symlink_to(stage.resolve())
        (folder / MISSING).mkdir()
        _make_older(stage, folder / OLDER)
        self._write_starter()
        for node in nodes:
            self.install(node, GOOD)

    def _write_starter(self) -> None:
        found = Path(shutil.which("blender") or "blender")
        text = _STARTER.format(folder=self.folder, good=GOOD, programs=found.parent, blender=found)
        self.blender.write_text(text)
        self.blender.chmod(0o755)

    def install(self, node: str, which: str) -> None:
        """Gives a node this Velour, from its next Blender on."""
        link = self.folder / f".{node}"
        link.symlink_to(which)
        os.replace(link, self.folder / node)

    def fill_disk(self) -> None:
        """Until empty_disk(), nobody can write to the folder of images."""
        with open(self.output / _BALLAST, "wb") as file:
            try:
                while True:
                    file.write(bytes(1 << 16))
                    file.flush()
            except OSError:
                pass

    def empty_disk(self) -> None:
        (self.output / _BALLAST).unlink()

    def close(self) -> None:
        _unmount(self.output)


def _make_older(stage: Path, folder: Path) -> None:
    """A copy of the add-on that writes an older version into its images."""
    shutil.copytree(stage, folder)
    path = folder / "addons/velour/engine/stamps.py"
    text = path.read_text(encoding="utf-8")
    if _STAMP not in text:
        raise RuntimeError(f"{path} no longer stamps the version as scripts/night expects it.")
    path.write_text(text.replace(_STAMP, _STAMP.replace("version_text()", '"0.0.9"')), encoding="utf-8")


def _mount(folder: Path, mib: int) -> bool:
    """Whether the folder is now a disk of this size."""
    command = ["mount", "-t", "tmpfs", "-o", f"size={mib}m", "tmpfs", folder]
    return subprocess.run(command, stderr=subprocess.DEVNULL).returncode == 0


def _unmount(folder: Path) -> None:
    if folder.is_mount():
        subprocess.run(["umount", "-l", folder], check=True)


def of_user() -> dict[str, str]:
    """The environment of a user's shell: the path of scripts/bench would give all nodes the same Velour."""
    return {name: value for name, value in os.environ.items() if name not in _OURS}


def farm(site: Site, environment: dict[str, str], *arguments) -> subprocess.CompletedProcess:
    """Runs scripts/farm as a user would; both outputs as one text."""
    command = [ROOT / "scripts/farm", "--blender", site.blender, *arguments]
    return subprocess.run(
        [str(part) for part in command],
        env={**of_user(), **environment},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
