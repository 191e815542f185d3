#!/usr/bin/env python3
"""A data folder that is removed, a database that is damaged, a second roverd for the same robot: what
is not kept is not said to be, the robot can be stopped and driven by hand, and the page knows why. And
what a service manager hears of it all; and what goes when recordings take too much room."""

import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
from station import BIN, Program, Rest, Station, check, make_large, reset_stop, run_cases, until  # noqa: E402

PLAN = {"name": "kept", "items": [{"type": "waypoint", "lat": 58.0, "lon": 26.0 + i * 1e-5} for i in range(50)]}


def ids(items):
    return [one["id"] for one in items]


def arguments_of(station, data):
    out = list(station.roverd.process.args)
    out[out.index("--data") + 1] = str(data)
    return out


def drives_by_hand(rest, station):
    """Armed, held by the stick's stream or a move: here by a move of one metre."""
    until("the checks pass", 60, lambda: rest.get("/vehicle/checks")["ready"], 0.2)
    until("it arms", 20, lambda: rest.call("POST", "/vehicle/arm", {"valid_for_s": 5})[0] == 200, 0.5)
    before = station.control.ask({"get": "truth"})["driven_m"]
    rest.do("POST", "/vehicle/move", {"forward_m": 1.0, "valid_for_s": 5})
    until("it moves", 20, lambda: station.control.ask({"get": "truth"})["driven_m"] > before + 0.3, 0.1)
    rest.do("POST", "/vehicle/estop")
    time.sleep(1.0)
    stood = station.control.ask({"get": "truth"})["driven_m"]
    time.sleep(0.5)
    moved = station.control.ask({"get": "truth"})["driven_m"] - stood
    check(moved < 0.02, f"it drove {moved:.2f} m after the stop")
    reset_stop(rest)


def a_removed_data_folder():
    """without its data folder nothing is said to be saved, and a second roverd is refused"""
    with Station(seed=5) as station:
        rest, data = station.rest, station.scratch / "data"
        rest.do("POST", "/missions", PLAN)
        health = rest.get("/health")
        check(health["status"] == "ok", f"health {health}")
        shutil.rmtree(data)
        status, _, body = rest.call("POST", "/missions", PLAN)
        check(status == 503, f"a mission saved into nothing answers {status}: {body}")
        check(str(data) in body["detail"] and "removed" in body["detail"], f"it says {body}")
        until("GET /health says so", 10, lambda: "storage_failed" in ids(rest.get("/health")["problems"]), 0.2)
        check(rest.get("/health")["status"] == "degraded", f"health {rest.get('/health')}")
        until("safety says so", 10, lambda: "storage_failed" in ids(rest.get("/vehicle")["safety"]), 0.2)
        computer = next(c for c in rest.get("/vehicle/checks")["checks"] if c["id"] == "computer")
        check(not computer["ok"] and "removed" in computer["detail"], f"the check says {computer}")
        second = subprocess.run(arguments_of(station, station.scratch / "other"), capture_output=True, text=True,
                                timeout=60, check=False)
        check(second.returncode == 1, f"a second roverd ends with {second.returncode}: {second.stderr}")
        check(f"another roverd (process {station.roverd.process.pid}) drives this robot" in second.stderr,
              f"it says {second.stderr!r}")
        drives_by_hand(rest, station)


def a_damaged_database():
    """a damaged database is set aside, and the robot can be driven and stopped"""
    with Station(seed=6) as station:
        data = station.scratch / "data"
        station.rest.do("POST", "/missions", PLAN)
        station.roverd.stop(signal.SIGKILL)
        database = data / "roverd.db"
        for part in ("-wal", "-shm"):
            pathlib.Path(str(database) + part).unlink(missing_ok=True)
        size = database.stat().st_size
        database.write_bytes(b"\0" * size)
        station.roverd = Program(*arguments_of(station, data))
        station.rest = rest = Rest(station.roverd.wait_line(r"^listening on (http://\S+)")[1])
        check((data / "roverd.db.damaged-1").stat().st_size == size, "the damaged file is not kept")
        told = until("an event tells it", 10, lambda: [
            e for e in rest.get("/events?level=error&limit=50")["items"] if e["kind"] == "database_rescued"], 0.2)
        check("there is no backup" in told[0]["detail"], f"the event says {told}")
        rest.do("POST", "/missions", PLAN)
        drives_by_hand(rest, station)


def backed_up(data):
    """@return the names of what counts as a backup"""
    return sorted(file.name for file in (data / "backups").glob("roverd-*.db"))


def a_backup_by_hand():
    """a backup can be made while roverd runs, has what was acknowledged, and is refused where there is none"""
    with Station(seed=9) as station:
        data = station.scratch / "data"
        made = station.rest.do("POST", "/missions", PLAN)
        done = subprocess.run([BIN / "roverd", "backup", "--data", data], capture_output=True, text=True,
                              timeout=60, check=False)
        check((done.returncode, done.stdout) == (0, f"{data}/backups/roverd-000001.db\n"), f"it says {done}")
        station.roverd.stop()
        shutil.copy(data / "backups/roverd-000001.db", data / "roverd.db")
        station.roverd = Program(*arguments_of(station, data))
        rest = Rest(station.roverd.wait_line(r"^listening on (http://\S+)")[1])
        check(rest.get(f"/missions/{made['id']}")["name"] == "kept", "the mission is not in the copy")
    done = subprocess.run([BIN / "roverd", "backup", "--data", "/nowhere"], capture_output=True, text=True,
                          timeout=60, check=False)
    check(done.returncode == 1 and done.stderr.startswith("roverd: backup: /nowhere/backups: "), f"it says {done}")


