"""Human-readable numbers of bytes, and shares in per cent."""

from __future__ import annotations

_DECIMAL = ("bytes", "kB", "MB", "GB", "TB")


def data_size(count: float) -> str:
    """Size of files and their contents: powers of 1000, three digits."""
    size, unit = float(count), 0
    while size >= 999.5 and unit + 1 < len(_DECIMAL):
        size, unit = size / 1000, unit + 1
    digits = 0 if unit == 0 or size >= 99.95 else 1 if size >= 9.995 else 2
    return f"{size:,.{digits}f} {_DECIMAL[unit]}"


def limit_size(size: float) -> str:
    """Size of memory: powers of 1024, in which systems and batch queues state their limits."""
    for unit in ("bytes", "KiB", "MiB"):
        if size < 1024:
            return f"{size:.0f} {unit}"
        size /= 1024
    return f"{size:.1f} GiB"


def percent(share: float) -> str:
    """Two digits, without an exponent."""
    value = 100 * share
    return f"{value:.2g} %" if 0.001 <= value < 99.5 else f"{value:.0f} %"
