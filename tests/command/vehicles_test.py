#!/usr/bin/env python3
"""The main job with every vehicle that is shipped: ./run --vehicle NAME, a mission of four points
over the API, and the simulator's true pose as the judge. All at the same time."""

import concurrent.futures
import math
import pathlib
import shutil
import signal
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
from station import ROOT, Control, Program, Rest, check, run_cases, until  # noqa: E402

RUN = ROOT / "run"
METRE_LAT = 1 / 111_360.0
scratch = pathlib.Path(tempfile.mkdtemp(prefix="roverd-vehicles."))

# Metres ahead and left of the start, speed, nearest to a corner, nearest to the end. Cars drive
# corners as a swing, for which they need room.
JOBS = {
    "bunker": ([(3, 0), (3, 3), (6, 3), (6, 0)], 0.8, 0.5, 0.3),
    "uku": ([(3, 0), (10, 0), (10, 10), (10, 13)], 1.2, 0.5, 0.3),
    "imiev": ([(4, 0), (12, 0), (20, 13.9), (22, 17.3)], 1.3, 0.5, 0.3),
    "probot": ([(2, 0), (2, 2), (4, 2), (4, 0)], 0.5, 0.5, 0.3),
    "donkey": ([(2, 0), (2, 2), (4, 2), (4, 0)], 0.5, 0.5, 0.3),
    "husky": ([(3, 0), (3, 3), (6, 3), (6, 0)], 0.8, 0.5, 0.3),
}
# Which driver moves it, and what has to be heard before that.
DRIVERS = {"bunker": {"bunker", "gnss", "mti"}, "uku": {"ackermann", "gnss"},
           "imiev": {"ackermann", "gnss"}, "probot": {"ratio", "gnss"},
           "donkey": {"twist", "gnss"}, "husky": {"twist", "bumper", "gnss"}}


# The driver that hears, or is connected to, its vehicle; the uku tells nothing.
TELLING = {"bunker": "bunker", "imiev": "ackermann", "probot": "ratio", "donkey": "twist",
           "husky": "twist"}


class Course:
    """A mission laid from where the vehicle really stands and looks."""

    def __init__(self, truth, points):
        heading = math.radians(truth["heading_deg"])
        self.lat, self.lon = truth["lat"], truth["lon"]
        self.metre_lon = METRE_LAT / math.cos(math.radians(self.lat))
        self.points = [(a * math.sin(heading) - b * math.cos(heading),
                        a * math.cos(heading) + b * math.sin(heading)) for a, b in points]

    def items(self):
        return [{"type": "waypoint", "lat": self.lat + n * METRE_LAT,
                 "lon": self.lon + e * self.metre_lon} for e, n in self.points]

    def metres(self, truth, point):
        east = (truth["lon"] - self.lon) / self.metre_lon
        north = (truth["lat"] - self.lat) / METRE_LAT
        return math.hypot(east - point[0], north - point[1])


def break_things(name, control, rest):
    """The faults of the drive link and the bumper reach roverd, and what is over is over."""
    def states():
        return {d["name"]: d["state"] for d in rest.get("/drivers")["items"]}

    if name in TELLING:
        control.ask({"fault": {"bus_off": True}})
        until("the dead drive link is noticed", 10, lambda: states()[TELLING[name]] != "up")
        control.ask({"fault": {"bus_off": False}})
        until("the drive link is up again", 20, lambda: states()[TELLING[name]] == "up")
    if "bumper" in DRIVERS[name]:
        control.ask({"fault": {"bumper": 1}})
        until("the hit latches the stop", 5, lambda: rest.get("/vehicle")["estop"])
        status, _, answer = rest.call("POST", "/vehicle/estop/reset", {})
        check(status == 409, f"a pressed bumper is reset: {answer}")
        control.ask({"fault": {"bumper": 0}})
        until("it lets itself be reset", 5,
              lambda: rest.call("POST", "/vehicle/estop/reset", {})[0] == 200, 0.2)


def drive(name):
    """Starts the vehicle, lets it drive, and looks where it really was."""
    points, speed, corner_m, end_m = JOBS[name]
    program = Program(RUN, "--vehicle", name, "--port", "0", "--data", scratch / name)
    try:
        control = Control(program.wait_line(rf"^simulated {name}: true pose and faults at (\S+)$",
                                            60)[1])
        rest = Rest(program.wait_line(r"^listening on (http://127\.0\.0\.1:\d+)$", 60)[1])
        check(rest.get("/vehicle/capabilities")["vehicle"] == name, "another vehicle is served")
        until("its drivers are up", 20, lambda: {d["name"]: d["state"] for d in
              rest.get("/drivers")["items"]} == dict.fromkeys(DRIVERS[name], "up"))
        course = Course(control.ask({"get": "truth"}), points)
        mission = rest.do("POST", "/missions", {"name": "main job", "items": course.items(),
                                                "settings": {"speed_mps": speed}})
        rest.do("POST", "/execution/load", {"mission_id": mission["id"]})
        until("it lets itself be armed", 60, lambda: rest.call("POST", "/vehicle/arm", {})[0] == 200,
              0.5)
        rest.do("POST", "/execution/start", {"mission_id": mission["id"],
                                             "revision": mission["revision"], "from": "first"})
        nearest = [math.inf] * len(points)
        passed = 0  # in order: a point counts once the one before it was reached

        def finished():
            nonlocal passed
            truth = control.ask({"get": "truth"})
            for i in range(passed, min(passed + 2, len(points))):
                nearest[i] = min(nearest[i], course.metres(truth, course.points[i]))
                if nearest[i] < corner_m:
                    passed = max(passed, i)
            state = rest.get("/execution")
            check(state["state"] in ("running", "finished"), f"{state['state']}: {state}")
            return state["state"] == "finished"

        until("the mission is finished", 150, finished, 0.05)
        check(max(nearest) < corner_m, f"nearest to the waypoints: {nearest}")
        until("it stands", 5, lambda: abs(control.ask({"get": "truth"})["speed_mps"]) < 0.01)
        truth = control.ask({"get": "truth"})
        rests_m = course.metres(truth, course.points[-1])
        check(rests_m < end_m, f"it rests {rests_m:.2f} m from the end")
        until("a second goes by", 10,
              lambda: control.ask({"get": "truth"})["t_s"] > truth["t_s"] + 1.0)
        check(abs(control.ask({"get": "truth"})["driven_m"] - truth["driven_m"]) < 0.02, "it rolls")
        check(rest.get("/vehicle")["mode"] == "HOLD", "not in HOLD at the end")
        break_things(name, control, rest)
        control.close()
        return nearest
    finally:
        program.stop(signal.SIGINT)


def main():
    with concurrent.futures.ThreadPoolExecutor(len(JOBS)) as pool:
        runs = {name: pool.submit(drive, name) for name in JOBS}

        def case_of(name):
            def case():
                metres = ", ".join(f"{m:.2f}" for m in runs[name].result())
                print(f"# {name}: {metres} m beside the waypoints", flush=True)
            case.__doc__ = f"./run --vehicle {name} does the main job"
            return case

        return run_cases([case_of(name) for name in JOBS])


if __name__ == "__main__":
    try:
        code = main()
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
    sys.exit(code)
