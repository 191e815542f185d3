#!/usr/bin/env python3
"""POST /safety/drill: failures are played by a program of its own, and the live robot has no part."""

import json
import math
import os
import pathlib
import shutil
import signal
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
from station import BIN, Program, Rest, Station, check, run_cases, until  # noqa: E402

METRE_LAT = 1 / 111_360.0
DRILL = "/safety/drill"


def ready(rest):
    until("there is a position", 60, lambda: (rest.get("/vehicle")["position"] or {}).get("lat"), 0.2)


def place(rest, north_m, east_m=0.0, here=None):
    here = here or rest.get("/vehicle")["position"]
    metre_lon = METRE_LAT / math.cos(math.radians(here["lat"]))
    return {"lat": here["lat"] + north_m * METRE_LAT, "lon": here["lon"] + east_m * metre_lon}


def mission_of(rest, points, name="drill"):
    items = [{"type": "waypoint", **point} for point in points]
    return rest.do("POST", "/missions",
                   {"name": name, "items": items, "settings": {"speed_mps": 1.0}})["id"]


def load_way(rest, metres=60):
    """North for so many metres, then 20 m east."""
    ready(rest)
    points = [place(rest, 2), place(rest, metres), place(rest, metres, 20)]
    mission = mission_of(rest, points)
    rest.do("POST", "/execution/load", {"mission_id": mission})
    return mission


def ended(rest, seconds=120):
    def state():
        drill = rest.get(DRILL)
        return drill if drill["state"] != "running" else None
    return until("the drill ends", seconds, state, 0.1)


def result_of(drill, failure):
    return next(r for r in drill["results"] if r["failure"] == failure)


def children(station):
    """Of roverd: the numbers of the studies that it started."""
    pid = station.roverd.process.pid
    out = []
    for entry in pathlib.Path("/proc").iterdir():
        if not entry.name.isdigit():
            continue
        try:
            stat = (entry / "stat").read_text().rsplit(")", 1)[1].split()
            if int(stat[1]) == pid and "roverd-study" in (entry / "cmdline").read_text():
                out.append((int(entry.name), stat[0]))
        except OSError:
            continue
    return [number for number, state in out if state != "Z"]


def metres_between(a, b):
    north = (a["lat"] - b["lat"]) / METRE_LAT
    east = (a["lon"] - b["lon"]) / METRE_LAT * math.cos(math.radians(a["lat"]))
    return math.hypot(north, east)


def plays_all_and_moves_nothing():
    """every failure within its limits, by the parameters as they are now, and a robot that stands"""
    with Station(seed=2) as station:
        rest = station.rest
        check(rest.get(DRILL)["state"] == "none", "there is a drill before the first")
        load_way(rest)
        fence = {"name": "field", "areas": [{"kind": "inclusion", "polygon": [
            place(rest, -6, -6), place(rest, -6, 26), place(rest, 66, 26), place(rest, 66, -6)]}]}
        chosen = rest.do("POST", "/fences", fence)["id"]
        rest.do("PUT", "/fence", {"fence_id": chosen})
        # Given a parameter that was changed while the program runs
        rest.do("PUT", "/parameters/robot.safety.gnss_free_m", {"value": 7.0})
        before, truth = rest.get("/vehicle"), station.control.ask({"get": "truth"})
        # When all failures are played
        status, headers, begun = rest.call("POST", DRILL, {})
        check(status == 202 and begun["state"] == "running", f"{status} {begun}")
        check(headers["Location"] == "/api/v1" + DRILL, f"Location {headers['Location']}")
        status, _, again = rest.call("POST", DRILL, {})
        check(status == 409 and "drill is running" in again["detail"], f"a second one: {status}")
        drill = ended(rest)
        # Then each that there is has a result
        check(drill["state"] == "done", f"{drill['state']}: {drill['detail']}")
        played = [r["failure"] for r in drill["results"]]
        check(played == drill["begins"]["failures"], f"{played}")
        check({"drive_link", "gnss_outage", "estop_page", "program_killed"} <= set(played), played)
        check("bumper" not in played, "a Bunker has no bumper")
        check(abs(drill["begins"]["at_m"] - drill["begins"]["length_m"] / 2) < 0.01, "not the middle")
        check(drill["fence_id"] == chosen, f"fence {drill['fence_id']}")
        # and the robot stands within what docs/stopping.md says of 1 m/s
        for failure, zero_s, way_m in (("estop_page", 0.04, 0.8), ("estop_button", 0.16, 0.8),
                                       ("drive_link", 0.46, 1.33), ("commands_lost", 1.8, 1.33),
                                       ("feedback_lost", 0.46, 1.33), ("radio_frozen", 0.6, 1.33),
                                       ("second_commander", 0.1, 0.8)):
            r = result_of(drill, failure)
            check(r["end"] == "stands", f"{failure}: {r['end']} {r['reason']}")
            check(abs(r["speed_mps"] - 1.0) < 0.1, f"{failure} at {r['speed_mps']} m/s")
            check(r["zero_s"] <= zero_s, f"{failure}: zero after {r['zero_s']} s")
            check(0.05 < r["way_m"] <= way_m, f"{failure}: {r['way_m']} m")
            check(r["stands_s"] <= 2.0, f"{failure}: stands after {r['stands_s']} s")
            check(r["inside_fence"] and 4 < r["fence_distance_m"] < 6, f"{r['fence_distance_m']}")
            check(r["off_way_m"] < 0.3, f"{failure}: {r['off_way_m']} m off the way")
            check(abs(metres_between(r["begins"], r["last"]) - r["way_m"]) < 0.1, f"{failure}")
        check(result_of(drill, "drive_link")["mode"] == "HOLD", "not in HOLD")
        check("base_lost" in [c["id"] for c in result_of(drill, "drive_link")["said"]], "base_lost")
        check(result_of(drill, "program_killed")["mode"] is None, "a dead program has a mode")
        on = result_of(drill, "operator_lost")
        check(on["end"] in ("finished", "goes_on") and "link_lost is go_on" in on["reason"], on)
        # and the changed parameter was obeyed: the file says 35 m
        free = result_of(drill, "gnss_outage")
        check(free["end"] == "stands" and 6 < free["way_m"] < 9, f"gnss_outage: {free['way_m']} m")
        # and nothing of the live robot has changed, and no command went to its base
        after, now = rest.get("/vehicle"), station.control.ask({"get": "truth"})
        for name in ("mode", "armed", "estop", "control", "home"):
            check(before[name] == after[name], f"{name}: {before[name]} became {after[name]}")
        check(not after["armed"] and after["mission"]["state"] == "loaded", "it is not as it was")
        check(now["driven_m"] == truth["driven_m"], f"it drove {now['driven_m']} m")
        check(now["commands"] == truth["commands"], "motion was commanded")


