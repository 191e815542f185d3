#!/usr/bin/env python3
"""roverd and the simulated Bunker on a real CAN interface, judged by what candump saw.

Wants an interface vcan0 that is up, and the right to set it down. Started by tests/can/run.
Usage: can_test.py SCRATCH_FOLDER
"""

import math
import os
import pathlib
import signal
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "harness")]

import candump  # noqa: E402
from rough_bus import RoughBus  # noqa: E402
from station import BIN, ROOT, Failed, Program, Station, check, run_cases, until  # noqa: E402

BUS = "vcan0"
SCRATCH = pathlib.Path(sys.argv[1])
LOG = SCRATCH / "candump.log"

# 0x241, byte 0: SWD SWC SWB SWA, two bits each; 2 up, 1 middle, 3 down. Byte 7 counts the frames.
CAN_DRIVES = 0xAA
TAKES_OVER = 0xA6
RADIO_PERIOD_S = 0.04


def radio_frame(switches, count):
    return f"241#{switches:02X}000000000000{count % 256:02X}"


station = None
moments = {}  # what happened when, by the clock that candump stamps with


def now():
    return time.time()


def wait_frames(frame_id, wanted, seconds, begin_s):
    """Frames of this id since begin_s, as soon as one is wanted."""
    def ask():
        frames = candump.only(candump.read(LOG), frame_id, begin_s)
        return frames if any(map(wanted, frames)) else None
    return until(f"a 0x{frame_id:03X} for which {wanted.__name__} holds on {BUS}", seconds, ask, 0.2)


def on_its_own_computer(process):
    """The base and the radio share one slow processor with roverd here, and roverd's two threads that
    drive come before all ordinary ones. In the field they are other computers: never kept waiting."""
    try:
        os.sched_setscheduler(process.pid, os.SCHED_FIFO, os.sched_param(30))
    except PermissionError:
        pass  # a user namespace of the host, which has processors for all


class Transmitter:
    """The operator's radio, played by can-utils: the simulator's own is switched off. A lever moved
    is one cansend; what follows is canplayer with 256 frames of a running count, again and again."""

    def __init__(self):
        self.process = None

    def play(self, switches):
        recording = SCRATCH / f"radio-{switches:02X}.log"
        with open(recording, "w", encoding="ascii") as log:
            for i in range(256):
                log.write(f"({i * RADIO_PERIOD_S:.6f}) {BUS} {radio_frame(switches, i)}\n")
        before = self.process
        subprocess.run(["cansend", BUS, radio_frame(switches, 255)], check=True)
        self.process = subprocess.Popen(["canplayer", "-I", recording, "-l", "i"],
                                        stdout=subprocess.DEVNULL)
        on_its_own_computer(self.process)
        if before:  # ends last: a silent radio would be another story
            time.sleep(0.4)
            before.terminate()
            before.wait()

    def silence(self):
        if self.process:
            self.process.terminate()
            self.process.wait()
            self.process = None


radio = Transmitter()


def a_missing_interface_is_named_at_the_start():
    """roverd says in one line that the CAN interface is missing, and ends"""
    roverd = Program(BIN / "roverd", "--config", ROOT / "config/robot.toml", "--data",
                     SCRATCH / "missing", "--port", "0", "--set", "drivers.bunker.link=can:vcan7")
    try:
        code = roverd.wait_exit(30)
    finally:
        roverd.process.kill()
    check(code != 0, "exit code 0 without its CAN interface")
    named = [line for line in roverd.errors if "vcan7" in line]
    check(len(named) == 1, f"one line names vcan7, not: {roverd.errors}")


def wait_ready():
    end = now() + 120
    while True:
        checks = station.rest.get("/vehicle/checks")
        if checks["ready"]:
            return
        failing = [f"{c['id']}: {c['detail']}" for c in checks["checks"] if not c["ok"]]
        check(now() < end, f"not ready to arm after 120 s: {failing}")
        time.sleep(0.5)


def everything_comes_up():
    """the simulated base is heard over the real interface, and the checks pass"""
    station.control.ask({"fault": {"radio_loss": True, "radio_loss_unflagged": True}})
    radio.play(CAN_DRIVES)
    wait_ready()
    vehicle = station.rest.get("/vehicle")
    frames = candump.read(LOG)
    for frame_id in (0x211, 0x221, 0x311):
        check(candump.only(frames, frame_id), f"no 0x{frame_id:03X} on the bus")
    driver = next(d for d in station.rest.get("/drivers")["items"] if d["name"] == "bunker")
    check(driver["facts"].get("protocol") == "V2" and driver["facts"].get("can_kind") == "vcan",
          f"the driver tells {driver['facts']}")
    check("BUNKER-SIM" in driver["facts"].get("firmware", ""), f"no firmware in {driver['facts']}")
    battery_v = candump.state(candump.only(frames, 0x211)[-1])[2]
    shown_v = vehicle["battery"]["battery_v"]
    check(abs(shown_v - battery_v) < 0.35, f"0x211 says {battery_v} V, the API {shown_v} V")


