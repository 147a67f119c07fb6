"""What goes wrong in a night: a plan that depends only on the seed, carried out as the frames get done."""

from __future__ import annotations

import random
import time
from collections.abc import Callable
from typing import NamedTuple

from support import slurm

from .site import GOOD, MISSING, OLDER, Site

BLENDER, STEP, POWER, DISK, NO_VELOUR, OLD_VELOUR = KINDS = (
    "Blender killed",
    "slurmstepd killed",
    "node without power",
    "disk full",
    "node without Velour",
    "node with an older Velour",
)
# What the job's failures say of nodes with a wrong Velour.
REFUSALS = {NO_VELOUR: "VELOUR", OLD_VELOUR: "Velour 0.0.9 rendered it"}
_LATEST = 0.85  # share of the frames after which nothing begins: all must happen before the end


class Event(NamedTuple):
    at: float  # share of the frames that are done
    kind: str
    seconds: float = 0.0  # how long it lasts


def plan(seed: int, frames: int, has_disk: bool) -> list[Event]:
    """The events in their order; about one frame in ten meets one."""
    chance = random.Random(seed)
    events = [Event(0, NO_VELOUR, 0.25), Event(0, OLD_VELOUR, 0.4)]  # until so many frames are done
    for kind, count, shortest, longest in (
        (BLENDER, max(2, frames // 15), 0, 0),
        (STEP, max(1, frames // 75), 0, 0),
        (POWER, max(1, frames // 100), 14, 25),
        (DISK, max(1, frames // 150) if has_disk else 0, 8, 15),
    ):
        for _ in range(count):
            events.append(Event(chance.uniform(0.05, _LATEST), kind, chance.uniform(shortest, longest)))
    return sorted(events)


class Trouble:
    """Carries out a plan. Call tick() often, with the share of the frames that are done."""

    def __init__(self, events: list[Event], site: Site, farm: slurm.Slurm, seed: int):
        self._left, self._site, self._slurm = list(events), site, farm
        self._chance = random.Random(seed)
        self._cures: list[tuple[Callable[[float], bool], Callable[[], None]]] = []
        self.happened: list[dict] = []
        self._start = time.monotonic()

    def tick(self, done: float) -> None:
        for cure in [each for each in self._cures if each[0](done)]:
            self._cures.remove(cure)
            cure[1]()
        for event in [each for each in self._left if each.at <= done]:
            if where := self._begin(event):
                self._left.remove(event)
                seconds = time.monotonic() - self._start
                self.happened.append({"seconds": seconds, "kind": event.kind, "where": where, "done": done})
                print(f"{seconds:6.1f} s: {event.kind}: {where}", flush=True)

    def end(self) -> None:
        """Cures everything at once."""
        for _, cure in self._cures:
            cure()
        self._cures.clear()

    def _begin(self, event: Event) -> str:
        """Where it happens; "" while it cannot happen."""
        return {
            BLENDER: lambda _: self._kill("blender"),
            STEP: lambda _: self._kill("slurmstepd"),
            POWER: self._cut_power,
            DISK: self._fill_disk,
            NO_VELOUR: lambda event: self._install(self._site.nodes[2], MISSING, event),
            OLD_VELOUR: lambda event: self._install(self._site.nodes[3], OLDER, event),
        }[event.kind](event)

    def _kill(self, program: str) -> str:
        """Kills a program of a job that runs."""
        running = {node: self._slurm.processes(node).get(program) for node in self._site.nodes}
        candidates = sorted((node, min(found)) for node, found in running.items() if found)
        if not candidates:
            return ""
        node, process = self._chance.choice(candidates)
        slurm.kill(process)
        return node

    def _cut_power(self, event: Event) -> str:
        """Kills a node with all that it runs; it returns later."""
        up = [node for node in self._site.nodes if self._slurm.processes(node)]
        if not up:
            return ""
        node = self._chance.choice(up)
        self._slurm.kill_node(node)
        self._cure_after(event.seconds, lambda: self._slurm.start_node(node))
        return node

    def _fill_disk(self, event: Event) -> str:
        self._site.fill_disk()
        self._cure_after(event.seconds, self._site.empty_disk)
        return "the folder of images"

    def _install(self, node: str, which: str, event: Event) -> str:
        """A wrong Velour, until someone installs the right one."""
        self._site.install(node, which)
        self._cures.append((lambda done: done >= event.seconds, lambda: self._site.install(node, GOOD)))
        return node

    def _cure_after(self, seconds: float, cure: Callable[[], None]) -> None:
        end = time.monotonic() + seconds
        self._cures.append((lambda _: time.monotonic() >= end, cure))
