"""scripts/lib/count_tests.py counts cases, and a crash is never a pass."""

from __future__ import annotations

import count_tests
import pytest


def _report(path, *cases):
    inner = "".join(
        f'<testcase name="{name}" status="{status}">{child}</testcase>' for name, status, child in cases
    )
    path.parent.mkdir(exist_ok=True)
    path.write_text(f"<testsuite>{inner}</testsuite>")
    return path


def _counted(capsys, *paths):
    count_tests.main([str(path) for path in paths])
    return capsys.readouterr().out.strip()


@pytest.mark.parametrize(
    ("ctest_child", "inner", "expected"),
    [
        ("", [("a", "run", ""), ("b", "run", "<skipped/>"), ("c", "notrun", "")], "1 0 2"),
        ("<failure/>", [("a", "run", ""), ("b", "run", "<failure/>")], "1 1 0"),
        ("<failure/>", [("a", "run", "")], "0 1 0"),  # died after its report
        ("<failure/>", [], "0 1 0"),  # died before it
    ],
)
def test_counts(tmp_path, capsys, ctest_child, inner, expected):
    ctest = _report(tmp_path / "ctest.xml", ("sphere", "run", ctest_child))
    if inner:
        _report(tmp_path / "native/test_sphere.xml", *inner)
    (tmp_path / "native").mkdir(exist_ok=True)
    assert _counted(capsys, ctest, tmp_path / "native").splitlines()[0] == expected


def test_reasons_are_told(tmp_path, capsys):
    report = _report(tmp_path / "python.xml", ("a", "run", '<skipped message="no test data: nickel"/>'))
    assert _counted(capsys, report).splitlines() == ["0 0 1", "skipped: 1 x no test data: nickel"]


def test_missing_reports_count_nothing(tmp_path, capsys):
    assert _counted(capsys, tmp_path / "none.xml") == "0 0 0"
