#!/usr/bin/env python3
"""Past tags and poles whose place is known, without satellites: roverd-sim draws what the camera sees and speaks the
scanner's bytes, its tracks slip and count too much. Judged by where the simulator says the robot was: the estimate
stays near the truth and claims what it knows; a tag that was entered wrong by far is told, and not followed."""

import math
import pathlib
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
from seeing import SeeingRobot  # noqa: E402
from station import check, run_cases, until  # noqa: E402

START = (58.37802, 26.7289)  # of config/sim/bunker.toml: the world's origin
METRE_LAT = 1 / 111_384.0
METRE_LON = 1 / (111_590.0 * math.cos(math.radians(START[0])))
EYES = """
[[sensor]]
kind = "lms"
name = "front"
x_m = 0.55
z_m = 0.35
rate_hz = 50

[[sensor]]
kind = "picture"
name = "eye"
x_m = 0.4
z_m = 0.6
"""
HEARS = """
[sense.protect]
creep_turn_radps = 0.4

[sensors.front]
kind = "sick"
link = "{front}"
x_m = 0.55
z_m = 0.35
rate_hz = 50

[cameras.eye]
link = "http://{at_eye}/"
x_m = 0.4
z_m = 0.6
fov_deg = 70.0
tags = true

[known_places.door]
tag = 3
lat = {door_lat}
lon = {door_lon}
heading_deg = 180.0
accuracy_m = 0.03
"""
# The robot drives north along east = 0. Name to what it is, where it stands, and by how much it was entered wrong.
DOOR, POLE, GATE, WRONG = (1.3, 8.0), (-1.6, 15.0), (1.3, 22.0), (1.3, 29.0)
# Seven metres after the gate the odometry is 0.35 m uncertain: a metre would be one word against another at times.
ENTERED_OFF_M = 1.5
END_M = 30.0
PORCH = (0.3, 2.8)  # before the robot at its start


def tag(number, at):
    return {"kind": "tag", "id": number, "at": list(at), "size_m": 0.24, "height_m": 0.6, "heading_deg": 180}


THINGS = [tag(3, DOOR), {"kind": "pole", "at": list(POLE), "radius_m": 0.06, "height_m": 1.5}, tag(4, GATE),
          tag(5, WRONG)]


def place(east, north):
    return {"lat": START[0] + north * METRE_LAT, "lon": START[1] + east * METRE_LON}


class Lane(SeeingRobot):
    def __init__(self, things=None):
        super().__init__({"name": "lane", "ground": {"grass_m": 0.0}, "things": things or THINGS}, EYES, self.hears())

    @staticmethod
    def hears():
        door = place(*DOOR)
        return (HEARS.replace("{door_lat}", f"{door['lat']:.8f}").replace("{door_lon}", f"{door['lon']:.8f}")
                + "[nav.tags]\nsize_m = 0.24\n")

    def prepare(self):
        self.control.ask({"pose": {"east_m": 0.0, "north_m": 0.0, "heading_deg": 0.0}, "forget": True,
                          "fault": {"gnss_outage": True}})
        time.sleep(0.5)  # what the receiver measured before is on its way for 0.12 s

    def known(self, name):
        return next(p for p in self.rest.get("/known-places")["items"] if p["name"] == name)

    def enter(self, name, at, wrong_north_m=0.0, number=None):
        body = {**place(at[0], at[1] + wrong_north_m), "accuracy_m": 0.03}
        if number is not None:
            body |= {"tag": number, "heading_deg": 180}
        self.rest.do("PUT", f"/known-places/{name}", body)

    def off(self):
        """Off the truth, claimed, both m, and the truth."""
        before = self.truth()
        p = self.rest.get("/vehicle")["position"]
        after = self.truth()
        east = (p["lon"] - (before["lon"] + after["lon"]) / 2) / METRE_LON
        north = (p["lat"] - (before["lat"] + after["lat"]) / 2) / METRE_LAT
        return math.hypot(east, north), p["horizontal_accuracy_m"], after