def a_backup_that_fails():
    """a backup that cannot be made is told as an event"""
    with tempfile.TemporaryDirectory() as folder:
        data = pathlib.Path(folder, "data")
        data.mkdir()
        (data / "backups").write_text("in the way")
        with Station(seed=10, data=data, arguments=("--set", "backups.first_s=1")) as station:
            told = until("an event tells it", 30, lambda: [
                e for e in station.rest.get("/events?level=warning&limit=50")["items"] if e["kind"] == "backup_failed"],
                0.1)
            check(told[0]["detail"].startswith("no backup could be made: roverd ended with exit code 1: roverd: backup: ")
                  and str(data / "backups") in told[0]["detail"], f"it says {told}")


def stat_of(pid):
    """What /proc tells of it after its name; empty: there is none."""
    try:
        return pathlib.Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rsplit(")", 1)[1].split()
    except OSError:
        return []


def held_by(pid):
    """The files behind its descriptors, but for what it is told and says."""
    try:
        return {os.readlink(link) for link in pathlib.Path(f"/proc/{pid}/fd").iterdir() if int(link.name) > 2}
    except OSError:
        return set()


def child_at_work(pid):
    """The backup that roverd has started, half through; 0: there is none yet."""
    for children in pathlib.Path(f"/proc/{pid}/task").glob("*/children"):
        for child in children.read_text(encoding="ascii").split():
            if any(name.endswith("/backups/unfinished") for name in held_by(child)):
                return int(child)
    return 0


def a_backup_that_is_cut_off():
    """a backup in progress holds nothing of roverd's, dies with it, and does not count"""
    with tempfile.TemporaryDirectory() as folder:
        data = pathlib.Path(folder, "data")
        with Station(seed=11, data=data):
            pass
        make_large(data / "roverd.db", 200)
        with Station(seed=11, data=data, arguments=("--set", "backups.first_s=2")) as station:
            child = until("a backup is being made", 60, lambda: child_at_work(station.roverd.process.pid), 0.002)
            os.kill(child, signal.SIGSTOP)
            held = held_by(child)
            check(all(name.startswith(f"{data}/") for name in held), f"it holds {held}")
            check(stat_of(child)[16] == "19", f"its nice value is {stat_of(child)[16]}")
            station.roverd.stop(signal.SIGKILL)
            until("it is gone", 20, lambda: stat_of(child)[:1] in ([], ["Z"]))  # who inherits it may be slow
            check(backed_up(data) == [], f"half a copy counts: {backed_up(data)}")
            arguments = arguments_of(station, data)
            arguments[-1] = "backups.first_s=0"
            station.roverd = Program(*arguments)
            until("the next one is made", 60, lambda: backed_up(data) == ["roverd-000001.db"])
            check(not (data / "backups/unfinished").exists(), "half a copy is left")


def a_service_manager():
    """a service manager hears that roverd serves, lives and stops"""
    with tempfile.TemporaryDirectory() as folder, socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as manager:
        manager.bind(f"{folder}/notify")
        manager.settimeout(10)
        os.environ.update(NOTIFY_SOCKET=f"{folder}/notify", WATCHDOG_USEC="300000")
        try:
            with Station(seed=7) as station:
                check(manager.recv(999).decode() == f"READY=1\nSTATUS=serving {station.address}", "not ready")
                begin = time.monotonic()
                for _ in range(5):
                    check(manager.recv(999) == b"WATCHDOG=1", "no sign of life")
                passed_s = time.monotonic() - begin
                check(0.3 < passed_s < 2.0, f"five signs of life in {passed_s:.2f} s, wanted one each 0.1 s")
                station.roverd.stop()
                while (word := manager.recv(999)) == b"WATCHDOG=1":
                    pass
                check(word == b"STOPPING=1", f"the last word is {word}")
        finally:
            del os.environ["NOTIFY_SOCKET"], os.environ["WATCHDOG_USEC"]


def old_recordings():
    """recordings of earlier starts go by their room, and an event says so; the one being written stays"""
    with tempfile.TemporaryDirectory() as folder:
        data = pathlib.Path(folder, "data")
        recordings = data / "recordings"
        recordings.mkdir(parents=True)
        for day in range(1, 4):
            file = recordings / f"2026030{day}T120000Z-bunker.log"
            file.write_bytes(b"x" * 600_000)
            os.utime(file, (day * 86400 + 1_772_000_000,) * 2)
        (recordings / "notes.txt").write_bytes(b"x" * 2_000_000)
        with Station(seed=8, data=data, arguments=("--record", "--set", "recording.total_mb=1")) as station:
            told = until("an event tells it", 20, lambda: [
                e for e in station.rest.get("/events?limit=500")["items"] if e["kind"] == "recordings_removed"], 0.1)
            check("2 recordings, 20260301T120000Z-bunker.log to 20260302T120000Z-bunker.log, were removed (1.2 MB)"
                  in told[0]["detail"], f"it says {told}")
            names = {file.name for file in recordings.iterdir()}
            check({"notes.txt", "20260303T120000Z-bunker.log"} < names and len(names) >= 4, f"left are {names}")


if __name__ == "__main__":
    sys.exit(run_cases([a_removed_data_folder, a_damaged_database, a_backup_by_hand, a_backup_that_fails,
                        a_backup_that_is_cut_off, a_service_manager, old_recordings]))
