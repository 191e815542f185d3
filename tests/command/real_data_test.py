#!/usr/bin/env python3
"""Recordings and mission files from the field, through ./run and the API.

They are not part of this repository: the folder is named by ROVERD_REAL_DATA. A missing file is a
skipped test, and with CI=true a failed one.
"""

import json
import math
import os
import pathlib
import re
import signal
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
from station import ROOT, Program, Rest, Station, check, run_cases, until  # noqa: E402

FOLDER = pathlib.Path(os.environ.get("ROVERD_REAL_DATA", ""))


def metres(a, b):
    """Between two near (lat, lon); good to a per mille, which is enough here."""
    north = (b[0] - a[0]) * 111_250.0
    east = (b[1] - a[1]) * 111_320.0 * math.cos(math.radians(a[0]))
    return math.hypot(north, east)


def degrees(text, hemisphere):
    dot = text.index(".")
    value = int(text[: dot - 2]) + float(text[dot - 2:]) / 60.0
    return -value if hemisphere in "SW" else value


def fixes_of(file):
    """(lat, lon) of every intact GGA with a fix: this test's own reading of the recording."""
    fixes = []
    for match in re.finditer(rb"\$(G[A-Z]GGA,[^*\r\n]*)\*([0-9A-Fa-f]{2})", file.read_bytes()):
        text = match[1].decode("ascii", "replace")
        total = 0
        for byte in match[1]:
            total ^= byte
        field = text.split(",")
        if total == int(match[2], 16) and field[6] not in ("", "0"):
            fixes.append((degrees(field[2], field[3]), degrees(field[4], field[5])))
    return fixes


def replay(name, speed, quiet_s=5.0):
    """Plays the recording through ./run and compares what the API shows with the file. The end has
    come when nothing new was shown for quiet_s."""
    fixes = fixes_of(FOLDER / name)
    check(len(fixes) > 10, f"only {len(fixes)} fixes in {name}")
    with tempfile.TemporaryDirectory(prefix="roverd-replay.") as data:
        program = Program(ROOT / "run", "--port", "0", "--data", data, "--replay", FOLDER / name,
                          "--replay-speed", speed)
        try:
            rest = Rest(program.wait_line(r"^listening on (http://\S+)", 60)[1])
            until("the loop runs", 10, lambda: rest.call("GET", "/vehicle")[0] == 200)
            shown, drawn, quiet_since = set(), set(), time.monotonic()
            while time.monotonic() - quiet_since < quiet_s:
                vehicle = rest.get("/vehicle")
                raw = (vehicle["gnss"]["lat"], vehicle["gnss"]["lon"])
                if raw[0] is not None and raw not in shown:
                    shown.add(raw)
                    quiet_since = time.monotonic()
                place = vehicle["position"]
                if place["lat"] is not None and not place["stale"]:
                    drawn.add((place["lat"], place["lon"]))
                time.sleep(0.02)
        finally:
            program.stop(signal.SIGINT)
    check(len(shown) > 5, f"the API showed {len(shown)} of {len(set(fixes))} positions of {name}")
    for place in shown:
        nearest = min(metres(place, fix) for fix in fixes)
        check(nearest < 0.02, f"{place} is {nearest:.2f} m away from every fix of {name}")
    size = max(metres(fixes[0], fix) for fix in fixes)
    first = min(shown, key=lambda place: metres(place, fixes[0]))
    seen = max(metres(first, place) for place in shown)
    check(seen > 0.7 * size, f"the recording spans {size:.1f} m, the shown track {seen:.1f} m")
    return fixes, drawn


def moving_receiver():
    """./run --replay gnss-haicom-moving.log shows that receiver's track"""
    fixes, drawn = replay("gnss-haicom-moving.log", 4)
    check(drawn, "no estimated position came of it")
    for place in drawn:
        nearest = min(metres(place, fix) for fix in fixes)
        check(nearest < 25.0, f"the estimate {place} is {nearest:.1f} m away from every fix")


def rtk_receiver():
    """./run --replay gnss-nmea-rtk.log shows that receiver's track"""
    replay("gnss-nmea-rtk.log", 5, quiet_s=10.0)  # it has a hole of ten minutes, cut to 30 s


def mixed_receiver():
    """./run --replay gnss-zed-f9p-ubx-nmea.log finds the NMEA between the UBX messages"""
    replay("gnss-zed-f9p-ubx-nmea.log", 60)


def positions_in_plan(text):
    plan = json.loads(text)
    return [tuple(i["params"][4:6]) for i in plan["mission"]["items"]
            if i.get("command") == 16]


def positions_in_waypoints(text):
    rows = [row.split("\t") for row in text.splitlines()[1:] if row.strip()]
    return [(float(r[8]), float(r[9])) for r in rows[1:] if r[3] == "16"]


def round_trip(name, file_format, positions_in):
    original = (FOLDER / name).read_text(encoding="utf-8")
    wanted = positions_in(original)
    check(len(wanted) >= 4, f"only {len(wanted)} positions read from {name}")
    with Station() as station:
        status, _, result = station.rest.call(
            "POST", f"/missions/import?name={name}", original.encode(),
            {"Content-Type": "application/octet-stream"})
        check(status == 201, f"import of {name} answers {status}: {result}")
        check(result["format"] == file_format, f"taken for {result['format']}")
        accounted = result["taken"] + result["changed"] + result["left_out"]
        check(accounted == len(result["report"]), f"counts do not agree with the report: {result}")
        check(all(entry["reason"] or entry["outcome"] == "taken" for entry in result["report"]), "an entry of the report has no reason")
        mission = result["mission"]
        inside = [(i["lat"], i["lon"]) for i in mission["items"] if i["type"] == "waypoint"]
        check(len(inside) == len(wanted), f"{len(inside)} waypoints of {len(wanted)}")
        status, headers, text = station.rest.call(
            "GET", f"/missions/{mission['id']}/export?format={file_format}")
        check(status == 200, f"export answers {status}")
        check("filename" in headers.get("Content-Disposition", ""), "no download name")
        if not isinstance(text, bytes):
            text = json.dumps(text).encode()
        back = positions_in(text.decode())
    check(len(back) == len(wanted), f"{len(back)} positions of {len(wanted)} come out again")
    for a, b in zip(wanted, back):
        check(max(abs(a[0] - b[0]), abs(a[1] - b[1])) < 1e-8, f"{a} came out as {b}")


def qground_control_plan():
    """mission-sitl.plan imports with every item accounted for, and exports the same positions"""
    round_trip("mission-sitl.plan", "plan", positions_in_plan)


def mission_planner_waypoints():
    """mission-rover-basic.waypoints imports, and exports the same positions"""
    round_trip("mission-rover-basic.waypoints", "waypoints", positions_in_waypoints)


CASES = {
    "gnss-haicom-moving.log": moving_receiver,
    "gnss-nmea-rtk.log": rtk_receiver,
    "gnss-zed-f9p-ubx-nmea.log": mixed_receiver,
    "mission-sitl.plan": qground_control_plan,
    "mission-rover-basic.waypoints": mission_planner_waypoints,
}

if __name__ == "__main__":
    here = []
    for name, case in CASES.items():
        if (FOLDER / name).is_file():
            here.append(case)
        else:
            print(f"skip - {case.__doc__}: {FOLDER / name} is missing")
    sys.exit(run_cases(here))
