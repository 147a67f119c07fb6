"""A night on the farm: submits a shot again and again, as a user would, until all frames are done."""

from __future__ import annotations

import re
import time
from pathlib import Path

from support import slurm
from velour.native import images

from .pictures import digest, rendered_seconds
from .site import Site, farm
from .trouble import Trouble, plan

NODES = ["node1", "node2", "node3", "node4"]
THREADS = 1  # of a task: a node has one processor
ROUNDS = 25  # submissions at most
_PATIENCE = 10  # seconds until Slurm takes a node for down
_FRAME_SECONDS = 30  # of waiting a frame, at most, before a job counts as one that waits for ever
_TURN = 0.2
_RETRY = 2.0  # seconds before a refused submission is tried again
_MIB = 64  # of the disk beside the images
_FRAME_MIB = 0.15
_MEMORY = "900M"


def work(blend: Path, frames: int, folder: Path, stage: Path, seed: int) -> dict:
    """The report of the night: what happened, what was submitted, and what the images are."""
    site = Site(folder, stage, NODES, int(_MIB + frames * _FRAME_MIB))
    try:
        farm_of_nodes = slurm.Slurm(NODES, processors=1, patience=_PATIENCE)
        try:
            return _Shift(blend, frames, site, farm_of_nodes, seed).work()
        finally:
            farm_of_nodes.stop()
    finally:
        site.close()


class _Shift:
    def __init__(self, blend: Path, frames: int, site: Site, nodes: slurm.Slurm, seed: int):
        self._blend, self._frames, self._site, self._slurm = blend, frames, site, nodes
        self._plan = plan(seed, frames, site.has_disk)
        self._trouble = Trouble(self._plan, site, nodes, seed)
        self._submissions: list[dict] = []

    def work(self) -> dict:
        start, waits = time.monotonic(), ""
        self._trouble.tick(0)  # wrong nodes are wrong from the first task on
        while not (done := self._is_done()) and len(self._submissions) < ROUNDS and not waits:
            self._submit(time.monotonic() - start)
            waits = self._wait()
        seconds = time.monotonic() - start
        self._trouble.end()
        return {
            "done": done,
            "status": self._status()[1][-1],
            "seconds": seconds,
            "waits": waits,
            "planned": len(self._plan),
            "has_disk": self._site.has_disk,
            "events": self._trouble.happened,
            "submissions": self._submissions,
            **self._found(),
        }

    def _is_done(self) -> bool:
        return bool(self._submissions) and self._status()[0] == 0

    def _status(self) -> tuple[int, list[str]]:
        """Exit status and lines of --status."""
        said = farm(self._site, self._slurm.environment, "--status", self._site.output)
        return said.returncode, said.stdout.splitlines() or [""]

    def _submit(self, seconds: float) -> None:
        output = ("--output", self._site.output, "--format", "OPEN_EXR_MULTILAYER")
        options = ("--threads", THREADS, "--memory", _MEMORY)
        failed = [line for line in self._status()[1] if " failed: " in line]
        said = farm(self._site, self._slurm.environment, self._blend, *output, *options)
        last = said.stdout.splitlines()[-1] if said.stdout else ""
        found = {"seconds": seconds, "failed": failed, "status": said.returncode, "said": last}
        self._submissions.append(found)
        print(
            f"{seconds:6.1f} s: submission {len(self._submissions)}, {len(failed)} failed: {last}", flush=True
        )

    def _wait(self) -> str:
        """Waits until Slurm has nothing to do. Returns what it still has after too long a time."""
        end = time.monotonic() + 120 + self._frames * _FRAME_SECONDS
        calm = time.monotonic() + _RETRY
        while (queue := self._slurm.run("squeue", "-h", "-o", "%i %T %r")).strip() or time.monotonic() < calm:
            self._trouble.tick(self._share())
            if time.monotonic() > end:
                self._slurm.run("scancel", "--user", "root")
                return queue.strip()
            time.sleep(_TURN)
        return ""

    def _share(self) -> float:
        return len(list(self._site.output.glob("*.exr"))) / self._frames

    def _found(self) -> dict:
        """The frames, and other files beside them that should not be there."""
        output, frames = self._site.output, {}
        for path in sorted(output.glob("*.exr")):
            number = int(re.search(r"_(\d+)\.exr$", path.name)[1])
            log = output / f"farm/logs/{number:04d}.log"
            frames[number] = {
                "name": path.name,
                "says": int(images.header(path)["texts"]["Frame"]),
                "digest": digest(path),
                "seconds": rendered_seconds(path),
                "warnings": log.read_text(errors="replace").count("\nVelour: "),
            }
        return {"frames": frames, "leftovers": leftovers(output)}


def leftovers(output: Path) -> list[str]:
    """Files that only an unfinished frame may have: parts, failures, temporary files, half an image."""
    farm_folder = output / "farm"
    found = [path for name in ("partial", "failed") for path in (farm_folder / name).rglob("*")]
    found += [path for path in output.rglob(".*") if path not in found]
    found += [path for path in output.iterdir() if path != farm_folder and path.suffix != ".exr"]
    return sorted({str(path.relative_to(output)) for path in found})