def past_four_of_them():
    """30 m past three that are right and one that is not: bounded, honest, and the wrong one is named"""
    with Lane() as lane:
        lane.enter("pole", POLE)
        lane.enter("gate", GATE, 0.0, 4)
        lane.enter("wrong", WRONG, ENTERED_OFF_M, 5)
        check(lane.known("door")["configured"], "the configuration's own")
        truth = lane.truth()
        until("it has a map", 20, lambda: lane.rest.call(
            "PUT", "/vehicle/pose", {"lat": truth["lat"], "lon": truth["lon"], "heading_deg": 0})[0] == 200, 0.5)
        lane.sees("front")
        lane.start(lane.rest.do("POST", "/missions", {"name": "lane", "items": [
            {"type": "waypoint", **place(0.0, END_M), "speed_mps": 0.8}]}))
        told, end = [], time.monotonic() + 120
        while (execution := lane.rest.get("/execution"))["state"] != "finished":
            check(time.monotonic() < end, f"it takes too long: {execution}")
            if execution["state"] == "paused" and "sensor" in execution["reason"]:  # a starved machine; told rightly
                lane.rest.call("POST", "/execution/resume", {"valid_for_s": 5})
            told.append(lane.off())
            time.sleep(0.1)
        for name in ("door", "pole", "gate", "wrong"):
            print(f"# {lane.known(name)}", flush=True)
        for name, at in (("door", DOOR), ("pole", POLE), ("gate", GATE)):
            check(lane.known(name)["state"] == "used", f"{name} was used: {lane.known(name)}")
            off_m, claimed_m, _ = min(told, key=lambda t: abs(t[2]["north_m"] - at[1]))
            print(f"# beside {name}: {off_m:.3f} m off, {claimed_m:.3f} claimed", flush=True)
            # What is left of 0.4 m, 0.06 of which go in a second: the estimate must not jump.
            check(off_m < 0.25, f"beside {name} it is {off_m:.3f} m off")
        worst_m = max(m for m, *_ in told)
        ratio = max(m / max(s, 0.02) for m, s, _ in told)
        print(f"# of {len(told)}: {worst_m:.3f} m off at most, {ratio:.1f} claimed sigmas", flush=True)
        check(worst_m < 0.6 and ratio < 3.5, f"{worst_m} m, {ratio} sigmas")
        wrong = lane.known("wrong")
        check(wrong["state"] == "contradicts" and abs(wrong["off_m"] - ENTERED_OFF_M) < 0.4, f"told: {wrong}")
        events = [e["detail"] for e in lane.rest.get("/events?limit=1000")["items"] if e["kind"] == "known_place"]
        check(len(events) == 1 and "wrong is seen" in events[0], f"what was told: {events}")
        check(lane.truth()["contacts"] == 0, f"it touched something: {lane.truth()}")


def begins_at_a_tag():
    """switched on indoors: a tag tells place and heading before anybody else does, with what is not known of them"""
    with Lane([tag(6, PORCH)]) as lane:
        check(lane.rest.get("/vehicle")["position"]["lat"] is None, "nothing tells where it is")
        lane.rest.do("PUT", "/known-places/porch", {**place(*PORCH), "tag": 6, "accuracy_m": 0.03})
        time.sleep(3.0)
        check(lane.rest.get("/vehicle")["position"]["lat"] is None, "it may look at it from anywhere")
        lane.enter("porch", PORCH, 0.0, 6)
        until("the tag tells it", 20, lambda: lane.rest.get("/vehicle")["position"]["lat"] is not None)
        off_m, claimed_m, truth = lane.off()
        position = lane.rest.get("/vehicle")["position"]
        turned = (position["heading_deg"] - truth["heading_deg"] + 180.0) % 360.0 - 180.0
        print(f"# {off_m:.3f} m and {turned:.2f} deg off, {claimed_m:.3f} m claimed", flush=True)
        check(off_m < 0.25 and off_m < 3.0 * claimed_m, f"{off_m} m off, {claimed_m} claimed")
        check(abs(turned) < 6.0, f"{turned} deg off")
        check(position["source"] == "landmark+odometry", f"said so: {position['source']}")
        events = [e["detail"] for e in lane.rest.get("/events?limit=1000")["items"] if e["kind"] == "known_place"]
        check(len(events) == 1 and "known by porch" in events[0], f"what was told: {events}")


if __name__ == "__main__":
    sys.exit(run_cases([past_four_of_them, begins_at_a_tag]))
