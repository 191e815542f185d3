#!/usr/bin/env python3
"""The building of place_test.py in three dimensions: a cloud of its walls and ground as a PCD file. roverd finds
itself in it by a lidar of sixteen rows; judged by where the simulator says it was."""

import math
import struct
import sys
import time

from place_test import HALF, MAP, METRE_LAT, METRE_LON, START, WALLS, Hall
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


class Barn(Hall):
    """Of which nobody has a map yet, and satellites are heard."""

    def __init__(self):
        SeeingRobot.__init__(self, {"name": "barn", "ground": {"grass_m": 0.0}, "things": Hall.THINGS})

    def prepare(self):
        pass

    def position_by(self, source):
        position = self.rest.get("/vehicle")["position"]
        return position is not None and (position["source"] or "").startswith(source)


class SolidHall(Hall):
    def __init__(self):
        SeeingRobot.__init__(self, {"name": "hall", "ground": {"grass_m": 0.0}, "things": Hall.THINGS},
                             TOP_AND_FRONT, HEARS_TOP_AND_FRONT + MAP.replace("hall.yaml", "hall.pcd"))

    def prepare(self):
        draw_cloud(self.scratch)
        self.control.ask({"fault": {"gnss_outage": True}})
        time.sleep(0.5)  # what the receiver measured before is on its way for 0.12 s

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


def heights_of(pcd):
    """x, y and z of a file as roverd writes it: compressed, a column after the other."""
    head, data = pcd.split(b"DATA binary_compressed\n", 1)
    words = dict(line.split(" ", 1) for line in head.decode().splitlines() if " " in line)
    names, count = words["FIELDS"].split(), int(words["POINTS"])
    packed, size = struct.unpack("<II", data[:8])
    plain = unpacked(data[8:8 + packed], size)
    return [struct.unpack_from(f"<{count}f", plain, 4 * count * names.index(n)) for n in "xyz"]


def unpacked(data, size):
    """LZF."""
    out, at = bytearray(), 0
    while at < len(data):
        control = data[at]
        at += 1
        if control < 32:
            out += data[at:at + control + 1]
            at += control + 1
            continue
        length = control >> 5
        if length == 7:
            length += data[at]
            at += 1
        back = ((control & 31) << 8) + data[at] + 1
        at += 1
        for _ in range(length + 2):
            out.append(out[-back])
    check(len(out) == size, f"{len(out)} of {size} bytes")
    return bytes(out)


def off_the_walls(anchor, xs, ys, zs):
    """How far the cells that stand are from the faces of the walls; metres."""
    yaw = math.radians(90 - anchor["heading_deg"])
    east, north = (anchor["lon"] - START[1]) / METRE_LON, (anchor["lat"] - START[0]) / METRE_LAT
    for x, y, z in zip(xs, ys, zs):
        if z > 0.4:
            e, n = east + math.cos(yaw) * x - math.sin(yaw) * y, north + math.sin(yaw) * x + math.cos(yaw) * y
            yield min(abs(to_segment(e, n, *wall) - HALF) for wall in WALLS)


def to_segment(x, y, ax, ay, bx, by):
    along = ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / ((bx - ax) ** 2 + (by - ay) ** 2)
    along = min(1.0, max(0.0, along))
    return math.hypot(x - ax - along * (bx - ax), y - ay - along * (by - ay))


def is_made_by_a_drive():
    """a drive by satellites gives a map in three dimensions; without them the robot drives by it"""
    with Barn() as barn:
        barn.sees("front", "top")
        until("the satellites are there", 30, lambda: barn.position_by("gnss"), 0.2)
        barn.rest.do("POST", "/maps/start")
        barn.mission([(2, 2), (8, 2), (9, 4.5), (9.5, 2)])
        barn.watch(200, lambda: barn.rest.get("/execution")["state"] == "finished")
        making = barn.rest.get("/maps")["making"]
        check(making["clouds"] >= 12, f"a cloud each metre: {making}")
        made = barn.rest.do("POST", "/maps/stop", {"name": "barn"})
        check(made["solid"] and made["anchor"] is not None, f"it was made: {made}")
        x, y, z = heights_of(barn.rest.call("GET", f"/maps/{made['id']}/export?format=pcd")[2])
        low = sum(1 for h in z if abs(h) < 0.1)
        up = sorted(off_the_walls(made["anchor"], x, y, z))
        print(f"# {len(z)} cells, {low} on the ground, {len(up)} upright: {up[len(up) // 2]:.3f} m off the walls "
              f"by half, {up[len(up) * 95 // 100]:.3f} m by 95 in 100; up to {max(z):.2f} m")
        check(low > 500 and len(up) > 1000 and 2.0 < max(z) < 2.7, "ground, and walls of 2.5 m")
        check(up[len(up) // 2] < 0.08 and up[len(up) * 95 // 100] < 0.2, "they stand where the walls do")
        barn.control.ask({"fault": {"gnss_outage": True}})
        barn.rest.do("POST", f"/maps/{made['id']}/use")
        looked = barn.rest.get("/vehicle")["place"]["map"]
        check(looked == "barn", f"the answer came before the robot looked in it: {looked}")
        until("the map leads", 20, lambda: barn.position_by("map"), 0.2)
        barn.drives_rightly()
        check(barn.truth()["contacts"] == 0, "it touched nothing")


if __name__ == "__main__":
    sys.exit(run_cases([is_made_by_a_drive, drives_by_the_cloud, is_found_without_a_word, is_told_when_it_was_carried]))
