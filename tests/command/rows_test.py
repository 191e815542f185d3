#!/usr/bin/env python3
"""A block of rows by its sensors' bytes: roverd-sim grows the plants and speaks the scanner's or the lidar's
language, roverd makes a mission of POST /missions/rows and drives it by sight. Judged by where the simulator
says the robot was: off the middle, touching a plant, out of a row too early or too late."""

import math
import pathlib
import random
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
from seeing import SeeingRobot  # noqa: E402
from station import Failed, check, run_cases, until  # noqa: E402

SPACING_M = 2.5
OUT_M = 1.6
FOLIAGE_M = 0.15
LONGEST_GAP_M = 2.0
EYES = {
    "lms": """
[[sensor]]
kind = "lms"
name = "front"
x_m = 0.55
z_m = 0.35
rate_hz = 50
""",
    "vlp16": """
[[sensor]]
kind = "vlp16"
name = "top"
z_m = 0.8
port = "udp:{port}"
""",
}
SENSORS = {
    "lms": """
[sensors.front]
kind = "sick"
link = "{front}"
x_m = 0.55
z_m = 0.35
rate_hz = 50
""",
    "vlp16": """
[sensors.top]
kind = "velodyne"
link = "udp:{port}"
z_m = 0.8
""",
}
# Before the bonnet of the Uku, whose body begins at its rear axle.
AT_BONNET = {"x_m = 0.55": "x_m = 1.7"}
# Beside it no sensor sees the ground: it may turn there slowly.
GUARD = """
[sense.protect]
creep_turn_radps = 0.4
creep_mps = 0.6
"""


def block(lanes, length_m, seed=1, gaps=0.3):
    """Rows of plants along north, the first lane in the middle at east 0. A third of each is gaps up to two
    metres, the leaves stand up to 15 cm nearer or farther, and weeds grow in the lanes' sides.
    @return things of a world, and where the last plant of each lane's two rows stands, south and north."""
    draw = random.Random(seed)
    things, ends = [], []
    for k in range(-1, lanes + 2):
        east = (k - 0.5) * SPACING_M
        at = first = last = 0.0
        while at <= length_m:
            stand = draw.uniform(0.4, 1.6) * 1.25 * (1 - gaps) / gaps
            till = min(at + stand, length_m)
            while at <= till:
                radius = 0.27 + draw.uniform(-0.45, 0.45) * FOLIAGE_M
                things.append({"kind": "bush", "at": [round(east + draw.uniform(-0.55, 0.55) * FOLIAGE_M, 3),
                                                      round(at, 3)],
                               "radius_m": round(radius, 3), "height_m": round(draw.uniform(1.0, 1.5), 2),
                               "density_pm": 8})
                last = at + 0.6 * radius
                at += 0.4
            at += draw.uniform(0.5, LONGEST_GAP_M)
        ends.append((first, last))
    for lane in range(lanes):
        for _ in range(int(0.06 * length_m)):
            side = draw.choice((-1, 1))
            things.append({"kind": "bush", "at": [lane * SPACING_M + side * draw.uniform(0.72, 0.9),
                                                  draw.uniform(1.0, length_m - 1.0)],
                           "radius_m": 0.06, "height_m": draw.uniform(0.12, 0.3), "density_pm": 8})
    lanes_end = [(min(ends[i + 1][0], ends[i + 2][0]), max(ends[i + 1][1], ends[i + 2][1]))
                 for i in range(lanes)]
    return things, lanes_end


def mounted(words, vehicle):
    for bunker, uku in AT_BONNET.items():
        words = words if vehicle == "bunker" else words.replace(bunker, uku)
    return words


class Field(SeeingRobot):
    def __init__(self, things, eye, more="", sim=(), vehicle="bunker"):
        """@param more of roverd's configuration. @param sim more arguments of roverd-sim"""
        self.trail = []  # (time, east, north, heading)
        super().__init__({"name": "rows", "ground": {"grass_m": 0.03}, "things": things},
                         mounted(EYES[eye], vehicle), GUARD + mounted(SENSORS[eye], vehicle) + more, sim,
                         vehicle)

    def prepare(self):
        self.control.ask({"pose": {"east_m": 0.05, "north_m": -2.0, "heading_deg": 2.0}})
        self.control.ask({"forget": True})  # it stood among the plants before

    def truth(self):
        truth = super().truth()
        self.trail.append((time.monotonic(), truth["east_m"], truth["north_m"], truth["heading_deg"]))
        return truth

    def run(self, seconds, each=lambda: None):
        """Until the mission is finished, its trail kept."""
        def over():
            self.truth()
            each()
            execution = self.rest.get("/execution")
            why = execution["reason"]
            if execution["state"] == "paused" and ("sensor" in why or "surroundings" in why):
                # A starved machine; told rightly. What is seen of the row is found anew.
                self.rest.call("POST", "/execution/resume", {"valid_for_s": 5})
                return False
            if execution["state"] in ("blocked", "aborted", "paused"):
                raise Failed(f"{execution['state']}: {execution['reason']}")
            return execution["state"] == "finished"
        try:
            until("the mission is finished", seconds, over, 0.1)
        except Failed as why:
            self.tell()
            raise why

    def tell(self):
        time.sleep(1.5)
        for event in self.rest.get("/events?limit=1000")["items"][-25:]:
            print(f"# {event['time']} {event['kind']} {event['detail']}", flush=True)
        print(f"# {self.truth()}", flush=True)
        print(f"# {self.rest.get('/vehicle')}"[:1500], flush=True)


