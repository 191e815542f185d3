#!/usr/bin/env python3
"""Power cuts: roverd is killed (SIGKILL) at random moments while missions are saved and while a
driven way is recorded, and started again. The database opens, every acknowledged change is there, no
half change is, and SQLite's integrity check passes; of a recording at most the last second is lost."""

import http.client
import json
import pathlib
import random
import shutil
import signal
import sys
import tempfile
import threading
import time
import urllib.parse

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
from cuts import examine  # noqa: E402
from station import BIN, ROOT, Program, Rest, Station, check, run_cases, until  # noqa: E402

SEED = 20260301
SAVES = 200
ITEMS = 200
RECORDING_CUTS = 6
# Points go to the disk once a second; the rest is what this machine may be late.
LOST_S = 1.0 + 0.5


def start(data):
    """roverd without robot: the store is what is cut."""
    roverd = Program(BIN / "roverd", "--config", ROOT / "config/robot.toml", "--data", data, "--port", "0",
                     "--set", "drivers.bunker.enabled=false", "--set", "drivers.gnss.enabled=false")
    return roverd, roverd.wait_line(r"^listening on (http://\S+)")[1]


def items_of(number):
    """Items that tell which save they are of: half of one and half of another is seen."""
    return [{"type": "waypoint", "lat": 58.0 + number * 1e-6, "lon": 26.0 + i * 1e-6} for i in range(ITEMS)]


def save_of(body):
    """The save that a mission's state is of; a mixed one is none."""
    numbers = {round((item["lat"] - 58.0) * 1e6) for item in body["items"]}
    check(len(body["items"]) == ITEMS and len(numbers) == 1, f"a half change: {numbers}")
    number = numbers.pop()
    check(body["name"] == f"save {number}", f"{body['name']} holds the items of save {number}")
    return number


class Writer:
    """Saves one mission after another until the server is gone."""

    def __init__(self, address, first):
        self.connection = http.client.HTTPConnection(urllib.parse.urlparse(address).netloc, timeout=20)
        self.next = first
        self.acknowledged = []  # (mission, revision, save), in order
        self.present = None     # (mission, revision)
        self.thread = threading.Thread(target=self._run, daemon=True)
        self.thread.start()

    def _run(self):
        try:
            while True:
                self._save()
        except (OSError, http.client.HTTPException, ValueError):
            return  # killed

    def _save(self):
        number = self.next
        self.next += 1
        body = json.dumps({"name": f"save {number}", "items": items_of(number)})
        headers = {"Content-Type": "application/json"}
        method, path = "POST", "/api/v1/missions"
        if number % 5 != 0 and self.present:  # four times out of five a new revision
            method, path = "PUT", f"{path}/{self.present[0]}"
            headers["If-Match"] = f'"rev-{self.present[1]}"'
        self.connection.request(method, path, body, headers)
        answer = self.connection.getresponse()
        text = answer.read()
        if answer.status not in (200, 201):
            raise ValueError(answer.status)
        stored = json.loads(text)
        self.present = (stored["id"], stored["revision"])
        self.acknowledged.append((stored["id"], stored["revision"], number))


def verify(address, acknowledged):
    rest = Rest(address)
    newest = {}
    for mission, revision, number in acknowledged:
        newest[mission] = max(newest.get(mission, 0), revision)
        body = rest.get(f"/missions/{mission}/revisions/{revision}")
        check(save_of(body) == number, f"revision {revision} of {mission} is another save than {number}")
    for mission, revision in newest.items():
        body = rest.get(f"/missions/{mission}")
        save_of(body)
        # The save under way when the power went may have come on top, whole.
        check(revision <= body["revision"] <= revision + 1, f"{mission} is at {body['revision']}, not {revision}")
    listed, cursor = 0, ""
    while cursor is not None:
        page = rest.get(f"/missions?limit=500&cursor={cursor}")
        listed += len(page["items"])
        cursor = page["next_cursor"]
    return listed


