"""The library exports what velour.h declares, and nothing else.

usage: exports_test.py LIBRARY HEADER
"""

import re
import subprocess
import sys


def exported(library: str) -> set[str]:
    command = ["nm", "-D", "--defined-only", library]
    lines = subprocess.run(command, capture_output=True, text=True, check=True)
    return {line.split()[-1].split("@")[0] for line in lines.stdout.splitlines() if line.strip()}


def declared(header: str) -> set[str]:
    with open(header, encoding="utf-8") as f:
        return set(re.findall(r"VLR_API\s[^;(]*?\b(vlr_\w+)\(", f.read()))


def main() -> int:
    library, header = sys.argv[1:]
    have, want = exported(library), declared(header)
    if len(want) < 40:
        print(f"only {len(want)} declarations found in {header}: the pattern no longer fits the header")
        return 1
    for name in sorted(have - want):
        print(f"exported but not declared: {name}")
    for name in sorted(want - have):
        print(f"declared but not exported: {name}")
    return 1 if have != want else 0


if __name__ == "__main__":
    sys.exit(main())
