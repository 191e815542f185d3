#!/usr/bin/env python3
"""A robot that sees, in a world that it does not know: roverd-sim casts the rays and speaks the scanner's
and the lidar's bytes, roverd hears them and keeps off. Judged by what the simulator says was touched."""

import math
import pathlib
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
from seeing import HEARS_TOP_AND_FRONT, SeeingRobot  # noqa: E402
from station import Failed, check, run_cases, until  # noqa: E402

METRE_LAT = 1 / 111_360.0
WORLD = {"name": "wall", "ground": {"grass_m": 0.03},
         "things": [{"kind": "wall", "points": [[-6, 9], [6, 9]], "height_m": 2}]}


class Field(SeeingRobot):
    def __init__(self, things=None, more=""):
        """@param things of the world; without them the wall. @param more of the configuration"""
        super().__init__(dict(WORLD, things=things) if things is not None else WORLD,
                         hears=HEARS_TOP_AND_FRONT + more)

    def drive_north(self, metres):
        """A mission straight to the north of where it stands."""
        truth = self.truth()
        lat, lon = truth["lat"], truth["lon"]
        items = [{"type": "waypoint", "lat": lat + n * METRE_LAT, "lon": lon} for n in (1, metres)]
        self.start(self.rest.do("POST", "/missions", {"name": "north", "items": items}))


def sees_and_stops():
    """what stands in the way is seen by scanner and lidar, and not touched"""
    with Field() as field:
        field.sees("front", "top")
        field.drive_north(14)
        until("it stands before the wall", 60, lambda: (
            (field.rest.get("/vehicle")["obstacle"] or {}).get("action") == "stop"), 0.2)
        time.sleep(1.0)
        vehicle, truth = field.rest.get("/vehicle"), field.truth()
        obstacle = vehicle["obstacle"]
        check(truth["contacts"] == 0, f"it touched something: {truth}")
        check(0.03 <= truth["clearance_m"] <= 0.6, f"it stands {truth['clearance_m']} m before it")
        check(obstacle["what"] == "obstacle" and obstacle["sensor"] in ("front", "top"),
              f"what blocks is told: {obstacle}")
        check(abs(obstacle["bearing_deg"]) < 60, f"it is ahead: {obstacle}")
        check(any(c["id"] == "obstacle" for c in vehicle["safety"]), "the condition is listed")
        things = field.rest.get("/obstacles")["items"]
        wall = max(things, key=lambda thing: thing["size_m"])
        check(wall["on_way"] and 10 < wall["size_m"] < 14, f"the wall is one thing on the way: {things}")
        north_m = (wall["lat"] - truth["lat"]) / METRE_LAT
        check(0.4 < north_m < 1.3, f"and its place on the map is before the robot: {wall}, {truth}")
        check(field.rest.get("/execution")["state"] == "running", "the mission waits")
        field.control.ask({"world": False})
        until("the way is clear, and it goes on", 30,
              lambda: field.rest.get("/execution")["state"] == "finished", 0.3)


def a_silent_sensor_stops_it():
    """a required sensor that falls silent stops the mission"""
    with Field() as field:
        field.sees("front", "top")
        field.drive_north(7)
        until("it drives", 40, lambda: abs(field.truth()["speed_mps"]) > 0.3)
        field.control.ask({"fault": {"sensor": "front", "sensor_silent": True}})
        until("it holds, and says which sensor", 3, lambda: any(
            c["id"] == "blind" and "front" in c["detail"]
            for c in field.rest.get("/vehicle")["safety"]), 0.02)
        until("it stands", 4, lambda: math.fabs(field.truth()["speed_mps"]) < 0.01)
        check(field.rest.get("/vehicle")["mode"] == "HOLD", "the mode is HOLD")


def kinds(field):
    return [e["kind"] for e in field.rest.get("/events?limit=1000")["items"]]


AROUND = """
[sense.blocked]
after_s = 2
then = "around"
"""


def goes_around():
    """what stays is driven around, within the corridor, and the mission ends where it should"""
    box = {"kind": "box", "at": [0.1, 6.0], "length_m": 0.9, "width_m": 0.6, "height_m": 1.0}
    with Field([box], AROUND) as field:
        field.sees("front", "top")
        begin = field.truth()
        field.drive_north(13)
        detour = until("a way around is shown", 60, lambda: field.rest.get("/vehicle")["detour"], 0.1)
        check(len(detour) > 5, f"the way around has {len(detour)} places")
        widest = 0.0
        def finished():
            nonlocal widest
            east_m = (field.truth()["lon"] - begin["lon"]) / METRE_LAT * math.cos(math.radians(begin["lat"]))
            widest = max(widest, abs(east_m))
            state = field.rest.get("/execution")
            if state["state"] == "paused" and "sensor" in state["reason"]:  # a starved machine; told rightly
                field.rest.call("POST", "/execution/resume", {"valid_for_s": 5})
            return state["state"] == "finished"
        try:
            until("the mission is finished", 120, finished, 0.2)
        except Failed:
            for event in field.rest.get("/events?limit=1000")["items"][-25:]:
                print(f"# {event['time']} {event['kind']} {event['detail']}", flush=True)
            raise
        truth = field.truth()
        check(truth["contacts"] == 0, f"it touched something: {truth}")
        check(0.7 < widest < 3.0, f"it was {widest:.2f} m beside its way at most")
        north_m = (truth["lat"] - begin["lat"]) / METRE_LAT
        check(abs(north_m - 13) < 0.2, f"it ended {north_m:.2f} m north")
        happened = kinds(field)
        for kind in ("obstacle", "blocked", "going_around", "around_done", "mission_finished"):
            check(kind in happened, f"{kind} is no event of {happened}")
        check(field.rest.get("/vehicle")["detour"] is None, "no way around is shown any more")


def says_that_there_is_no_way_around():
    """a wall across the whole corridor is not gone around, and that is said"""
    with Field(None, AROUND) as field:
        field.sees("front", "top")
        field.drive_north(14)
        until("it is said that there is no way", 60, lambda: "no_way_around" in kinds(field), 0.3)
        time.sleep(3.0)
        check(kinds(field).count("no_way_around") == 1, "it is said once")
        truth = field.truth()
        check(truth["contacts"] == 0 and abs(truth["speed_mps"]) < 0.01, f"it stands: {truth}")


if __name__ == "__main__":
    sys.exit(run_cases([sees_and_stops, a_silent_sensor_stops_it, goes_around,
                        says_that_there_is_no_way_around]))