def named_missions_and_places():
    """a mission that is not loaded, a place on it, a few failures, in the order of the list"""
    with Station(seed=3) as station:
        rest = station.rest
        ready(rest)
        status, _, none = rest.call("POST", DRILL, {})
        check(status == 409 and "no mission is loaded" in none["detail"], f"{status} {none}")
        mission = mission_of(rest, [place(rest, 0), place(rest, 0, 50)])
        rest.do("POST", DRILL, {"mission_id": mission, "at_m": 12.5, "limit_s": 20,
                                "failures": ["drive_link", "imu_silent", "bumper"]})
        drill = ended(rest)
        check(drill["state"] == "done", f"{drill}")
        check([r["end"] for r in drill["results"]] == ["stands", "goes_on", "not_played"],
              [r["end"] for r in drill["results"]])
        check("does not stand after 20 s" in drill["results"][1]["reason"], drill["results"][1])
        check(drill["mission"] == {"id": mission, "revision": 1, "name": "drill"}, drill["mission"])
        at = drill["results"][0]["begins"]
        check(abs(metres_between(at, place(rest, 0, 12.5)) - 0) < 0.6, f"it began at {at}")
        check(abs(at["heading_deg"] - 90) < 10, f"heading {at['heading_deg']}")
        check(rest.get("/execution")["state"] == "idle", "a mission was loaded")
        check(drill["results"][0]["fence_distance_m"] is None, "there is no fence")


def bad_requests():
    """each wrong member is named; nothing is started"""
    with Station(seed=4) as station:
        rest = station.rest
        mission = load_way(rest)
        for body, status, pointer in (
                ({"at_m": -1}, 422, "/at_m"), ({"at_m": 1000}, 422, "/at_m"),
                ({"at_m": "middle"}, 422, "/at_m"), ({"limit_s": 1e9}, 422, "/limit_s"),
                ({"failures": ["drive_link", "meteor"]}, 422, "/failures/1"),
                ({"failures": ["drive_link", "drive_link"]}, 422, "/failures/1"),
                ({"failures": []}, 422, "/failures"), ({"failures": "all"}, 422, "/failures"),
                ({"revision": 1}, 422, "/revision"), ({"speed": 1}, 422, "/speed"),
                ({"mission_id": "nothere"}, 404, None),
                ({"mission_id": mission, "revision": 7}, 404, None),
                (b"{", 400, None), (b"[]", 422, None)):
            got, _, answer = rest.call("POST", DRILL, body)
            check(got == status, f"{body}: {got} {answer}")
            check(answer["status"] == status, f"{body}: no problem document")
            pointers = [e["pointer"] for e in answer.get("errors", [])]
            check(pointer is None or pointer in pointers, f"{body}: {pointers}")
        # one whose way leaves the fence is not played: it would not be started
        fence = {"name": "small", "areas": [{"kind": "inclusion", "polygon": [
            place(rest, -5, -5), place(rest, -5, 5), place(rest, 20, 5), place(rest, 20, -5)]}]}
        rest.do("PUT", "/fence", {"fence_id": rest.do("POST", "/fences", fence)["id"]})
        got, _, answer = rest.call("POST", DRILL, {})
        check(got == 422 and "fence" in answer["detail"], f"{got} {answer}")
        check(rest.get(DRILL)["state"] == "none", "something was started")
        check(rest.call("DELETE", DRILL)[0] == 409, "something was ended")


