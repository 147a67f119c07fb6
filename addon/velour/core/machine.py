"""Describes the machine of a benchmark, without which its numbers mean little."""

from __future__ import annotations

import os
import platform
import re
from pathlib import Path


def machine() -> str:
    """Processor, threads that this process may use, memory, operating system."""
    return f"{_processor()}, {threads()} threads, {_memory_gib():.0f} GiB, {_system()}"


def threads() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _processor() -> str:
    found = re.search(r"model name\s*:\s*(.+)", _text("/proc/cpuinfo"))
    return " ".join(found[1].split()) if found else platform.processor() or platform.machine()


def _memory_gib() -> float:
    found = re.search(r"MemTotal:\s*(\d+) kB", _text("/proc/meminfo"))
    return int(found[1]) / 2**20 if found else 0.0


def _system() -> str:
    found = re.search(r'^PRETTY_NAME="(.+)"', _text("/etc/os-release"), flags=re.MULTILINE)
    return found[1] if found else platform.platform()


def _text(path: str) -> str:
    try:
        return Path(path).read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""
