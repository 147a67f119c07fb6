"""Test cases from the reports of ctest, GoogleTest, pytest and blend-tests/run."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

PASSED, FAILED, SKIPPED = "passed", "failed", "skipped"


class Case(NamedTuple):
    name: str
    outcome: str  # PASSED, FAILED or SKIPPED
    seconds: float = 0.0
    reason: str = ""  # why it was skipped

    @property
    def file(self) -> str:
        """The file of a test of Python or Blender, or the suite of a native one."""
        parts = self.name.split(".")
        return ".".join(parts[:3]) if parts[0] == "addon" else parts[0]

    @classmethod
    def of(cls, element: ElementTree.Element) -> Case:
        name = ".".join(filter(None, (element.get("classname"), element.get("name"))))
        return cls(name, _outcome(element), float(element.get("time", 0)), _reason(element))


def _outcome(element: ElementTree.Element) -> str:
    tags = {child.tag for child in element}
    if tags & {"failure", "error"}:
        return FAILED
    if "skipped" in tags or element.get("status") in ("notrun", "disabled"):
        return SKIPPED
    return PASSED


def _reason(element: ElementTree.Element) -> str:
    skipped = element.find("skipped")
    if skipped is None:
        return ""
    text = skipped.get("message") or skipped.text or ""
    return " ".join(text.split()[-12:]) or "without a reason"


def of_report(path: Path) -> list[Case]:
    """The cases of a JUnit report; empty if it is missing or incomplete."""
    try:
        return [Case.of(element) for element in ElementTree.parse(path).iter("testcase")]
    except (OSError, ElementTree.ParseError):
        return []


def of_ctest(path: Path, programs: Path) -> list[Case]:
    """The cases of ctest's report.

    To ctest, a GoogleTest program is one test. It is replaced by the cases of its own report, test_NAME.xml
    in the folder `programs`, if that agrees with ctest. A crash or a timeout remains a failure.
    """
    found = []
    for case in of_report(path):
        inner = of_report(programs / f"test_{case.name.rpartition('.')[2]}.xml")
        agrees = inner and (case.outcome != FAILED or any(one.outcome == FAILED for one in inner))
        found += inner if agrees else [case]
    return found


def count(cases: Iterable[Case]) -> Counter:
    return Counter(case.outcome for case in cases)


def reasons(cases: Iterable[Case]) -> list[str]:
    """A line for each reason why tests were skipped."""
    found = Counter(case.reason for case in cases if case.outcome == SKIPPED)
    return [f"skipped: {number} x {reason}" for reason, number in sorted(found.items())]


def slowest(cases: Iterable[Case], number: int) -> list[Case]:
    return sorted(cases, key=lambda case: case.seconds, reverse=True)[:number]


def by_file(cases: Iterable[Case], number: int) -> list[tuple[str, int, float]]:
    """Files with their numbers of tests and seconds, the slowest first."""
    seconds, tests = Counter(), Counter()
    for case in cases:
        seconds[case.file] += case.seconds
        tests[case.file] += 1
    return [(file, tests[file], its) for file, its in seconds.most_common(number)]