def saves_survive_power_cuts():
    """200 saves, the power cut at random moments: what was acknowledged is there, and nothing by halves"""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="roverd-power."))
    data = folder / "data"
    data.mkdir()
    chance = random.Random(SEED)
    acknowledged, cuts, number = [], 0, 1
    try:
        while len(acknowledged) < SAVES:
            roverd, address = start(data)
            writer = Writer(address, number)
            enough = min(chance.randint(0, 40), SAVES - len(acknowledged))
            while len(writer.acknowledged) < enough and writer.thread.is_alive():
                time.sleep(0.0005)
            time.sleep(chance.random() * 0.01)
            roverd.process.kill()
            roverd.process.wait()
            writer.thread.join(20)
            acknowledged += writer.acknowledged
            number = writer.next
            cuts += 1
            examine(data, folder / f"copy{cuts}", f"after cut {cuts}")
        roverd, address = start(data)
        listed = verify(address, acknowledged)
        missions = len({mission for mission, _, _ in acknowledged})
        check(missions <= listed <= missions + cuts, f"{listed} missions for {missions} acknowledged ones")
        check(roverd.stop() == 0, f"ends with {roverd.said()}")
        check(cuts >= 5, f"only {cuts} cuts")
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def after_a_cut(station, copy, when):
    """Kills roverd, looks at what it left, starts it again on the same robot, which drives on."""
    arguments = list(station.roverd.process.args)
    station.roverd.stop(signal.SIGKILL)
    cut = time.monotonic()
    examine(station.scratch / "data", copy, when)
    station.roverd = Program(*arguments)
    station.rest = Rest(station.roverd.wait_line(r"^listening on (http://\S+)")[1])
    until("the store answers", 20, lambda: station.rest.call("GET", "/teach")[0] == 200, 0.02)
    return cut


def recorded(rest):
    """Points that are on the disk, and all of them."""
    teach = rest.get("/teach")
    return teach["points"] - teach["unsaved_points"], teach["points"]


def watch(rest, seconds):
    """When how many points were recorded, and how many were on the disk for certain."""
    seen, kept, end = [], 0, time.monotonic() + seconds
    while time.monotonic() < end:
        saved, points = recorded(rest)
        seen.append((time.monotonic(), points))
        kept = max(kept, saved)
        time.sleep(0.02)
    return seen, kept


def recordings_survive_power_cuts():
    """a way recorded through six power cuts: each takes its last second at most, the rest is a mission"""
    chance = random.Random(SEED)
    with Station(seed=5) as station:
        until("the checks are fine", 60, lambda: station.rest.get("/vehicle/checks")["ready"], 0.2)
        # The radio drives, which the simulated robot obeys by itself: also without roverd.
        station.control.ask({"radio": {"swb": "middle", "right_ud": 0.5}})
        station.rest.do("POST", "/teach/start", {"name": "cut", "step_m": 0.1})
        before = 0
        for cut in range(1, RECORDING_CUTS + 1):
            until("it is recorded", 60, lambda: recorded(station.rest)[1] > before + 2, 0.05)
            seen, kept = watch(station.rest, chance.uniform(0.2, 3.0))
            killed = after_a_cut(station, station.scratch / f"copy{cut}", f"recording, cut {cut}")
            found = station.rest.get("/teach")
            check(found["state"] == "interrupted" and found["name"] == "cut", f"after cut {cut}: {found}")
            least = max([points for at, points in seen if at < killed - LOST_S], default=before)
            check(found["points"] >= max(least, kept),
                  f"cut {cut}: {found['points']} points, {kept} were saved, {least} are older than {LOST_S} s")
            check(found["gaps"] <= cut - 1, f"{found['gaps']} gaps after {cut} cuts")
            before = found["points"]
            station.rest.do("POST", "/teach/resume")
        until("it goes on", 60, lambda: recorded(station.rest)[1] > before + 2, 0.05)
        points = recorded(station.rest)[1]
        check(station.rest.get("/teach")["gaps"] >= 1, "nothing tells where the recording was cut")
        made = station.rest.do("POST", "/teach/stop", {"tolerance_m": 0})
        check(len(made["items"]) >= points, f"{len(made['items'])} items of {points} points")
        after_a_cut(station, station.scratch / "copy", "after the recording")
        check(station.rest.get("/teach")["state"] == "idle", "the recording is still there")
        stored = station.rest.get(f"/missions/{made['id']}")
        check(stored["items"] == made["items"], "the mission is another one after the cut")


if __name__ == "__main__":
    sys.exit(run_cases([saves_survive_power_cuts, recordings_survive_power_cuts]))
