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


def true_tracks_in_the_courses_frame():
    """the tracks of all seeds begin where the course says, beside it by the offset"""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out.json"
        beside = {"disturbances": [{"name": "beside", "start_offset_m": [-1.0, 0.5], "start_heading_off_deg": 20}]}
        done = study(folder, "--json", out, disturbances=beside)
        check(done.returncode == 0, f"exit code {done.returncode}: {done.stderr}{done.stdout}")
        answer = json.loads(out.read_text())
        for run in answer["runs"]:
            _t, east, north, heading, _speed = run["track"][0]
            # The first leg goes north: one metre behind is south, half a metre left is west.
            check(abs(east + 0.5) < 0.02 and abs(north + 1.0) < 0.02, f"begins at {east}, {north}")
            check(abs(heading - 20) < 1, f"looks to {heading}")
            _t, east, north, *_ = run["track"][-1]
            check(abs(east) < 0.3 and abs(north - 5) < 0.3, f"ends at {east}, {north}")
        check(abs(answer["ways"]["short"][-1][1] - 5) < 0.05, f"way {answer['ways']['short'][-1]}")


def what_comes_later():
    """a disturbance that comes on the way: from then on, and not before"""
    later = {"disturbances": [{"name": "late", "later": [{"after_s": 3, "fault": {"estop": True}}]}]}
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out.json"
        done = study(folder, "--json", out, disturbances=later)
        check(done.returncode == 1, f"exit code {done.returncode}: {done.stdout}")
        for run in json.loads(out.read_text())["runs"]:
            check(run["problem"] and 0.5 < run["track"][-1][2] < 4, f"{run['problem']} at {run['track'][-1]}")


def a_plant_of_somebody_else():
    """the example drives the course, and the robot follows it by its own bytes"""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out.json"
        done = study(folder, "--json", out, "--plant", f"{sys.executable} docs/plant_example.py")
        check(done.returncode == 0, f"exit code {done.returncode}: {done.stderr}{done.stdout}")
        answer = json.loads(out.read_text())
        check("plant_example" in answer["plant"], f"plant {answer['plant']}")
        for run in answer["runs"]:
            check(0 < run["truth"]["cross_track"]["rms_m"] < 0.1, f"rms {run['truth']['cross_track']}")
            check(abs(run["track"][-1][2] - 5) < 0.3, f"ends at {run['track'][-1]}")
            # A plant whose receiver is later than roverd assumes, or tells its heading as its course, fails here.
            check(run["honesty"]["inside_pct"] > 85, f"the claims fit: {run['honesty']}")


def plants_that_fail():
    """a plant that dies, or tells nonsense: the run's problem says so"""
    for plant, wanted in (("exit 4", "the plant program ended with exit code 4"),
                          ("read x; echo nothing; cat", "the plant program answered the hello with nothing"),
                          ("for i in $(seq 400); do read -r x; echo \"$x\"; done | python3 docs/plant_example.py",
                           "the plant program ended with exit code 0")):
        with tempfile.TemporaryDirectory() as folder:
            done = study(folder, "--plant", plant)
            check(done.returncode == 1 and wanted in done.stdout, f"{plant}: {done.returncode}, {done.stdout}")


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
    sys.exit(run_cases([drives_and_writes, true_tracks_in_the_courses_frame, what_comes_later,
                        a_plant_of_somebody_else, plants_that_fail,
                        same_whatever_the_threads, names_what_is_wrong, says_what_did_not_arrive]))
