#!/usr/bin/env python3
"""A mission that a killed roverd left behind goes on from its place; its runs, its changed
parameters and the reports survive."""

import csv
import datetime
import io
import math
import pathlib
import signal
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
from cuts import examine  # noqa: E402
from station import BIN, ROOT, Program, Rest, Station, check, run_cases, until  # noqa: E402

METRE_LAT = 1 / 111_360.0
SOON = {"valid_for_s": 5}


def ready(rest):
    until("the checks are fine", 60, lambda: rest.get("/vehicle/checks")["ready"], 0.2)


def position(rest):
    return rest.get("/vehicle")["position"]


def mission_ahead(rest, metres):
    here = position(rest)
    heading = math.radians(here["heading_deg"])
    metre_lon = METRE_LAT / math.cos(math.radians(here["lat"]))
    points = [{"type": "waypoint",
               "lat": here["lat"] + m * math.cos(heading) * METRE_LAT,
               "lon": here["lon"] + m * math.sin(heading) * metre_lon} for m in metres]
    return rest.do("POST", "/missions", {"name": "ahead", "items": points})["id"]


def restarted(station):
    """Another roverd on the same data, links and simulator."""
    arguments = list(station.roverd.process.args)
    station.roverd.stop(signal.SIGKILL)
    station.roverd = Program(*arguments)
    station.rest = Rest(station.roverd.wait_line(r"^listening on (http://\S+)")[1])
    return station.rest


def case_resume():
    """A killed roverd's mission goes on where it was, as another run"""
    with Station(seed=3) as station:
        rest = station.rest
        ready(rest)
        rest.do("PUT", "/parameters/nav.speed.max_mps", {"value": 0.9})
        mission = mission_ahead(rest, (3, 6, 9))
        rest.do("POST", "/execution/load", {"mission_id": mission})
        rest.do("POST", "/vehicle/arm", SOON)
        rest.do("POST", "/execution/start", {"mission_id": mission, "revision": 1, **SOON})
        until("it drives to item 2", 60,
              lambda: rest.get("/execution")["current_item"] == 2, 0.1)
        # The place is kept every second: well on the way to item 2 it is kept as that.
        until("and is nearly there", 20,
              lambda: rest.get("/vehicle")["mission"]["distance_to_item_m"] < 0.6, 0.1)
        until("and its run is kept", 10, lambda: rest.get("/runs")["items"], 0.1)
        begin = position(rest)
        rest = restarted(station)
        left = until("it is offered", 20, lambda: rest.get("/execution")["left_behind"], 0.1)
        check(left["mission_id"] == mission and left["item"] >= 2, f"left behind is {left}")
        check(rest.get("/parameters/nav.speed.max_mps")["value"] == 0.9, "a parameter is lost")
        ready(rest)
        status, _, answer = rest.call("POST", "/execution/resume", SOON)
        check(status == 409 and "armed" in answer["detail"], f"unarmed it answers {answer}")
        rest.do("POST", "/vehicle/arm", SOON)
        answer = rest.do("POST", "/execution/resume", SOON)
        check(answer["state"] == "running" and answer["current_item"] >= 2, f"resumed: {answer}")
        until("it finishes", 90, lambda: rest.get("/execution")["state"] == "finished", 0.2)
        end = position(rest)
        far = math.hypot((end["lat"] - begin["lat"]) / METRE_LAT,
                         (end["lon"] - begin["lon"]) / METRE_LAT *
                         math.cos(math.radians(end["lat"])))
        check(2.0 < far < 8.0, f"it drove {far:.1f} m after the restart")
        until("both runs are closed", 10,
              lambda: [r["outcome"] for r in rest.get("/runs")["items"]] ==
              ["finished", "interrupted"], 0.2)
        report = rest.get("/runs/2/report")
        # It had rolled on past the kept place, and went on from there.
        check(report["end_m"] < 0.1 and report["cross_track"]["max_m"] < 0.5, f"the report says {report}")
        track = list(csv.DictReader(io.StringIO(rest.get("/runs/2/track?format=csv").decode())))
        left = [math.hypot((float(p["lat"]) - end["lat"]) / METRE_LAT, (float(p["lon"]) - end["lon"]) /
                           METRE_LAT * math.cos(math.radians(end["lat"]))) for p in track]
        back = max(now - min(left[:i + 1]) for i, now in enumerate(left))
        check(back < 0.3, f"it turned back by {back:.2f} m")
        table = subprocess.run([BIN / "roverd", "report", "--data", station.scratch / "data",
                                "1", "2"], capture_output=True, text=True, check=False)
        check(table.returncode == 0, f"roverd report: {table.stderr}")
        check("cross-track rms" in table.stdout and "interrupted" in table.stdout, table.stdout)


