"""Reports of tests as JUnit has them. No Blender is needed to import this."""

import xml.etree.ElementTree as ElementTree

from . import report


def write(path, files):
    """`files`: lists of report.Test by the name of their file."""
    root = ElementTree.Element("testsuites")
    for name, tests in files.items():
        suite = ElementTree.SubElement(root, "testsuite", name=name)
        for test in tests:
            case = ElementTree.SubElement(suite, "testcase", classname=name, name=test.name)
            case.set("time", f"{test.seconds:.3f}")
            case.set("processor", f"{test.processor:.3f}")
            if test.outcome == report.FAILED:
                ElementTree.SubElement(case, "failure", {"message": test.reason} if test.reason else {})
            elif test.outcome == report.SKIPPED:
                ElementTree.SubElement(case, "skipped", message=test.reason)
    path.parent.mkdir(parents=True, exist_ok=True)
    ElementTree.ElementTree(root).write(path, encoding="utf-8")
