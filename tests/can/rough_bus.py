"""What a bus does to a robot in the middle of its mission: full load, strangers, nonsense, an
interface that goes down or away; and the recording of all that. Cases for can_test.py."""

import pathlib
import re
import subprocess
import time

import candump
from station import check, until

FLOOD_ID = 0x5F0
FLOOD_FRAMES = 30_000
LOG_LINE = re.compile(r"^\(\d{10}\.\d{6}\) vcan0 [0-9A-F]{3,8}#[0-9A-FR]* [RT]$")


class RoughBus:
    """@param bus interface name. @param log candump's. @param watch starts candump anew."""

    def __init__(self, station, bus, log, watch):
        self.station = station
        self.bus = bus
        self.log = log
        self.watch = watch
        self.first_loss_s = float("inf")

    def driven_m(self):
        return self.station.control.ask({"get": "truth"})["driven_m"]

    def driver(self):
        return next(d for d in self.station.rest.get("/drivers")["items"] if d["name"] == "bunker")

    def is_running(self):
        return self.station.rest.get("/vehicle")["mission"]["state"] == "running"

    def conditions(self):
        return {condition["id"] for condition in self.station.rest.get("/vehicle")["safety"]}

    def drives_on(self, seconds=60, way_m=1.0):
        begin = self.driven_m()
        until(f"the robot drives {way_m} m on", seconds, lambda: self.driven_m() > begin + way_m, 0.3)

    def recordings(self):
        """In the order in which they were written: the first has no number, NAME.log, NAME.001.log."""
        folder = pathlib.Path(self.log).parent / "data/recordings"
        return sorted(folder.glob("*-bunker*.log"), key=lambda file: file.name.removesuffix(".log"))

    def a_full_bus_does_not_stop_the_robot(self):
        """a bus full of somebody else's frames (cangen -g 0) neither stops nor disturbs the robot"""
        self.go_on()
        begin, driven, received = time.time(), self.driven_m(), self.driver()["received"]
        # vcan has no bit rate: a sender takes all the processor there is. As another node on a bus
        # would, it leaves that of the robot alone and fills every moment that is left.
        subprocess.run(["nice", "-n", "19", "cangen", self.bus, "-g", "0", "-I", f"{FLOOD_ID:03X}", "-L", "8", "-D", "r",
                        "-n", str(FLOOD_FRAMES), "-p", "10"], check=True, timeout=60)
        end = time.time()
        check(self.driver()["state"] == "up", f"the driver is {self.driver()}")
        check(self.driver()["received"] > received, "no own frame was heard under load")
        frames = candump.read(self.log)
        if not self.is_running():  # right only if the base itself found no time to speak
            silence_s = candump.longest_gap_s(candump.only(frames, 0x221, begin, end))
            check(silence_s > 0.3, f"paused, though the base was heard at least every {silence_s:.2f} s: "
                  f"{self.station.rest.get('/vehicle')['mission']}")
        gap_s = candump.longest_gap_s(candump.only(frames, 0x111, begin, end))
        check(gap_s < 0.5, f"the commands pause for {gap_s:.2f} s under load")
        self.go_on()
        print(f"# {FLOOD_FRAMES} foreign frames in {end - begin:.1f} s, "
              f"{FLOOD_FRAMES / (end - begin):.0f}/s; the robot drove {self.driven_m() - driven:.1f} m")

    def strangers_are_counted_and_change_nothing(self):
        """foreign ids, wrong lengths, remote, extended, error and FD frames change nothing"""
        self.go_on()
        refused = self.driver()["refused"]
        for frame in ("123#R", "211#R", "241#R8", "7FF#", "123#DEADBEEF", "00000211#0201000000000000",
                      "00000241#A600000000000000", "20000020#0000000000000000", "123##1AABBCCDD",
                      "211##10201000000000000", "211#0201", "241#A6", "221#", "221#03E8",
                      "211#0001FFFF00000000", "221#7D00000000000000", "20000040#0000000000000000"):
            subprocess.run(["cansend", self.bus, frame], check=True)
        until("the short frames are counted as refused", 10,
              lambda: self.driver()["refused"] >= refused + 4, 0.2)
        wanted = ("remote frame", "extended id", "error frame", "unknown id 0x7FF", "0x211 too short",
                  "0x221 too short", "0x241 too short", "impossible value in 0x211: battery 6553.5 V",
                  "impossible value in 0x221: speed 32 m/s", "CAN FD frame", "CAN error: bus off")
        until(f"every cause is named, in {self.driver()['counts']}", 10,
              lambda: all(self.driver()["counts"].get(cause, 0) >= 1 for cause in wanted), 0.3)
        vehicle = self.station.rest.get("/vehicle")
        check(vehicle["control"] != "rc", "an extended or short frame passed for the radio")
        check(self.driver()["state"] == "up" and self.is_running(),
              f"{self.driver()}, {vehicle['mission']}, {vehicle['safety']}")
        self.drives_on()

    def a_second_commander_makes_the_robot_hold(self):
        """somebody else's 0x111 (cansend) while roverd drives: a hazard, an event, and the robot holds"""
        self.go_on()
        theirs = "111#0096000000000000"
        begin = time.time()

        def hazards():
            subprocess.run(["cansend", self.bus, theirs], check=True)
            return self.driver()["hazards"]
        named = until("the driver lists the hazard", 20, hazards, 0.1)
        check(any("somebody else sends motion commands (0x111)" in h for h in named), f"hazards {named}")
        # It stays for a second after the last foreign command: the robot is asked meanwhile.
        vehicle = self.station.rest.get("/vehicle")
        check(any(c["id"] == "driver_hazard" for c in vehicle["safety"]), f"safety {vehicle['safety']}")
        check(vehicle["mission"]["state"] == "paused", f"the mission is {vehicle['mission']}")
        check(self.driver()["counts"].get("somebody else's command 0x111", 0) >= 1, f"{self.driver()['counts']}")
        until("an event tells it", 10, lambda: any(
            e["kind"] == "mission_paused" and "0x111" in e["detail"]
            for e in self.station.rest.get("/events?level=warning&limit=200")["items"]), 0.3)
        time.sleep(1.0)
        quiet = time.time()
        time.sleep(1.0)
        ours = [f for f in candump.only(candump.read(self.log), 0x111, quiet)
                if candump.moves(f) and f.data.hex() != theirs.split("#")[1].lower()]
        check(not ours, f"{len(ours)} moving commands beside the stranger's, first {ours[:1]}")
        check(time.time() - begin < 60, "the case took too long to mean anything")
        until("the hazard is over", 20, lambda: not self.driver()["hazards"], 0.3)
        self.go_on()

    def lose_and_return(self, lose, give_back):
        """@param lose, give_back commands."""
        self.go_on()
        self.first_loss_s = min(self.first_loss_s, time.time())
        lose()
        until("the driver is not up, and names the interface", 20, lambda: (
            lambda d: d["state"] != "up" and f"CAN interface {self.bus}" in d["reason"])(self.driver()), 0.1)
        until("a safety condition says that the bus is gone", 20, lambda: "base_lost" in self.conditions(), 0.2)
        time.sleep(1.0)
        stood = self.driven_m()
        time.sleep(1.0)
        moved = self.driven_m() - stood
        check(moved < 0.02, f"the robot drives {moved:.2f} m without its bus")
        give_back()
        until("the driver is up again", 40, lambda: self.driver()["state"] == "up", 0.2)
        # A loop that is late is this slow kernel's fault, and told rightly.
        until("nothing is wrong any more", 20, lambda: not self.conditions() - {"loop_late"}, 0.2)
        self.go_on()

    def go_on(self):
        """Whatever the loss made of the mission: with the operator's word it goes on."""
        if not self.is_running():
            until("the robot is armed again", 60,
                  lambda: self.station.rest.get("/vehicle")["armed"] or self.station.rest.call(
                      "POST", "/vehicle/arm", {"valid_for_s": 5})[0] == 200, 0.5)
            until("the mission goes on", 30, lambda: self.is_running() or self.station.rest.call(
                "POST", "/execution/resume", {"valid_for_s": 5})[0] == 200, 0.5)
        self.drives_on()

    def the_interface_goes_down_and_comes_back(self):
        """an interface set down while driving stops the robot; it is used again when it is up"""
        self.lose_and_return(
            lambda: subprocess.run(["ip", "link", "set", self.bus, "down"], check=True),
            lambda: subprocess.run(["ip", "link", "set", self.bus, "up"], check=True))

    def the_interface_is_unplugged_and_plugged_in_again(self):
        """an interface removed while driving stops the robot; the new one is taken into use"""
        def plug_in():
            for words in (f"add dev {self.bus} type vcan", f"set {self.bus} mtu 72",
                          f"set {self.bus} up"):
                subprocess.run(["ip", "link", *words.split()], check=True)
            self.watch()
        self.lose_and_return(
            lambda: subprocess.run(["ip", "link", "delete", self.bus], check=True), plug_in)

    def the_recording_goes_on_in_a_second_file(self):
        """a full recording goes on in a second file"""
        def more_frames():  # of the flood before, a slow kernel may have lost most
            subprocess.run(["cangen", self.bus, "-g", "1", "-I", f"{FLOOD_ID:03X}", "-L", "8", "-D", "r",
                            "-n", "1000"], check=True, timeout=60)
        until("the recording goes on in a second file of at most 1 MB", 120,
              lambda: len(self.recordings()) > 1 or more_frames(), 0.2)

    def the_recording_is_whole(self):
        """every file of the recording ends with a whole line"""
        files = self.recordings()
        for file in files:
            text = file.read_text(encoding="ascii")
            check(text.endswith("\n"), f"{file.name} ends in the middle of a line")
            check(len(text) <= 1_000_000, f"{file.name} has {len(text)} bytes")
            wrong = [line for line in text.splitlines() if not LOG_LINE.match(line)]
            check(not wrong, f"{file.name}: {wrong[:2]}")

    def nothing_of_the_base_is_missing_in_the_recording(self):
        """every 0x221 that candump saw up to the first loss was heard by roverd, load or not"""
        lines = [line for file in self.recordings() for line in open(file, encoding="ascii")]
        heard = [line.split("#")[1].split()[0] for line in lines if " 221#" in line and "R\n" in line]
        seen = [f.data.hex().upper() for f in candump.only(candump.read(self.log), 0x221, 0.0,
                                                              self.first_loss_s)
                if len(f.data) == 8]
        heard = [data for data in heard if len(data) == 16]
        # Both began at another moment, and a standing robot's frames are all the same: compared from
        # the first that moves.
        first = next(i for i, data in enumerate(heard) if data.strip("0"))
        heard = heard[first:]
        start = next((i for i in range(len(seen)) if seen[i:i + 20] == heard[:20]), None)
        check(start is not None, "the beginning of the recording is not in candump's log")
        both = min(len(seen) - start, len(heard))
        check(both > 250, f"only {both} frames 0x221")  # five seconds, however quick the cases before were
        other = next((i for i in range(both) if seen[start + i] != heard[i]), None)
        check(other is None, f"they differ at frame {other} of {both} ({len(seen)} seen, {len(heard)} "
                             f"heard): seen {seen[start + (other or 0):][:4]}, "
                             f"heard {heard[other or 0:][:4]}")
        print(f"# {both} frames 0x221 compared")

    def canplayer_plays_the_recording(self):
        """can-utils' canplayer plays a recording of roverd back, frame by frame"""
        part = self.recordings()[0].with_name("part.log")
        lines = self.recordings()[0].read_text(encoding="ascii").splitlines(True)[:2000]
        part.write_text("".join(lines), encoding="ascii")
        replayed = part.with_name("replayed.txt")
        with open(replayed, "w", encoding="ascii") as out:
            watcher = subprocess.Popen(["candump", "-L", "-r", "8000000", "-n", str(len(lines)), "-T", "8000",
                                        f"{self.bus},0:0,#FFFFFFFF"], stdout=out)  # error frames, too
            time.sleep(0.5)
            subprocess.run(["canplayer", "-I", part], check=True, timeout=60)
            watcher.wait(30)
        got = [line.split()[2] for line in open(replayed, encoding="ascii")]
        wanted = [line.split()[2] for line in lines]
        check(got == wanted, f"{len(got)} frames of {len(wanted)}, "
                             f"first other one {[p for p in zip(wanted, got) if p[0] != p[1]][:1]}")
