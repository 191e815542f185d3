#!/usr/bin/env python3
"""Walls and cones by the sensors' bytes: roverd-sim speaks the scanner's language, or that of a camera's
program, and roverd drives along what it makes of them. Judged by where the simulator says the robot was."""

import math
import pathlib
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
from seeing import SeeingRobot  # noqa: E402
from station import Failed, check, run_cases, until  # noqa: E402

SCANNER = ("""
[[sensor]]
kind = "lms"
name = "front"
x_m = 0.55
z_m = 0.35
rate_hz = 50
""", """
[sensors.front]
kind = "sick"
link = "{front}"
x_m = 0.55
z_m = 0.35
rate_hz = 50
""")
CAMERA = ("""
[[sensor]]
kind = "vision"
name = "camera"
x_m = 0.4
z_m = 0.4
port = "udp:{port}"
""", """
[sensors.camera]
kind = "vision"
link = "udp:{port}"
required = false
x_m = 0.4
z_m = 0.4
""")
# Beside it no sensor sees the ground: it may turn there slowly.
GUARD = """
[sense.protect]
creep_turn_radps = 0.4
creep_mps = 0.6
"""
HALF_WALL_M = 0.1
# Along north as far as a corner, a door in it, then along east.
WALLS = [{"kind": "wall", "points": [[-1.0, -7], [-1.0, 3]]},
         {"kind": "wall", "points": [[-1.0, 4], [-1.0, 9], [9, 9]]}]
CONES = [[-0.6, 0.0], [-0.8, 3.0], [-0.4, 6.0], [-0.7, 9.0]]


class Yard(SeeingRobot):
    def __init__(self, things, eyes):
        self.trail = []  # (east, north)
        self.fastest_mps = 0.0
        super().__init__({"name": "marks", "things": things}, eyes[0], GUARD + eyes[1])

    def prepare(self):
        # Until here it stood among the cones, as its configuration says, and touched one.
        self.control.ask({"pose": {"east_m": 0.05, "north_m": -4.0, "heading_deg": 1.0}, "forget": True})

    def drive(self, item, seconds, on_the_way=lambda truth: None):
        """A mission of one item, its trail kept. @return the execution at its end"""
        until("it is ready", 30, lambda: self.rest.get("/vehicle")["ready_to_arm"], 0.2)
        self.start(self.rest.do("POST", "/missions", {"name": "marks", "items": [item]}))

        def over():
            truth = self.truth()
            self.trail.append((truth["east_m"], truth["north_m"]))
            on_the_way(truth)
            execution = self.rest.get("/execution")
            self.fastest_mps = max(self.fastest_mps, truth["speed_mps"])
            if execution["state"] == "paused" and "sensor" in execution["reason"]:
                # A starved machine; told rightly.
                self.rest.call("POST", "/execution/resume", {"valid_for_s": 5})
                return None
            return execution if execution["state"] in ("blocked", "aborted", "paused", "finished") else None
        try:
            return until("the mission is over", seconds, over, 0.05)
        except Failed as why:
            print(f"# {self.truth()} {self.rest.get('/execution')} {self.rest.get('/landmarks')}"[:3000])
            raise why

    def nearest_m(self, place):
        """The least distance of the trail to a place."""
        def off(a, b):
            dx, dy = b[0] - a[0], b[1] - a[1]
            square = dx * dx + dy * dy
            part = 0 if square < 1e-9 else max(0, min(1, ((place[0] - a[0]) * dx + (place[1] - a[1]) * dy) / square))
            return math.hypot(a[0] + part * dx - place[0], a[1] + part * dy - place[1])
        return min(off(a, b) for a, b in zip(self.trail, self.trail[1:]))


