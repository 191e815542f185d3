#!/usr/bin/env python3
"""Power cuts: roverd is killed (SIGKILL) at random moments while missions are saved, and started
again. The database opens, every acknowledged change is there, no half change is, and SQLite's
integrity check passes."""

import http.client
import json
import pathlib
import random
import shutil
import sqlite3
import sys
import tempfile
import threading
import time
import urllib.parse

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
from station import BIN, ROOT, Program, Rest, check, run_cases  # noqa: E402

SEED = 20260301
SAVES = 200
ITEMS = 200


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
    """Saves one mission after another until the server is gone. Another kind of recording (a way
    taught while driving) is one more such class with `acknowledged` and `verify`."""

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


def examine(data, copy, when):
    """A copy of the files, as the cut left them: to open them is to mend them."""
    copy.mkdir()
    for file in data.glob("roverd.db*"):
        shutil.copy(file, copy)
    database = sqlite3.connect(copy / "roverd.db")
    verdict = database.execute("PRAGMA integrity_check").fetchall()
    strays = database.execute("PRAGMA foreign_key_check").fetchall()
    database.close()
    shutil.rmtree(copy)
    check(verdict == [("ok",)] and not strays, f"{when}: {verdict[:3]} {strays[:3]}")


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


if __name__ == "__main__":
    sys.exit(run_cases([saves_survive_power_cuts]))