def judge(trail, lane, end, forth, swing_m):
    """@param swing_m that its turn into the next one comes farther out. @return off the middle of a lane, root
    of the mean square and at most; likewise in the first metre behind its plants, at most; where it turned,
    from its plants' end on"""
    middle = lane * SPACING_M
    here = [(e - middle, n - end[0] if forth else end[1] - n) for _, e, n, _ in trail
            if abs(e - middle) < SPACING_M / 2]
    whole = end[1] - end[0]
    inside = [(d, s) for d, s in here if 1.0 < s <= whole]
    behind = [abs(d) for d, s in here if whole < s <= whole + 1.0]
    check(len(inside) > 20, f"lane {lane} was driven: {len(inside)} places of it")
    rms = math.sqrt(sum(d * d for d, _ in inside) / len(inside))
    near = [n for _, e, n, _ in trail if abs(e - middle) < SPACING_M / 2]
    turned = max(near) - end[1] if forth else end[0] - min(near)
    return rms, max(abs(d) for d, _ in inside), max(behind, default=0.0), turned - OUT_M - swing_m


def plan(field, lanes, **more):
    body = {"rows": lanes, "spacing_m": SPACING_M, "out_m": OUT_M, "name": "rows", **more}
    return field.rest.do("POST", "/missions/rows", body)


def drive_block(eye, lanes, length_m, seed, more="", sim=(), each=None, entry=False, vehicle="bunker", **turns):
    things, ends = block(lanes, length_m, seed)
    with Field(things, eye, more, sim, vehicle) as field:
        field.sees({"lms": "front", "vlp16": "top"}[eye])
        until("it is ready", 30, lambda: field.rest.get("/vehicle")["ready_to_arm"], 0.2)
        truth = field.truth()
        begin = {"entry": {"lat": truth["lat"], "lon": truth["lon"]}, "heading_deg": 0} if entry else {}
        planned = plan(field, lanes, **begin, **turns)
        arc_m = planned["headland_m"] - OUT_M  # that it swings farther out
        field.start(planned["mission"])
        field.run(60 + lanes * length_m * 5, (lambda: each(field)) if each else lambda: None)
        truth = field.truth()
        figures = [judge(field.trail, i, end, i % 2 == 0, arc_m if i + 1 < lanes else 0.0)
                   for i, end in enumerate(ends)]
        for i, (rms, most, behind, beyond) in enumerate(figures):
            print(f"# {eye} lane {i}: rms {100 * rms:.1f} cm, at most {100 * most:.1f} cm, "
                  f"a metre behind it {100 * behind:.1f} cm, "
                  f"its end {beyond:+.2f} m; brushed {truth['brushes']} times", flush=True)
        # Leaves, which plants here are all of, are brushes to the simulator.
        check(truth["contacts"] == 0 and truth["brushes"] == 0, f"it touched a plant: {truth}")
        for i, (rms, most, behind, beyond) in enumerate(figures):
            check(behind <= 0.2, f"lane {i}: left {behind:.3f} m off its middle")
            check(rms <= 0.04 and most <= 0.15, f"lane {i}: {rms:.3f} m off its middle, {most:.3f} at most")
            check(-0.5 <= beyond <= 0.5, f"lane {i} ended {beyond:.2f} m beyond its plants")
        reached = [e["detail"] for e in field.rest.get("/events?limit=1000")["items"]
                   if e["kind"] == "item_reached"]
        check(len(reached) == len(planned["mission"]["items"]), f"each item was done once: {reached}")


def by_scanner():
    """two rows by an LMS scanner, the tracks slipping: in the middle, out at their ends, nothing touched"""
    drive_block("lms", 2, 16.0, 1)


def by_lidar():
    """a row by a VLP-16 that vouches for nothing where no echo comes back"""
    drive_block("vlp16", 1, 14.0, 3)


def without_satellites():
    """the same two rows where the sky is lost in the first one: rows, turns and moves need none"""
    def lose(field):
        if field.trail[-1][2] > 2.0:
            field.control.ask({"fault": {"gnss_outage": True}})
    drive_block("lms", 2, 18.0, 2, each=lose)


def by_car():
    """two rows by a car, which cannot turn between them: it shunts, and touches nothing"""
    drive_block("lms", 2, 16.0, 1, vehicle="uku")


def by_arcs():
    """two rows by the tracked vehicle, in a half circle from one to the other"""
    drive_block("lms", 2, 12.0, 4, turn_kind="arc")


if __name__ == "__main__":
    chosen = [globals()[name] for name in sys.argv[1:]]
    sys.exit(run_cases(chosen or [by_scanner, by_lidar, without_satellites, by_car, by_arcs]))
