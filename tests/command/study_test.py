#!/usr/bin/env python3
"""roverd study: the table, the files it writes, and what it refuses."""

import json
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
from station import BIN, ROOT, check, run_cases  # noqa: E402

SHORT = {"courses": [{"name": "short", "points": [[0, 0], [0, 5]]}]}
CALM = {"disturbances": [{"name": "as shipped"}]}


def study(folder, *arguments, courses=None, disturbances=None):
    """Runs it in the repository, on files of this folder."""
    names = []
    for name, content in (("courses", courses or SHORT), ("disturbances", disturbances or CALM)):
        path = pathlib.Path(folder) / f"{name}.json"
        path.write_text(content if isinstance(content, str) else json.dumps(content))
        names += [f"--{name}", str(path)]
    return subprocess.run([BIN / "roverd", "study", "--seeds", "2", *names, *map(str, arguments)],
                          capture_output=True, text=True, timeout=120, check=False, cwd=ROOT)


def drives_and_writes():
    """a table, a JSON file with every run, a plot that is XML"""
    with tempfile.TemporaryDirectory() as folder:
        out, plots = pathlib.Path(folder) / "out.json", pathlib.Path(folder) / "plots"
        done = study(folder, "--json", out, "--svg", plots, "--jobs", 2)
        check(done.returncode == 0, f"exit code {done.returncode}: {done.stderr}")
        check("short / as shipped" in done.stdout and "0 of 2" in done.stdout, done.stdout)
        runs = json.loads(out.read_text())["runs"]
        check([r["seed"] for r in runs] == [1, 2], f"seeds {[r['seed'] for r in runs]}")
        check(all(0 < r["truth"]["cross_track"]["rms_m"] < 0.1 for r in runs), "no sensible error")
        picture = xml.etree.ElementTree.parse(plots / "short-as_shipped.svg").getroot()
        check(picture.tag.endswith("svg"), picture.tag)


def same_whatever_the_threads():
    """one thread or two: the same figures"""
    with tempfile.TemporaryDirectory() as folder:
        tables = [study(folder, "--jobs", jobs).stdout for jobs in (1, 2)]
        check(tables[0] == tables[1] and tables[0], "the number of threads changes the result")


def refuses(what, wanted, **files):
    with tempfile.TemporaryDirectory() as folder:
        done = study(folder, *what, **files)
        check(done.returncode == 2, f"exit code {done.returncode} for {wanted}")
        check(wanted in done.stderr, f"says {done.stderr!r}, not {wanted!r}")


def names_what_is_wrong():
    """files, members, keys, vehicles and options"""
    refuses([], "/courses/0/speed_mps must be from",
            courses={"courses": [{"name": "a", "points": [[0, 0], [1, 0]], "speed_mps": -1}]})
    refuses([], "unknown key drive.slipp", disturbances={"disturbances": [{"name": "a", "sim": {"drive.slipp": 1}}]})
    refuses([], "unknown key nav.track.nothing",
            disturbances={"disturbances": [{"name": "a", "robot": {"nav.track.nothing": 1}}]})
    refuses([], "byte", courses="{")
    refuses(["--vehicle", "tank"], 'unknown vehicle "tank"')
    refuses(["--set", "nav.track.law=zigzag"], "path_frame, pure_pursuit or stanley")
    refuses(["--seeds", "0"], "--seeds")
    refuses(["--courses", "/nowhere.json"], "--courses")


def says_what_did_not_arrive():
    """a robot that is stopped on its way: exit code 1 and the reason"""
    with tempfile.TemporaryDirectory() as folder:
        done = study(folder, disturbances={"disturbances": [{"name": "stuck", "sim": {"drive.max_linear_mps": 0.1}}]})
        check(done.returncode == 1, f"exit code {done.returncode}: {done.stdout}")
        check("2 of 2" in done.stdout and "seed 1:" in done.stdout, done.stdout)


if __name__ == "__main__":
    sys.exit(run_cases([drives_and_writes, same_whatever_the_threads, names_what_is_wrong,
                        says_what_did_not_arrive]))
