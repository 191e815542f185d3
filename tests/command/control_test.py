#!/usr/bin/env python3
"""Who has control, with the real programs: two scripts, one token from two addresses, a script that dies."""

import csv
import http.client
import io
import json
import pathlib
import sys
import urllib.parse

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
from station import Station, check, reset_stop, run_cases, until  # noqa: E402

GRACE_S = 3
PASSWORD = "four tractors in a barn"


class Caller:
    """A script with a token, from an address of this machine."""

    def __init__(self, station, token, source="127.0.0.1"):
        self.host = urllib.parse.urlsplit(station.address).netloc
        self.token = token
        self.source = source

    def call(self, method, path, body=None):
        connection = http.client.HTTPConnection(self.host, timeout=30, source_address=(self.source, 0))
        try:
            headers = {"Authorization": f"Bearer {self.token}", "Host": self.host}
            if body is not None:
                headers["Content-Type"] = "application/json"
            connection.request(method, "/api/v1" + path, None if body is None else json.dumps(body), headers)
            answer = connection.getresponse()
            text = answer.read()
            is_json = "json" in (answer.getheader("Content-Type") or "")
            return answer.status, json.loads(text) if text and is_json else text.decode()
        finally:
            connection.close()

    def do(self, method, path, body=None, status=200):
        got, answer = self.call(method, path, body)
        check(got == status, f"{method} {path} answers {got}, not {status}: {answer}")
        return answer


def begin(station):
    """The first admin, and two scripts of hers. @return the scripts' callers and the watcher"""
    code = station.roverd.wait_line(r" with the code (\S+)$")[1]
    status, headers, answer = station.rest.call(
        "POST", "/setup", {"code": code, "user": "anna", "password": PASSWORD, "device": "laptop"})
    check(status == 200, f"the first admin is refused: {answer}")
    cookie = headers["Set-Cookie"].split(";")[0]
    shown = {"Cookie": cookie, "Origin": station.address}
    tokens = [station.rest.do("POST", "/tokens", {"name": name, "role": role}, shown)["token"]
              for name, role in (("rows", "operator"), ("patrol", "operator"), ("watch", "viewer"))]
    return [Caller(station, token) for token in tokens]


def holder_of(watch):
    holder = watch.do("GET", "/control")["holder"]
    return holder and holder["name"]


def events_of(watch):
    return [event["kind"] for event in watch.do("GET", "/events?limit=1000")["items"]]


def one_drives():
    """one script drives, the other is refused with the holder's name, asks, is refused, and takes it by force"""
    with Station(arguments=settings()) as station:
        rows, patrol, watch = begin(station)
        check(rows.do("POST", "/vehicle/estop/reset", {}, 403)["type"].endswith("control"), "nobody has it")
        rows.do("POST", "/control/take", {})
        refused = patrol.do("POST", "/vehicle/move", {"forward_m": 1}, 403)
        check(refused["holder"]["name"] == "rows", f"the refusal names {refused['holder']}")
        check(patrol.do("POST", "/control/take", {}, 409)["holder"]["name"] == "rows", "409 names another")
        request = patrol.do("POST", "/control/take", {"ask": True}, 202)["requests"][0]["request"]
        rows.do("POST", "/control/handover", {"accept": False, "to": request})
        check(holder_of(watch) == "rows", "control went although it was refused")
        patrol.do("POST", "/control/take", {"force": True}, 422)
        patrol.do("POST", "/control/take", {"force": True, "reason": "a cow on the way"})
        check(holder_of(watch) == "patrol", "force did not take it")
        rows.do("PUT", "/vehicle/mode", {"mode": "HOLD"})  # anyone may stop
        watch.do("POST", "/vehicle/estop", {})
        rows.do("POST", "/vehicle/estop/reset", {}, 403)
        reset_stop(patrol)
        check("control_forced" in events_of(watch), "force is no event")


def one_token_twice():
    """the same token from two addresses is two drivers"""
    with Station(arguments=settings()) as station:
        rows, _, watch = begin(station)
        twin = Caller(station, rows.token, "127.0.0.2")
        rows.do("POST", "/control/take", {})
        check(rows.do("GET", "/control")["mine"] is True, "it is not the holder's own")
        check(twin.do("GET", "/control")["mine"] is False, "it is the twin's, too")
        twin.do("POST", "/vehicle/estop/reset", {}, 403)
        twin.do("POST", "/control/take", {}, 409)
        check(holder_of(watch) == "rows", "nobody has it")


def a_mission_goes_on():
    """a script that starts a mission and dies loses control after the grace; the mission goes on"""
    with Station(arguments=settings()) as station:
        rows, patrol, watch = begin(station)
        here = until("a fix", 60, lambda: ready(watch))
        rows.do("POST", "/control/take", {})
        items = [{"type": "waypoint", "lat": here["lat"] + north, "lon": here["lon"]} for north in (0.0002, 0.0004)]
        mission = rows.do("POST", "/missions", {"name": "out", "items": items}, 201)
        rows.do("POST", "/execution/load", {"mission_id": mission["id"]})
        rows.do("POST", "/vehicle/arm", {"valid_for_s": 5})
        start = {"mission_id": mission["id"], "revision": mission["revision"], "from": "first", "valid_for_s": 5}
        rows.do("POST", "/execution/start", start)
        # Now rows says nothing any more.
        check(holder_of(watch) == "rows", "it lost control at once")
        until("control is free", GRACE_S + 5, lambda: holder_of(watch) is None)
        check(watch.do("GET", "/execution")["state"] == "running", "the mission did not go on")
        check("control_lost" in events_of(watch), "that is no event")
        until("it drives", 20, lambda: watch.do("GET", "/vehicle")["position"]["speed_mps"] > 0.4, 0.1)
        patrol.do("POST", "/execution/pause", {})  # anyone may stop
        # How it came to rest is in the record of the run.
        until("the run tells of its standing", 10, lambda: abs(run_speeds(watch)[-1]) < 0.02)
        slowing = [v for v in run_speeds(watch)[-8:] if 0.05 < v < 0.35]
        check(slowing, f"nothing is kept of its braking: {run_speeds(watch)[-8:]}")
        patrol.do("POST", "/execution/resume", {"valid_for_s": 5}, 403)
        patrol.do("POST", "/control/take", {})
        patrol.do("POST", "/execution/resume", {"valid_for_s": 5})


def run_speeds(watch):
    rows = csv.DictReader(io.StringIO(watch.do("GET", "/runs/1/track?format=csv")))
    return [float(row["speed_mps"]) for row in rows]


def ready(watch):
    if not watch.do("GET", "/vehicle/checks")["ready"]:
        return None
    position = watch.do("GET", "/vehicle")["position"]
    return position if position["lat"] is not None else None


def settings():
    return ("--set", "server.access=true", "--set", f"server.control_grace_s={GRACE_S}")


def without_access():
    """without access control nobody is asked"""
    with Station() as station:
        control = station.rest.get("/control")
        check(control["on"] is False and control["mine"] is True, f"it is {control}")
        station.rest.do("POST", "/control/take", {})
        station.rest.do("POST", "/vehicle/estop", {})
        reset_stop(station.rest)


if __name__ == "__main__":
    sys.exit(run_cases([one_drives, one_token_twice, a_mission_goes_on, without_access]))