def nothing_moves_before_arming():
    """before arming every 0x111 on the bus is zero"""
    frames = candump.read(LOG)
    check(len(candump.only(frames, 0x221)) > 50, f"candump saw only {len(frames)} frames")
    moving = list(filter(candump.moves, candump.only(frames, 0x111)))
    check(not moving, f"{len(moving)} moving commands, first {moving[:1]}")


def a_mission_drives():
    """a mission started over the API becomes 0x421 and moving 0x111 frames"""
    rest = station.rest
    truth = station.control.ask({"get": "truth"})
    heading = math.radians(truth["heading_deg"])
    metre_lat = 1 / 111_360.0
    metre_lon = metre_lat / math.cos(math.radians(truth["lat"]))
    ahead = [{"type": "waypoint",
              "lat": truth["lat"] + d * math.cos(heading) * metre_lat,
              "lon": truth["lon"] + d * math.sin(heading) * metre_lon} for d in (15, 300)]
    mission = rest.do("POST", "/missions", {"name": "ahead", "items": ahead})
    rest.do("POST", "/execution/load", {"mission_id": mission["id"]})
    # On a slow kernel the receiver's sentences may stumble, and the checks with them.
    until("the robot lets itself be armed", 90,
          lambda: rest.call("POST", "/vehicle/arm", {"valid_for_s": 5})[0] == 200, 1.0)
    moments["start"] = now()
    rest.do("POST", "/execution/start", {"mission_id": mission["id"], "revision": mission["revision"],
                                         "from": "first", "valid_for_s": 5})
    wait_frames(0x111, candump.moves, 30, moments["start"])
    asked = candump.only(candump.read(LOG), 0x421)
    check(asked and asked[-1].data == bytes([1, 0, 0, 0, 0, 0, 0, 0]),
          f"0x421 asks for CAN mode with 01 and seven zeros, not {asked[-1:]}")
    until("the robot has really driven 3 m", 60,
          lambda: station.control.ask({"get": "truth"})["driven_m"] > 3.0, 0.5)


def feedback_is_what_really_happens():
    """0x221 and 0x311 on the bus agree with each other and with the speed the API shows"""
    begin = now() - 2.0
    vehicle = station.rest.get("/vehicle")
    frames = candump.read(LOG)
    speeds = [candump.motion(f)[0] for f in candump.only(frames, 0x221, begin)]
    check(len(speeds) > 20, f"only {len(speeds)} frames 0x221 in 2 s")
    mean = sum(speeds) / len(speeds)
    check(0.2 < mean < 1.6, f"0x221 shows {mean:.2f} m/s while driving ahead")
    shown = vehicle["position"]["speed_mps"]
    check(abs(shown - mean) < 0.35, f"the API shows {shown} m/s, the tracks {mean:.2f} m/s")
    odometer = candump.only(frames, 0x311, begin)
    passed_s = odometer[-1].time_s - odometer[0].time_s
    way = [b - a for a, b in zip(candump.odometer_m(odometer[0]), candump.odometer_m(odometer[-1]))]
    check(abs(sum(way) / 2 - mean * passed_s) < 0.3 * mean * passed_s + 0.1,
          f"0x311 advances {way} m in {passed_s:.2f} s at {mean:.2f} m/s")


def commands_come_without_a_gap():
    """while it drives, 0x111 is never silent for the base's 500 ms"""
    commands = candump.only(candump.read(LOG), 0x111, moments["start"] + 1.0)
    gap_s = candump.longest_gap_s(commands)
    check(gap_s < 0.5, f"a gap of {gap_s:.3f} s in {len(commands)} commands")


def the_radio_takes_over():
    """a radio take-over frame injected by cansend silences the robot's commands"""
    driving = candump.only(candump.read(LOG), 0x111, now() - 1.0)
    check(any(map(candump.moves, driving)), "the robot does not drive, so nothing can be taken over")
    moments["take_over"] = now()
    radio.play(TAKES_OVER)
    time.sleep(1.0)
    moments["quiet"] = now()
    time.sleep(1.5)
    moments["seen"] = station.rest.get("/vehicle")
    moments["still_quiet"] = now()
    frames = candump.read(LOG)
    injected = [f for f in candump.only(frames, 0x241, moments["take_over"]) if f.data[0] == 0xA6]
    check(injected, "candump did not see the injected 0x241")
    late = list(filter(candump.moves, candump.only(frames, 0x111, moments["quiet"],
                                                   moments["still_quiet"])))
    check(not late, f"{len(late)} moving 0x111 while the radio drives, first {late[:1]}")
    first = injected[0].time_s
    moving = list(filter(candump.moves, candump.only(frames, 0x111, first)))
    if moving:
        check(moving[-1].time_s - first < 0.5, f"moving commands until {moving[-1].time_s - first:.2f} s "
                                               "after the first take-over frame")


def the_api_says_who_drives():
    """during the take-over the API says that the radio drives, and the mission is kept"""
    vehicle = moments["seen"]
    check(vehicle["control"] == "rc", f"control is {vehicle['control']!r}, not 'rc'")
    check(vehicle["rc"]["swb"] == "middle", f"rc is {vehicle['rc']}")
    state = vehicle["mission"]["state"]
    check(state in ("running", "paused"), f"the mission is {state}")