def along_a_wall():
    """along a wall at 0.6 m/s: past a door, around an inner corner, at 0.90 m"""
    with Yard(WALLS, SCANNER) as yard:
        yard.sees("front")
        over = yard.drive({"type": "wall", "side": "left", "distance_m": 0.9, "length_m": 17}, 120)
        check(over["state"] == "finished", f"it was driven: {over}")
        offs = [e + 1.0 - HALF_WALL_M - 0.9 for e, n in yard.trail if -2.5 < n < 7.0 and e < 1.0]
        offs += [9.0 - HALF_WALL_M - n - 0.9 for e, n in yard.trail if e > 1.2]
        rms = math.sqrt(sum(d * d for d in offs) / len(offs))
        print(f"# off the way along the wall: rms {100 * rms:.1f} cm, at most {100 * max(map(abs, offs)):.1f} cm, "
              f"as fast as {yard.fastest_mps:.2f} m/s", flush=True)
        check(max(e for e, _ in yard.trail) > 2.0, "it went around the corner")
        check(rms <= 0.03, f"{rms:.3f} m off the way, rms")
        check(0.55 <= yard.fastest_mps <= 0.66, f"{yard.fastest_mps} m/s at its fastest")
        check(yard.truth()["contacts"] == 0, "nothing was touched")


def farther_off():
    """along a wall at the distance of the parameters, and farther off as soon as it is told to on the way"""
    told = []
    with Yard([{"kind": "wall", "points": [[-1.0, -7], [-1.0, 12]]}], SCANNER) as yard:
        def tell(truth):
            if truth["north_m"] > -0.5 and not told:
                told.append(yard.rest.do("PUT", "/parameters/nav.wall.distance_m", {"value": 1.3}))
        yard.sees("front")
        over = yard.drive({"type": "wall", "side": "left", "length_m": 11}, 120, tell)
        check(over["state"] == "finished", f"it was driven: {over}")
        check(told and told[0]["acts"] == "at_once", f"it acted at once: {told}")
        off = lambda n0, n1, m: max(abs(e + 1.0 - HALF_WALL_M - m) for e, n in yard.trail if n0 < n < n1)
        print(f"# off its line before by {100 * off(-2.5, -0.6, 0.9):.1f} cm at most, "
              f"3.5 m later by {100 * off(3.0, 6.5, 1.3):.1f} cm", flush=True)
        check(off(-2.5, -0.6, 0.9) <= 0.06, "it kept 0.90 m")
        check(off(3.0, 6.5, 1.3) <= 0.06, "and then 1.30 m")
        check(yard.truth()["contacts"] == 0, "nothing was touched")


def black_wall():
    """3 m of a wall give no echo, as glass or black paint do: it is not turned into, and it is said why it stops"""
    walls = [{"kind": "wall", "points": [[-1.0, -7], [-1.0, -1]]},
             {"kind": "wall", "points": [[-1.0, -1], [-1.0, 2]], "reflect": 0.0},
             {"kind": "wall", "points": [[-1.0, 2], [-1.0, 8]]}]
    with Yard(walls, SCANNER) as yard:
        yard.sees("front")
        over = yard.drive({"type": "wall", "side": "left", "distance_m": 0.9, "length_m": 10}, 120)
        check(over["state"] == "blocked" and "no echo" in over["reason"], f"it stopped and said why: {over}")
        offs = [e + 1.0 - HALF_WALL_M - 0.9 for e, n in yard.trail if n > -2.5]
        print(f"# it stood {yard.trail[-1][1] + 1.0:.2f} m along the black wall, off its line by "
              f"{100 * max(map(abs, offs)):.1f} cm at most", flush=True)
        check(max(map(abs, offs)) <= 0.06, f"{offs[-1]:.3f} m off the line of the wall")
        check(yard.truth()["contacts"] == 0, "nothing was touched")


def cones(eyes, name, sees, fault=None):
    things = [{"kind": "cone", "at": at, "radius_m": 0.15, "height_m": 0.5} for at in CONES]
    with Yard(things, eyes) as yard:
        if sees:
            yard.sees(*sees)
        if fault:
            yard.control.ask({"fault": fault})
        over = yard.drive({"type": "landmarks", "name": name, "offset_m": -0.7, "count": len(CONES)}, 120)
        check(over["state"] == "finished", f"all of them were passed: {over}")
        at_m = [yard.nearest_m(at) for at in CONES]
        print("# cones passed at " + ", ".join(f"{m:.3f}" for m in at_m) + " m", flush=True)
        check(all(abs(m - 0.7) <= 0.05 for m in at_m), f"passed at {at_m}")
        touched = yard.control.ask({"get": "world"})["touched"]
        check(not touched, f"touched: {touched}")
        return yard.rest.get("/landmarks"), yard.rest.get("/drivers")["items"]


