#!/usr/bin/env python3
"""The building of place_test.py in three dimensions: a cloud of its walls and ground as a PCD file. roverd finds
itself in it by a lidar of sixteen rows; judged by where the simulator says it was."""

import math
import sys

from place_test import HALF, MAP, WALLS, Hall
from seeing import HEARS_TOP_AND_FRONT, TOP_AND_FRONT, SeeingRobot
from station import check, run_cases, until

STEP = 0.05


def cloud():
    """What a surveyor's scanner would have seen, a point each five centimetres."""
    points = [(-2.9 + STEP * i, -3.9 + STEP * k, 0.0) for i in range(298) for k in range(238)]
    for ax, ay, bx, by in WALLS:
        length = math.hypot(bx - ax, by - ay)
        ux, uy = (bx - ax) / length, (by - ay) / length
        for i in range(int(length / STEP) + 1):
            for side in (-HALF, HALF):
                x, y = ax + ux * STEP * i - uy * side, ay + uy * STEP * i + ux * side
                points += [(x, y, STEP * k) for k in range(51)]
    return points


def draw_cloud(folder):
    points = cloud()
    head = f"VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {len(points)}\nHEIGHT 1\n" \
           f"VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {len(points)}\nDATA ascii\n"
    (folder / "hall.pcd").write_text(head + "".join("%.3f %.3f %.3f\n" % p for p in points))


class SolidHall(Hall):
    def __init__(self):
        SeeingRobot.__init__(self, {"name": "hall", "ground": {"grass_m": 0.0}, "things": Hall.THINGS},
                             TOP_AND_FRONT, HEARS_TOP_AND_FRONT + MAP.replace("hall.yaml", "hall.pcd"))

    def prepare(self):
        draw_cloud(self.scratch)
        self.control.ask({"fault": {"gnss_outage": True}})

    def sticks(self, ahead, turn):
        """Somebody drives it by the radio, past roverd. @param ahead, turn of the sticks, -1 to 1"""
        self.control.ask({"radio": {"on": True, "swb": "middle", "right_ud": ahead, "left_lr": turn}})


def drives_by_the_cloud():
    """a cloud and a tap are enough: the mission is driven by the lidar's place in it"""
    with SolidHall() as hall:
        check(until("a map is in use", 10, hall.place)["map"] == "hall", "the map is named")
        hall.tap()
        until("what is believed is there", 10, lambda: math.hypot(*hall.off()[:2]) < 0.1, 0.2)
        hall.drives_rightly()
        check(hall.truth()["contacts"] == 0, "it touched nothing")


def is_found_without_a_word():
    """where nobody says where it stands, the plane of the cloud is searched while somebody drives it by the radio"""
    with SolidHall() as hall:
        until("a map is in use", 10, lambda: hall.place()["state"] == "searching", 0.2)
        hall.sticks(0.4, 0)
        until("it is found", 40, lambda: hall.place()["state"] == "known", 0.1)
        hall.sticks(0, 0)
        until("it stands", 10, lambda: abs(hall.truth()["speed_mps"]) < 0.01, 0.2)
        until("what is believed is there", 10, lambda: math.hypot(*hall.off()[:2]) < 0.1, 0.2)


def is_told_when_it_was_carried():
    """a robot that was carried elsewhere is told to be lost within 3 m, and is found again by driving on"""
    with SolidHall() as hall:
        hall.tap()
        until("what is believed is there", 10, lambda: math.hypot(*hall.off()[:2]) < 0.1, 0.2)
        hall.control.ask({"pose": {"east_m": 9.0, "north_m": 2.0, "heading_deg": 190}})
        at = hall.truth()["driven_m"]
        hall.sticks(0.4, 0)
        until("it is lost", 30, lambda: "place_lost" in [
            e["kind"] for e in hall.rest.get("/events?limit=100")["items"]], 0.1)
        way = hall.truth()["driven_m"] - at
        print(f"# lost after {way:.2f} m")
        check(way < 3.0, f"it drove {way:.2f} m before it was told")
        hall.sticks(0.25, 0.3)
        until("it is found again", 60, lambda: hall.place()["state"] == "known", 0.1)
        hall.sticks(0, 0)
        until("what is believed is there", 15, lambda: math.hypot(*hall.off()[:2]) < 0.1, 0.2)


if __name__ == "__main__":
    sys.exit(run_cases([drives_by_the_cloud, is_found_without_a_word, is_told_when_it_was_carried]))