def no_request_fights_the_radio():
    """during the take-over the robot does not ask for CAN mode"""
    asked = [f for f in candump.only(candump.read(LOG), 0x421, moments["quiet"], moments["still_quiet"])
             if f.data[0] == 1]
    check(not asked, f"{len(asked)} requests against the radio, first {asked[:1]}")


def the_mission_goes_on():
    """with the switch up again CAN mode is asked for anew and the same mission goes on"""
    back = now()
    item = moments["seen"]["mission"]["current_item"]
    radio.play(CAN_DRIVES)
    wait_frames(0x421, lambda f: f.data[0] == 1, 20, back)
    try:
        wait_frames(0x111, candump.moves, 30, back)
    except Failed as failed:
        vehicle = station.rest.get("/vehicle")
        raise Failed(f"{failed}; mission {vehicle['mission']['state']} {vehicle['mission']['reason']!r}, "
                     f"safety {vehicle['safety']}") from None
    mission = until("the mission runs", 20, lambda: (
        lambda m: m if m["state"] == "running" else None)(station.rest.get("/vehicle")["mission"]))
    check(mission["current_item"] >= item > 0, f"item {mission['current_item']} after {item}")
    driven = station.control.ask({"get": "truth"})["driven_m"]
    until("the robot really moves on", 40,
          lambda: station.control.ask({"get": "truth"})["driven_m"] > driven + 1.0, 0.5)


def both_programs_end_cleanly():
    """Ctrl-C ends both programs with exit code 0"""
    for program in (station.roverd, station.sim):
        code = program.stop(signal.SIGINT, 20)
        check(code == 0, f"{program.name} ends with {code}: {program.said()}")


def the_programs_start():
    """the simulator and roverd open the real interface"""
    global station
    station = Station(can=BUS, data=SCRATCH / "data",
                      arguments=("--record", "--set", "recording.max_mb=1"))
    on_its_own_computer(station.sim.process)


def how_it_stands():
    """The mission, what safety says and the last events: for the lines after a failure."""
    vehicle = station.rest.get("/vehicle")
    yield f"mission {vehicle['mission']}"
    yield f"control {vehicle['control']}, armed {vehicle['armed']}, safety {vehicle['safety']}"
    for part in ("position", "attitude", "gnss", "estimator", "activity", "command", "loop"):
        yield f"{part} {vehicle[part]}"
    for driver in station.rest.get("/drivers")["items"]:
        yield f"driver {driver}"
    for event in station.rest.get("/events?limit=1000")["items"][-12:]:
        yield f"{event}"
    frames = candump.read(LOG)
    for frame_id in (0x111, 0x221, 0x241):
        seen = candump.only(frames, frame_id, now() - 60)
        gaps = sorted(((b.time_s - a.time_s, a.time_s) for a, b in zip(seen, seen[1:])), reverse=True)
        yield f"0x{frame_id:03X} in the last minute: {len(seen)}, silent for " + ", ".join(
            f"{gap:.2f} s {now() - at:.1f} s ago" for gap, at in gaps[:3])


class Watcher:
    """candump, started anew when its interface was removed."""

    def __init__(self):
        self.process = None

    def start(self):
        self.stop()
        with open(LOG, "a", encoding="ascii") as log:
            self.process = subprocess.Popen(["stdbuf", "-oL", "candump", "-L", "-r", "8000000", BUS],
                                            stdout=log)

    def stop(self):
        if self.process:
            self.process.terminate()
            self.process.wait()


def main():
    code = run_cases([a_missing_interface_is_named_at_the_start])
    watcher = Watcher()
    watcher.start()
    try:
        code |= run_cases([the_programs_start])
        if not station:
            sys.exit(code)
        code |= run_cases([
            everything_comes_up, nothing_moves_before_arming, a_mission_drives,
            feedback_is_what_really_happens, commands_come_without_a_gap, the_radio_takes_over,
            the_api_says_who_drives, no_request_fights_the_radio, the_mission_goes_on], how_it_stands)
        radio.silence()  # the simulator's own again: canplayer does not survive a lost interface
        station.control.ask({"fault": {"radio_loss": False, "radio_loss_unflagged": False}})
        rough = RoughBus(station, BUS, LOG, watcher.start)
        code |= run_cases([
            rough.a_full_bus_does_not_stop_the_robot, rough.strangers_are_counted_and_change_nothing,
            rough.a_second_commander_makes_the_robot_hold,
            rough.the_interface_goes_down_and_comes_back,
            rough.the_interface_is_unplugged_and_plugged_in_again,
            rough.the_recording_goes_on_in_a_second_file, both_programs_end_cleanly,
            rough.the_recording_is_whole,
            rough.nothing_of_the_base_is_missing_in_the_recording,
            rough.canplayer_plays_the_recording], how_it_stands)
    finally:
        if station:
            station.close()
        radio.silence()
        watcher.stop()
    sys.exit(code)


if __name__ == "__main__":
    main()