MEASURES = ("time_s", "driving_s", "driven_m", "energy_wh", "laps", "cross_track", "corner_mean_m", "corner_max_m",
            "cut_max_m", "overshoot_max_m", "slalom_max_m", "slalom_mean_m", "heading_rms_deg", "yaw_accel_rms_dps2",
            "jerk_rms_mps3", "end_m", "corners", "straights")


def cut_run(station, seconds):
    """Starts a mission, cuts the power so long after, and looks at what is left of its run."""
    rest = station.rest
    ready(rest)
    mission = mission_ahead(rest, (1, 20, 30, 40))
    rest.do("POST", "/vehicle/arm", SOON)
    rest.do("POST", "/execution/load", {"mission_id": mission})
    rest.do("POST", "/execution/start", {"mission_id": mission, "revision": 1, **SOON})
    until("its run is kept", 10, lambda: rest.get("/runs")["items"] and
          rest.get("/runs")["items"][0]["mission_id"] == mission, 0.1)
    until("it drives", 20, lambda: position(rest)["speed_mps"] > 0.3, 0.1)
    time.sleep(seconds)
    cut_at = time.time()
    station.roverd.stop(signal.SIGKILL)
    examine(station.scratch / "data", station.scratch / "copy", f"cut after {seconds} s")
    rest = restarted(station)
    run = rest.get("/runs")["items"][0]
    check(run["mission_id"] == mission and run["outcome"] == "interrupted", f"the run is {run}")
    track = list(csv.DictReader(io.StringIO(rest.get(f"/runs/{run['id']}/track?format=csv").decode())))
    times = [datetime.datetime.fromisoformat(p["time"].replace("Z", "+00:00")).timestamp() for p in track]
    check(cut_at - times[-1] < 2.0, f"the last {cut_at - times[-1]:.1f} s are lost")
    check(max(b - a for a, b in zip(times, times[1:])) < 1.0, "the track has a hole")
    report = rest.get(f"/runs/{run['id']}/report")
    check(not [m for m in MEASURES if m not in report], f"the report says {report}")
    check(report["driven_m"] > 0.5 and report["cross_track"]["max_m"] < 1.0, f"the report says {report}")
    events = [e["kind"] for e in rest.get(f"/runs/{run['id']}")["events"]]
    check("mission_started" in events, f"its events are {events}")
    rest.do("POST", "/execution/load", {"mission_id": mission})  # what was left behind is given up


def case_run_cut():
    """Power cuts while a run is recorded: it is there up to the last second, and can be judged"""
    with Station(seed=5) as station:
        for seconds in (7.3, 9.1, 6.8):  # past the first item, which is what a report begins with
            cut_run(station, seconds)


def case_report_refusals():
    """roverd report says what is wrong"""
    for arguments, cause in (((), "which runs"), (("x",), "no run's number"),
                             (("--data", "/nowhere", "1"), "there is no database")):
        done = subprocess.run([BIN / "roverd", "report", *arguments], capture_output=True,
                              text=True, cwd=ROOT, check=False)
        check(done.returncode == 2 and cause in done.stderr, f"{arguments}: {done.stderr}")


if __name__ == "__main__":
    sys.exit(run_cases([case_resume, case_run_cut, case_report_refusals]))
