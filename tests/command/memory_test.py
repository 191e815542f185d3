#!/usr/bin/env python3
"""What a large request takes is not kept for ever, and a backup takes nothing."""

import pathlib
import random
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "soak"))
import clients  # noqa: E402
import growth  # noqa: E402
from station import Station, check, make_large, run_cases, until  # noqa: E402

POINTS = 20_000
KEPT_KB = 22_000  # 11,000 to 15,000 of small pieces are; with large blocks kept as well it was 31,000
BACKUP_KB = 300  # 20 to 28 are; made in the program itself, by its own heap, 700


def a_large_file():
    """after two large imports most of what they took goes back to the system"""
    with Station(seed=3) as station:
        until("the store answers", 20, lambda: station.rest.call("GET", "/teach")[0] == 200, 0.05)
        before = growth.Sample(station.roverd.process.pid).own_kb
        for _ in range(2):
            status, _, made = station.rest.call(
                "POST", "/missions/import?format=geojson", clients.line_of(POINTS, random.Random(1)),
                {"Content-Type": "application/geo+json"})
            check(status == 201, f"the import answers {status}: {made}")
            mission = made.get("missions", [made])[0]
            check(station.rest.call("GET", f"/missions/{mission['id']}/export?format=kml")[0] == 200, "no export")
            station.rest.do("DELETE", f"/missions/{mission['id']}",
                            headers={"If-Match": f'"rev-{mission["revision"]}"'})
        until("it is given back", 20,
              lambda: growth.Sample(station.roverd.process.pid).own_kb - before < KEPT_KB, 0.5)


def a_backup_of_a_large_database():
    """a backup of 60 MB leaves roverd's own memory as it was"""
    with tempfile.TemporaryDirectory() as folder:
        data = pathlib.Path(folder, "data")
        with Station(seed=4, data=data):
            pass
        make_large(data / "roverd.db", 60)
        with Station(seed=4, data=data, arguments=("--set", "backups.first_s=15")) as station:
            pid, made = station.roverd.process.pid, data / "backups/roverd-000001.db"
            time.sleep(10)  # it begins to drive its loop, which takes some
            check(not made.exists(), "it was made too soon to be measured")
            before = growth.Sample(pid)
            until("a backup is made", 120, made.exists)
            time.sleep(2)
            after = growth.Sample(pid)
            check(made.stat().st_size > 60_000_000, f"it has {made.stat().st_size} bytes")
            check(after.own_kb - before.own_kb < BACKUP_KB, f"it took {after.own_kb - before.own_kb} kB for ever")
            check(after.descriptors <= before.descriptors, f"{before.descriptors} descriptors became {after.descriptors}")


if __name__ == "__main__":
    sys.exit(run_cases([a_large_file, a_backup_of_a_large_database]))
