#!/usr/bin/env python3
"""What the estimator learned while driving begins the next start."""

import json
import math
import pathlib
import signal
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
from station import Program, Rest, Station, check, run_cases, until  # noqa: E402

METRE_LAT = 1 / 111_360.0


def drive_ahead(rest, metres):
    until("the checks are fine", 60, lambda: rest.get("/vehicle/checks")["ready"], 0.2)
    here = rest.get("/vehicle")["position"]
    heading = math.radians(here["heading_deg"])
    metre_lon = METRE_LAT / math.cos(math.radians(here["lat"]))
    item = {"type": "waypoint", "lat": here["lat"] + metres * math.cos(heading) * METRE_LAT,
            "lon": here["lon"] + metres * math.sin(heading) * metre_lon}
    mission = rest.do("POST", "/missions", {"name": "ahead", "items": [item]})["id"]
    rest.do("POST", "/execution/load", {"mission_id": mission})
    rest.do("POST", "/vehicle/arm", {"valid_for_s": 5})
    rest.do("POST", "/execution/start", {"mission_id": mission, "revision": 1, "valid_for_s": 5})
    until("it arrives", 60, lambda: rest.get("/execution")["state"] == "finished", 0.2)


def kept_over_a_restart():
    """odometry scale and gyro bias are kept, and a damaged file is as none"""
    with Station(seed=4) as station:
        drive_ahead(station.rest, 10)
        told = station.rest.get("/vehicle")["estimator"]
        arguments = list(station.roverd.process.args)
        data = pathlib.Path(arguments[arguments.index("--data") + 1])
        check(station.roverd.stop(signal.SIGINT) == 0, "it does not end well")
        kept = json.loads((data / "learned.json").read_text())
        check(abs(kept["odometry_scale"] - 0.92) < 0.02, f"slip of 8 % is not seen: {kept}")
        check(abs(kept["odometry_scale"] - told["odometry_scale"]) < 0.01, f"{kept} after {told}")
        check(abs(kept["gyro_bias_dps"] - told["gyro_bias_dps"]) < 0.05, f"{kept} after {told}")

        def again():
            station.roverd = Program(*arguments)
            rest = Rest(station.roverd.wait_line(r"^listening on (http://\S+)")[1])
            return until("the estimator has a place", 20,
                         lambda: rest.get("/vehicle")["estimator"]["odometry_scale"], 0.1)

        begun = again()
        check(abs(begun - kept["odometry_scale"]) < 1e-3, f"it begins with {begun}")
        station.roverd.stop(signal.SIGINT)
        (data / "learned.json").write_text('{"vehicle": ')
        begun = again()
        check(abs(begun - 1.0) < 0.02, f"it begins with {begun}")


sys.exit(run_cases([kept_over_a_restart]))
