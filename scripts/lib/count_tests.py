"""count_tests.py FILE|FOLDER...: prints "PASSED FAILED SKIPPED" of JUnit reports, then why some were skipped.

A GoogleTest program is one test to ctest. Where its own report (test_NAME.xml) lies in a FOLDER, the cases in
it are counted instead; a program that died before it could report stays one test, failed as ctest saw it.
"""

from __future__ import annotations

import sys
import xml.etree.ElementTree as ElementTree
from collections import Counter
from pathlib import Path


def outcome(case: ElementTree.Element) -> str:
    tags = {child.tag for child in case}
    if tags & {"failure", "error"}:
        return "failed"
    if "skipped" in tags or case.get("status") in ("notrun", "disabled"):
        return "skipped"
    return "passed"


def cases(path: Path) -> list[ElementTree.Element]:
    return list(ElementTree.parse(path).iter("testcase"))


def count(report: Path, details: dict[str, Path]) -> Counter:
    total: Counter = Counter()
    for case in cases(report):
        own = details.get(f"test_{case.get('name')}")
        inner = Counter(map(outcome, cases(own))) if own else Counter()
        # A crash after the report was written, or a time-out, must not pass.
        agrees = inner and (outcome(case) != "failed" or inner["failed"])
        total += inner if agrees else Counter([outcome(case)])
    return total


def reasons(paths: list[Path]) -> Counter:
    """What skipped tests say, and how many say it."""
    found: Counter = Counter()
    for path in paths:
        for report in path.glob("*.xml") if path.is_dir() else [path] if path.is_file() else []:
            for skipped in ElementTree.parse(report).iter("skipped"):
                text = skipped.get("message") or skipped.text or ""
                found[" ".join(text.split()[-12:]) or "without a reason"] += 1
    return found


def main(arguments: list[str]) -> None:
    paths = [Path(a) for a in arguments]
    details = {file.stem: file for folder in paths if folder.is_dir() for file in folder.glob("*.xml")}
    total: Counter = Counter()
    for path in paths:
        if path.is_file():
            total += count(path, details)
    print(total["passed"], total["failed"], total["skipped"])
    for reason, number in sorted(reasons(paths).items()):
        print(f"skipped: {number} x {reason}")


if __name__ == "__main__":
    main(sys.argv[1:])
