"""Memory limit that the system or a batch engine sets for this process."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

_NO_LIMIT = 1 << 60  # cgroups v1 reports a value slightly below 2^63 if there is no limit


class Limit(NamedTuple):
    size: int  # bytes
    of: str  # source of the limit, for messages


def memory_limit(environment: Mapping[str, str], root: Path = Path("/")) -> Limit | None:
    """The smallest limit of the process, its cgroups and its Slurm job; None: there is no limit."""
    return min([*_of_process(root), *_of_cgroups(root), *_of_slurm(environment)], default=None)


def _of_process(root: Path) -> Iterator[Limit]:
    """The limit on addresses, without those that are reserved but hold no memory."""
    found = re.search(r"^Max address space +(\d+) ", _text(root / "proc/self/limits"), re.MULTILINE)
    sizes = dict(re.findall(r"^(VmSize|VmRSS):\s+(\d+) kB", _text(root / "proc/self/status"), re.MULTILINE))
    if found and len(sizes) == 2:
        reserved = (int(sizes["VmSize"]) - int(sizes["VmRSS"])) << 10
        yield Limit(max(0, int(found[1]) - reserved), "ulimit -v, less what is reserved")


def _of_cgroups(root: Path) -> Iterator[Limit]:
    for line in _text(root / "proc/self/cgroup").splitlines():
        _, controllers, path = line.split(":", 2)
        if controllers == "":
            yield from _of_folders(root / "sys/fs/cgroup", path, "memory.max")
        elif "memory" in controllers.split(","):
            yield from _of_folders(root / "sys/fs/cgroup/memory", path, "memory.limit_in_bytes")


def _of_folders(mount: Path, path: str, name: str) -> Iterator[Limit]:
    """Limits of a group and its parents, which all apply. In a container `path` may be one of the host's."""
    group = mount / path.lstrip("/")
    for folder in [group, *group.parents]:
        text = _text(folder / name).strip()
        if text.isdigit() and int(text) < _NO_LIMIT:
            yield Limit(int(text), "the cgroup")
        if folder == mount:
            return


def _of_slurm(environment: Mapping[str, str]) -> Iterator[Limit]:
    """Slurm states MiB; 0 means all of the node's memory."""
    node, cpu = (environment.get(f"SLURM_MEM_PER_{per}", "") for per in ("NODE", "CPU"))
    cpus = environment.get("SLURM_CPUS_ON_NODE", "")
    if node.isdigit() and int(node) > 0:
        yield Limit(int(node) << 20, "the Slurm job")
    elif cpu.isdigit() and cpus.isdigit() and int(cpu) > 0:
        yield Limit(int(cpu) * int(cpus) << 20, "the Slurm job")


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except OSError:
        return ""
