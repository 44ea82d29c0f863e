# SPDX-License-Identifier: MIT
"""Run every test suite of a build folder and add up the single tests.

Usage: run_suites.py BUILD_DIR [-j N] [--tier fast|check|nightly]. The suites are those ctest knows, of the tier `fast`
those with that label. The seconds told are of the processor, of a suite with all that it starts. Each has to close with
`N passed, M failed` (tests/conftest.py says so for pytest) or with pFUnit's summary; one that does not, because it
crashed, stopped or hung, is run again test by test where it lists its tests, so that every test is counted and the
culprit is named.
"""
import argparse
import concurrent.futures
import json
import os
import re
import subprocess
import sys
import tempfile
import threading

CLOSING = re.compile(r"^(\d+) passed, (\d+) failed(, \d+ skipped)?$")   # skipped: nothing else was there
PFUNIT_OK = re.compile(r"^ ?OK\s*$\s*\((\d+) tests?", re.MULTILINE)
PFUNIT_BAD = re.compile(r"^Tests run: (\d+), Failures: (\d+), Errors: (\d+)", re.MULTILINE)
TIMEOUT = 900  # s; a suite takes seconds, the heaviest in the debug build minutes


def suites_of(build, tier):
    """Name, command, environment and folder of each; those that take long come first, so that none is left over."""
    answer = subprocess.run(["ctest", "--show-only=json-v1"], cwd=build, check=True, capture_output=True, text=True)
    suites = [(test, {p["name"]: p["value"] for p in test.get("properties", [])})
              for test in json.loads(answer.stdout)["tests"]]
    for test, properties in sorted(suites, key=lambda suite: "fast" in suite[1].get("LABELS", [])):
        if tier == "fast" and "fast" not in properties.get("LABELS", []):
            continue
        environment = dict(os.environ, MUD_TIER=tier, **dict(e.split("=", 1) for e in properties.get("ENVIRONMENT", [])))
        yield test["name"], test.get("command"), environment, properties.get("WORKING_DIRECTORY", build)


def run(command, environment, folder):
    """Exit code (None: hung), everything that was written, and seconds of the processor."""
    with tempfile.TemporaryFile() as output:
        try:
            child = subprocess.Popen(command, env=environment, cwd=folder, stdin=subprocess.DEVNULL, stdout=output,
                                     stderr=subprocess.STDOUT)
        except OSError as problem:
            return -1, str(problem), 0.0
        late = threading.Timer(TIMEOUT, child.kill)
        late.start()
        _, status, used = os.wait4(child.pid, 0)
        hung = not late.is_alive()
        late.cancel()
        child.returncode = os.waitstatus_to_exitcode(status)   # it is waited for: Popen must not do it again
        output.seek(0)
        text = output.read().decode(errors="replace")
    return None if hung else child.returncode, text, used.ru_utime + used.ru_stime


def counts(code, output):
    """(passed, failed), or None if the suite did not come to its end or contradicts itself."""
    # The library may say at the end of a process, on standard error, what it has refused.
    lines = [line for line in output.rstrip().splitlines() if not line.startswith("MUD: ")]
    found = CLOSING.match(lines[-1]) if lines else None
    if found:
        passed, failed = int(found[1]), int(found[2])
    elif bad := PFUNIT_BAD.search(output):
        failed = int(bad[2]) + int(bad[3])
        passed = int(bad[1]) - failed
    elif ok := PFUNIT_OK.search(output):
        passed, failed = int(ok[1]), 0
    else:
        return None
    if (code == 0) != (failed == 0) or passed + failed == 0 and not (found and found[3]):
        return None
    return passed, failed


def one_by_one(command, environment, folder):
    """Passed, failed and messages of a crashed suite whose tests can be listed and run alone."""
    code, listed, _ = run([*command, "--list"], environment, folder)
    names = listed.split()
    if code != 0 or not names or not all(re.fullmatch(r"\w+", name) for name in names):
        return 0, 1, []
    passed, messages = 0, []
    for name in names:
        code, output, _ = run([*command, name], environment, folder)
        if counts(code, output) == (1, 0):
            passed += 1
        else:
            messages.append(f"FAILED {name} (run alone, exit code {code}):\n{output.rstrip()}")
    if not messages:
        messages = ["FAILED only when all tests run in one process; counted as one more failure"]
    return passed, len(messages), messages


def run_suite(suite):
    name, command, environment, folder = suite
    if not command:
        return name, 0, 1, "the program was not built", 0.0
    code, output, seconds = run(command, environment, folder)
    result = counts(code, output)
    if result:
        passed, failed = result
    else:
        how = f"hung (stopped after {TIMEOUT} s)" if code is None else f"ended with exit code {code}"
        output += f"\nFAILED {name} {how} without a valid closing line"
        passed, failed, messages = (0, 1, []) if code is None else one_by_one(command, environment, folder)
        output += "".join("\n" + message for message in messages)
    return name, passed, failed, output, seconds


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    arguments.add_argument("build")
    arguments.add_argument("-j", type=int, default=os.cpu_count(), help="suites run at the same time")
    arguments.add_argument("--tier", choices=("fast", "check", "nightly"), default="check",
                           help="fast: a minute; check: every suite; nightly: every suite at full length")
    arguments = arguments.parse_args()
    build = os.path.abspath(arguments.build)
    suites = list(suites_of(build, arguments.tier))
    passed = failed = 0
    total = 0.0
    with concurrent.futures.ThreadPoolExecutor(arguments.j) as pool:
        for name, good, bad, output, seconds in pool.map(run_suite, suites):
            if bad:
                # The line with the counts is ours to write, once and last.
                print("\n".join(line for line in output.splitlines() if line.strip() and not CLOSING.match(line)))
            print(f"  {name}: {good} passed, {bad} failed, {seconds:.1f} s", flush=True)
            passed, failed, total = passed + good, failed + bad, total + seconds
    print(f"  {len(suites)} suites: {total:.0f} s of the processor")
    if not suites:
        print("FAILED there are no test suites in this build")
        failed = 1
    print(f"{passed} passed, {failed} failed")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