def cones_by_scanner():
    """four cones beside the way, by a scanner: each passed at 0.70 m on the same side"""
    marks, _ = cones(SCANNER, "any", ["front"])
    check(any(m["source"] == "scan" and m["believed"] for m in marks["landmarks"]), f"they are told: {marks}")


def cones_by_camera():
    """the same by a camera's program alone, a tenth of whose datagrams is malformed"""
    marks, drivers = cones(CAMERA, "cone", [], {"sensor_malformed": 0.1})
    check(any(m["name"] == "cone" and m["source"] == "vision" for m in marks["landmarks"]), f"named: {marks}")
    camera = next(d for d in drivers if d["name"] == "camera")
    check(camera["state"] == "up", f"what is malformed is refused, and it stays up: {camera}")


def cones_first():
    """along a wall by the scanner, past the cone that stands in the way first: who leads is told"""
    cone = [-0.15, 1.0]
    led = []

    def look(yard):
        lead = yard.rest.get("/execution")["lead"]
        if lead and lead["source"] and (not led or led[-1] != lead["what"]):
            led.append(lead["what"])
    things = [{"kind": "wall", "points": [[-1.0, -7], [-1.0, 12]]},
              {"kind": "cone", "at": cone, "radius_m": 0.15, "height_m": 0.5}]
    with Yard(things, SCANNER) as yard:
        yard.sees("front")
        over = yard.drive({"type": "wall", "side": "left", "distance_m": 0.9, "length_m": 11, "source": "scan",
                           "landmarks_first": True}, 120, lambda truth: look(yard))
        check(over["state"] == "finished", f"it goes to the end: {over}")
        check(led == ["wall", "landmarks", "wall"], f"led by {led}")
        at_m = yard.nearest_m(cone)
        off_m = yard.truth()["east_m"] - (-1.0 + HALF_WALL_M + 0.9)
        print(f"# past the cone at {at_m:.3f} m, off its line along the wall by {100 * off_m:.1f} cm at the end",
              flush=True)
        check(abs(at_m - 0.7) <= 0.06 and abs(off_m) <= 0.06, "at its distance from each")
        check(yard.truth()["contacts"] == 0, f"it touched something: {yard.truth()}")


def other_source():
    """the camera alone counts, as the parameter says, and is silent: it stands, though the scanner sees the wall"""
    with Yard([{"kind": "wall", "points": [[-1.0, -7], [-1.0, 12]]}], SCANNER) as yard:
        yard.sees("front")
        status, _, refusal = yard.rest.call("PUT", "/parameters/nav.wall.source", {"value": "eyes"})
        check(status in (400, 422) and "source must be auto, scan or vision" in str(refusal), f"{status} {refusal}")
        yard.rest.do("PUT", "/parameters/nav.wall.source", {"value": "vision"})
        over = yard.drive({"type": "wall", "side": "left", "distance_m": 0.9, "length_m": 5}, 60)
        check(over["state"] == "blocked" and "no wall is seen on the left" in over["reason"], f"{over}")
        yard.rest.do("PUT", "/parameters/nav.wall.source", {"value": "auto"})
        yard.trail.clear()
        over = yard.drive({"type": "wall", "side": "left", "distance_m": 0.9, "length_m": 3}, 60)
        check(over["state"] == "finished", f"by whoever sees it: {over}")


def no_cone():
    """where none is seen the robot stops within some metres, and says why"""
    with Yard([], SCANNER) as yard:
        yard.sees("front")
        over = yard.drive({"type": "landmarks", "name": "any", "offset_m": 0.7}, 60)
        time.sleep(1.0)
        check(over["state"] == "blocked" and "no landmark is seen within 2.0 m" in over["reason"], f"{over}")
        check(yard.truth()["north_m"] < -1.5, "it went no farther")


if __name__ == "__main__":
    chosen = [globals()[name] for name in sys.argv[1:]]
    sys.exit(run_cases(chosen or [along_a_wall, farther_off, black_wall, cones_by_scanner, cones_by_camera, cones_first,
                                  other_source, no_cone]))
