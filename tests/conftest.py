# SPDX-License-Identifier: MIT
"""The suites of Python under pytest. A test is a function; its checks are counted one by one, and it fails if one of
them does. The last line is the one that scripts/run_suites.py adds up."""
import pathlib
import sys

import pytest

sys.path.insert(0, str(pathlib.Path(__file__).parent / "support"))
import checking  # noqa: E402

skipped = []


def pytest_collectstart(collector):
    """Before a module is imported."""
    if isinstance(collector, pytest.Module):
        checking.work = checking.new_folder()


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item):
    checking.failures.clear()
    # Of the module that runs: all of them are imported by now.
    checking.work = getattr(item.module, "work", checking.work)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item):
    """A test without checks counts as one; one that breaks off counts as a failed check."""
    before = sum(checking.counts.values())
    try:
        yield
    except BaseException:
        checking.counts[False] += 1
        raise
    if checking.failures:
        pytest.fail("\n".join(checking.failures), pytrace=False)
    if sum(checking.counts.values()) == before:
        checking.counts[True] += 1


def pytest_runtest_logreport(report):
    if report.when == "setup" and report.failed:
        checking.counts[False] += 1
    if report.skipped:
        skipped.append(report.nodeid)


def pytest_collectreport(report):
    """A module that cannot be imported is a failure, one that skips itself is not."""
    if report.failed:
        checking.counts[False] += 1
    if report.skipped:
        skipped.append(report.nodeid)


def pytest_sessionfinish(session, exitstatus):
    if exitstatus == pytest.ExitCode.NO_TESTS_COLLECTED and skipped:
        session.exitstatus = pytest.ExitCode.OK


def pytest_unconfigure():
    if skipped and not any(checking.counts.values()):
        print(f"0 passed, 0 failed, {len(skipped)} skipped")
    else:
        print(f"{checking.counts[True]} passed, {checking.counts[False]} failed")
