#!/usr/bin/env python3
"""A map is made while the program runs: roverd-sim casts the rays in a building, roverd lays them together and
keeps the map; what cannot be kept is told, and nothing is left over."""

import pathlib
import signal
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from place_test import THINGS  # noqa: E402
from seeing import HEARS_TOP_AND_FRONT, SeeingRobot  # noqa: E402
from station import Program, Rest, check, run_cases, until  # noqa: E402


class Barn(SeeingRobot):
    """The building of place_test.py, of which nobody has a map yet."""

    def __init__(self, more=""):
        super().__init__({"name": "barn", "ground": {"grass_m": 0.0}, "things": THINGS},
                         hears=HEARS_TOP_AND_FRONT + more)

    def maps(self):
        return self.rest.get("/maps")

    def lost(self):
        events = self.rest.get("/events?limit=200")["items"]
        return [e["detail"] for e in events if e["kind"] == "map_trouble" and "being made" in e["detail"]]

    def restart(self):
        arguments = list(self.roverd.process.args)
        self.roverd.stop(signal.SIGKILL)
        self.roverd = Program(*arguments)
        self.rest = Rest(self.roverd.wait_line(r"^listening on (https?://\S+)")[1])


def what_does_not_become_a_map():
    """nothing driven, a disk that refuses, a dropped one and a cut of the power: told, and nothing is left over"""
    with Barn() as barn:
        barn.sees("front", "top")
        folder = barn.scratch / "data/maps"
        check(barn.rest.call("POST", "/maps/stop")[0] == 409, "none is being made")
        barn.rest.do("POST", "/maps/start")
        until("it has looked", 20, lambda: barn.maps()["making"]["scans"] >= 1, 0.1)
        folder.rename(barn.scratch / "aside")
        folder.write_text("no folder")
        status, _, answer = barn.rest.call("POST", "/maps/stop", {"name": "barn"})
        check(status == 503, f"a disk that refuses answers {status}: {answer}")
        trouble = barn.maps()["making"]["trouble"]
        check("not kept yet" in trouble and "maps" in trouble, f"it tells {trouble}")
        folder.unlink()
        (barn.scratch / "aside").rename(folder)
        made = barn.rest.do("POST", "/maps/stop", {"name": "barn"})
        check(made["name"] == "barn" and barn.maps()["making"] is None, f"at last: {made}")
        for path, looked_in in ((f"{made['id']}/use", "barn"), ("unuse", None)) * 3:
            barn.rest.do("POST", f"/maps/{path}")
            place = barn.rest.get("/vehicle")["place"]
            check(place["map"] == looked_in, f"{path} is answered, and it looks in {place}")
        barn.rest.do("POST", "/maps/start")
        barn.rest.do("POST", "/maps/stop", {"discard": True})
        check(barn.maps()["making"] is None and len(barn.maps()["items"]) == 1, f"dropped: {barn.maps()}")
        barn.rest.do("POST", "/maps/start")
        until("it looks", 20, lambda: barn.maps()["making"]["scans"] >= 1, 0.1)
        barn.restart()
        left = barn.maps()
        check(left["making"] is None and [m["name"] for m in left["items"]] == ["barn"], f"after a cut: {left}")
        check(len(barn.lost()) == 1 and "begun at 20" in barn.lost()[0], f"that it is gone is told: {barn.lost()}")
        barn.restart()
        check(len(barn.lost()) == 1, f"once: {barn.lost()}")
        barn.rest.do("POST", "/maps/start")
        barn.roverd.stop(signal.SIGTERM)  # in the middle: it ends in time


if __name__ == "__main__":
    sys.exit(run_cases([what_does_not_become_a_map]))