def cancelled_and_killed():
    """DELETE ends it, a killed child is told by its name, the next drill runs"""
    with Station(seed=5) as station:
        rest = station.rest
        load_way(rest)

        def begin():
            rest.do("POST", DRILL, {})
            return until("the study runs", 10, lambda: children(station), 0.01)

        # Given one that runs, stopped where it is so that it cannot end too early
        pid = begin()[0]
        until("it stepped back", 20, lambda: os.getpriority(os.PRIO_PROCESS, pid) >= 10, 0.002)
        os.kill(pid, signal.SIGSTOP)
        # When it is cancelled, then it is gone at once, and GET says so
        drill = rest.do("DELETE", DRILL)
        check(drill["state"] == "cancelled", f"{drill['state']}")
        until("the study is gone", 20, lambda: not children(station), 0.02)
        check(rest.call("DELETE", DRILL)[0] == 409, "there is none any more")
        # When the next one is killed from outside
        pid = begin()[0]
        os.kill(pid, signal.SIGSTOP)
        os.kill(pid, signal.SIGKILL)
        # Then the drill failed, by that program's name and the signal's
        drill = ended(rest, 30)
        check(drill["state"] == "failed", f"{drill['state']}")
        check("roverd-study" in drill["detail"] and "signal 9" in drill["detail"], drill["detail"])
        # and the robot is as well as before, and plays the next one
        rest.do("POST", DRILL, {"failures": ["drive_link"]})
        check(ended(rest)["state"] == "done", "the next one does not run")
        # When roverd ends, killed, nothing of it is left
        pid = begin()[0]
        station.roverd.stop(signal.SIGKILL)
        until("the study went with it", 30, lambda: not os.path.exists(f"/proc/{pid}"), 0.02)


def a_missing_program():
    """503, naming it"""
    with Station(seed=6) as station, tempfile.TemporaryDirectory() as folder:
        arguments = list(station.roverd.process.args)
        check(station.roverd.stop(signal.SIGINT) == 0, "it does not end well")
        lonely = pathlib.Path(folder) / "roverd"
        shutil.copy(BIN / "roverd", lonely)
        station.roverd = Program(lonely, *arguments[1:])
        rest = Rest(station.roverd.wait_line(r"^listening on (http://\S+)")[1])
        load_way(rest)
        status, _, answer = rest.call("POST", DRILL, {})
        check(status == 503, f"{status} {answer}")
        check(str(lonely.parent / "roverd-study") in answer["detail"], answer["detail"])
        check(rest.get(DRILL)["state"] == "none", "it says that one runs")


def ten_thousand_items():
    """a long mission costs no more than a short one, and the web answers meanwhile"""
    with Station(seed=7) as station:
        rest = station.rest
        ready(rest)
        here = rest.get("/vehicle")["position"]
        lanes = [[(lane, i if lane % 2 == 0 else 99 - i) for i in range(100)] for lane in range(100)]
        points = [place(rest, 3.0 * north, 3.0 * east, here) for lane in lanes for north, east in lane]
        mission = mission_of(rest, points, "long")
        rest.do("POST", DRILL, {"mission_id": mission, "failures": ["drive_link"]})
        slowest = 0.0
        while rest.get(DRILL)["state"] == "running":
            begun = time.monotonic()
            rest.get("/health")
            slowest = max(slowest, time.monotonic() - begun)
        drill = rest.get(DRILL)
        check(drill["state"] == "done", json.dumps(drill)[:500])
        check(drill["begins"]["at_m"] > 14_000, f"{drill['begins']}")
        check(drill["results"][0]["end"] == "stands", drill["results"][0]["reason"])
        check(slowest < 1.0, f"GET /health took {slowest:.2f} s")


sys.exit(run_cases([plays_all_and_moves_nothing, named_missions_and_places, bad_requests,
                    cancelled_and_killed, a_missing_program, ten_thousand_items]))
