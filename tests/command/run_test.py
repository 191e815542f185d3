#!/usr/bin/env python3
"""./run as a person uses it: its options, what it says of bad ones, starting twice, Ctrl-C."""

import contextlib
import os
import pathlib
import re
import shutil
import signal
import socket
import sqlite3
import subprocess
import sys
import tempfile
import time
import urllib.request

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
from station import BIN, ROOT, Program, Rest, check, run_cases, until  # noqa: E402

RUN = ROOT / "run"
scratch = pathlib.Path(tempfile.mkdtemp(prefix="roverd-command."))


@contextlib.contextmanager
def running(*options, data="data", before=()):
    """./run with a free port, listening: the program and its API. Whatever comes, it is ended."""
    program = Program(*before, RUN, "--port", "0", "--data", scratch / data, *options)
    try:
        address = program.wait_line(r"^listening on (http://127\.0\.0\.1:\d+)$", 60)[1]
        yield program, Rest(address)
    finally:
        program.stop(signal.SIGINT)


def children_of(pid):
    """Name → pid of the live children."""
    found = {}
    for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            match = re.match(r"(\d+) \((.*)\) (\S) (\d+)", stat.read_text())
        except (FileNotFoundError, ProcessLookupError):
            continue
        if match and int(match[4]) == pid and match[3] != "Z":
            found[match[2]] = int(match[1])
    return found


def alive(pid):
    try:
        return pathlib.Path(f"/proc/{pid}/stat").read_text().split(") ")[1][0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


def refused(*options, names, environment=None):
    """./run ends with an error of one line that names the cause."""
    env = os.environ | (environment or {})
    done = subprocess.run([str(RUN), *map(str, options)], stdin=subprocess.DEVNULL,
                          capture_output=True, text=True, timeout=60, env=env)
    shown = " ".join(map(str, options))
    check(done.returncode != 0, f"exit code 0 of ./run {shown}")
    lines = done.stderr.strip().splitlines()
    check(len(lines) == 1, f"./run {shown} says on stderr {lines}, not one line")
    for name in names:
        check(name in lines[0], f"./run {shown} says {lines[0]!r}, which does not name {name!r}")
    check("listening" not in done.stdout, f"./run {shown} listened for a while")


def config_with(*lines):
    """A copy of the shipped configuration with these lines in front."""
    folder = scratch / "config"
    if not folder.exists():
        shutil.copytree(ROOT / "config", folder)
    file = folder / "changed.toml"
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return file


def help_tells_every_option():
    """./run --help tells every option, and ends with 0"""
    done = subprocess.run([str(RUN), "--help"], capture_output=True, text=True, timeout=20)
    check(done.returncode == 0, f"exit code {done.returncode}")
    for option in ("--port", "--data", "--config", "--vehicle", "--seed", "--world", "--replay", "--no-sim"):
        check(option in done.stdout, f"{option} is not told")


def wrong_options_are_named():
    """an unknown option or a wrong value is refused in one line that names it"""
    refused("--frobnicate", names=["--frobnicate"])
    refused("--port", names=["--port"])
    refused("--port", "http", names=["--port", "http"])
    refused("--port", "65536", names=["--port", "65536"])
    refused("--seed", "-1", names=["--seed"])
    refused("--data", "", names=["--data"])
    for speed in ("nan", "-1", "fast"):
        refused("--data", scratch / "s", "--replay", __file__, "--replay-speed", speed, names=["--replay-speed", speed])


def missing_files_are_named():
    """a missing configuration, recording or vehicle is refused by name"""
    refused("--config", "/nowhere/robot.toml", names=["/nowhere/robot.toml"])
    refused("--replay", "/nowhere/field.log", names=["/nowhere/field.log"])
    refused("--world", "nowhere", names=["--world", "nowhere", "yard"])
    refused("--world", "yard", "--vehicle", "husky", names=["--world", "bunker"])
    refused("--world", "yard", "--no-sim", names=["--world", "simulator"])
    refused("--port", "0", "--data", scratch / "v", "--vehicle", "hovercraft", names=["hovercraft"])


def a_vehicle_without_a_simulation_is_refused():
    """a profile that nothing tells how to simulate is refused by name, and --no-sim is offered"""
    config = config_with('[vehicle]', 'name = "tractor"')
    shutil.copy(ROOT / "config/vehicles/husky.toml", config.parent / "vehicles/tractor.toml")
    for options in ((), ("--vehicle", "tractor")):
        refused("--config", config, *options, names=["sim/tractor.toml", "--no-sim"])


def an_unwritable_data_folder_is_named():
    """a data folder that cannot be written is refused by name"""
    refused("--data", "/proc/roverd", names=["/proc/roverd"])
    blocker = scratch / "a-file"
    blocker.write_text("")
    refused("--data", blocker, names=[str(blocker)])


def wrong_configuration_is_named():
    """an unknown key, a wrong type and a value out of range are refused, naming file and key"""
    for text, key in (("[server]\nprot = 8080", "prot"), ("[server]\nport = \"x\"", "port"),
                      ("[server]\nport = 70000", "port"), ("[server", "changed.toml"),
                      ("[radio]\nswc_down = \"mode.fly\"", "changed.toml:2: radio.swc_down must be"),
                      ("[radio]\nknob_high = \"by_knob\"", "radio.knob_high cannot be by_knob"),
                      ("[radio]\nswe_up = \"arm\"", "unknown key radio.swe_up"),
                      ("[frobnicate]", "frobnicate"), ("[nav.frobnicate]", "nav.frobnicate")):
        refused("--data", scratch / "c", "--config", config_with(text), names=["changed.toml", key])
    not_tiles = scratch / "tiles.txt"
    not_tiles.write_text("no database, but long enough to be looked into. " * 20)
    for text, key in (('[server]\nlog_level = "loud"', "server.log_level"),
                      ('[tiles]\nfarm = "/nowhere.mbtiles"', "/nowhere.mbtiles"),
                      (f'[tiles]\nfarm = "{not_tiles}"', str(not_tiles)),
                      ('[vehicle]\nkinematics = "hover"', "vehicle.kinematics"),
                      ("[nav.speed]\nreverse_max_mps = 0.11", "nav.speed.reverse_max_mps"),
                      ('[drivers.gnss]\nheading_source = "moon"', "drivers.gnss.heading_source")):
        refused("--data", scratch / "c", "--config", config_with(text),
                names=["changed.toml:2", key])


def wrong_links_are_named():
    """a link that is not there, or of another kind, is refused by file, line and name"""
    for link, name in (("cansock:/nope", "no socket /nope"), ("can:lo", "lo is no CAN interface"),
                       ("frob:x", "frob:x"), ("tcp:localhost:5000", "CAN frames are needed")):
        config = config_with("[drivers.bunker]", f'link = "{link}"')
        refused("--no-sim", "--port", "0", "--data", scratch / "n", "--config", config,
                names=["changed.toml:2", "drivers.bunker.link", name])


def wrong_input_has_its_own_exit_code():
    """what is said wrongly ends roverd with 2, what this machine refuses with 1"""
    def code(*options, data=scratch / "e"):
        return subprocess.run([str(BIN / "roverd"), "--data", str(data), "--port", "0",
                               "--config", str(config_with("[server]")), *options],
                              capture_output=True, timeout=60).returncode
    check(code("--replay-speed", "nan") == 2, "a speed that is no number")
    check(code("--set", "drivers.bunker.link=cansock:/nope") == 2, "a link that is not there")
    check(code("--replay", __file__) == 2, "a file that is no recording")
    check(code("--set", "server.bind=0.0.0.0", "--replay", str(recording_of_gnss())) == 2, "bind")
    check(code(data="/proc/roverd") == 1, "a folder that cannot be")


def recording_of_bus(name="bus.log", begin_s=1_700_000_000, seconds=20):
    """A standing Bunker with the radio off, as candump -L writes it."""
    path = scratch / name
    with path.open("w", encoding="ascii") as file:
        for i in range(seconds * 50):
            stamp = f"({begin_s + i * 0.02:.6f}) can0"
            file.write(f"{stamp} 221#0000000000000000\n")
            if i % 5 == 0:
                file.write(f"{stamp} 211#000001EF000000{(i // 5) % 256:02X}\n")
    return path


def recording_of_gnss(name="gnss.raw", begin_s=1_700_000_001, seconds=20):
    """A receiver without a fix, as roverd records it."""
    path = scratch / name
    with path.open("wb") as file:
        file.write(b"roverd-bytes 1 serial:/dev/ttyACM0:115200\n")
        for i in range(seconds):
            text = f"GPGGA,1200{i:02d}.00,,,,,0,00,99.99,,,,,,"
            total = 0
            for c in text:
                total ^= ord(c)
            line = f"${text}*{total:02X}\r\n".encode()
            file.write(f"({begin_s + i}.000000) R {len(line)}\n".encode() + line + b"\n")
    return path


def both_recordings_of_a_run_play():
    """--replay given twice plays the bus and the receiver of one run"""
    with running("--replay", recording_of_gnss(), "--replay", recording_of_bus()) as (_, rest):
        def both():
            drivers = {d["name"]: d for d in rest.get("/drivers")["items"]}
            return (set(drivers) == {"bunker", "gnss"} and
                    all(d["received"] > 0 for d in drivers.values()))
        until("both are heard", 20, both)


def recordings_that_do_not_belong_together_are_refused():
    """two of a kind, recordings of other runs, and several without a pace are refused"""
    bus, gnss = recording_of_bus(), recording_of_gnss()
    data = ("--port", "0", "--data", scratch / "r")
    refused(*data, "--replay", bus, "--replay", recording_of_bus("other.log"),
            names=["bus.log", "other.log", "CAN bus"])
    refused(*data, "--replay", bus, "--replay", recording_of_gnss("late.raw", 1_700_009_000),
            names=["more than an hour apart"])
    refused(*data, "--replay", bus, "--replay", gnss, "--replay-speed", "0",
            names=["--replay-speed 0"])
    plan = ROOT / "tests/data/fuzz/plan/every_kind.plan"
    refused(*data, "--replay", plan, names=[str(plan), "no recording"])


def a_recorder_that_cannot_write_is_told():
    """when recordings cannot be written, the drivers work, and an event and their state say why"""
    folder = scratch / "full"
    folder.mkdir()
    (folder / "recordings").write_text("a file where the folder should be")
    with running("--record", data="full") as (_, rest):
        until("the base is heard", 20, lambda: all(
            d["state"] == "up" for d in rest.get("/drivers")["items"]))
        for driver in rest.get("/drivers")["items"]:
            check(driver["recording"] == "stopped", driver)
            check("recordings" in driver["recording_problem"], driver)
        until("an event tells", 10, lambda: any(
            e["kind"] == "recording_stopped" for e in rest.get("/events")["items"]))


def only_loopback_is_served():
    """any bind address but loopback is refused with the reason"""
    refused("--data", scratch / "b", "--config", config_with('[server]', 'bind = "0.0.0.0"'),
            names=["0.0.0.0"])


def access_control_asks_for_a_log_in():
    """[server] access: the printed code makes the first admin, who is known after a restart; no secret is in any file"""
    config_with()
    config = scratch / "config/access.toml"
    shipped = (ROOT / "config/robot.toml").read_text(encoding="utf-8")
    config.write_text(shipped.replace("[server]\n", "[server]\naccess = true\n", 1), encoding="utf-8")
    password = "four tractors in a barn"
    with running("--config", config, data="access") as (program, rest):
        code = program.wait_line(r"with the code (\S{4}-\S{4})$")[1]
        check(rest.call("GET", "/vehicle")[0] == 401, "the state is open")
        check(rest.call("POST", "/vehicle/estop")[0] == 200, "not everybody may stop")
        check(rest.call("GET", "/health")[0] == 200, "health is closed")
        wrong = {"code": "AAAA-AAAA", "user": "anna", "password": password}
        check(rest.call("POST", "/setup", wrong)[0] == 401, "a wrong code makes an admin")
        status, headers, state = rest.call("POST", "/setup", wrong | {"code": code})
        check(status == 200 and state["role"] == "admin", f"setup answers {status}: {state}")
        cookie = {"Cookie": headers["Set-Cookie"].split(";")[0], "Origin": rest.address}
        check(rest.call("GET", "/vehicle", headers=cookie)[0] == 200, "the cookie is not taken")
        draft = {"name": "logger", "role": "viewer"}
        status, _, token = rest.call("POST", "/tokens", draft, cookie)
        check(status == 201, f"POST /tokens answers {status}: {token}")
    with running("--config", config, data="access") as (program, rest):
        bearer = {"Authorization": "Bearer " + token["token"]}
        until("the token is known after a restart", 10,
              lambda: rest.call("GET", "/vehicle", headers=bearer)[0] == 200)
        check(rest.call("POST", "/vehicle/arm", headers=bearer)[0] == 403, "a viewer may arm")
        check(rest.call("GET", "/users", headers=cookie)[0] == 200, "the session did not outlive the restart")
        login = {"user": "anna", "password": password}
        check(rest.call("POST", "/session", login)[0] == 200, "anna cannot log in")
        check(rest.call("POST", "/session", login | {"password": "no" + password})[0] == 401, "anybody is anna")
        check("code" not in program.said(), "a code was printed though there is an admin")
    secrets = [password, cookie["Cookie"].split("=")[1], token["token"], code]
    for file in (scratch / "access").rglob("*"):
        text = file.read_bytes() if file.is_file() else b""
        for secret in secrets:
            check(secret.encode() not in text, f"a secret is in {file}")


def a_missing_can_interface_is_named():
    """with --no-sim and no CAN interface the start is refused by its name"""
    config = config_with('[drivers.bunker]', 'link = "can:nocan7"')
    refused("--no-sim", "--port", "0", "--data", scratch / "n", "--config", config, names=["nocan7"])


def a_vehicle_over_udp_needs_its_peer():
    """a vehicle's UDP link without a peer is refused: any sender could become the vehicle"""
    config = config_with("[drivers.ackermann]", 'link = "udp:5005"')
    refused("--no-sim", "--port", "0", "--data", scratch / "u", "--config", config, "--vehicle", "uku",
            names=["drivers.ackermann.link", "udp:HOST:PORT"])


def page_of(rest):
    with urllib.request.urlopen(rest.address + "/", timeout=10) as answer:
        return answer.status, answer.headers, answer.read()


def the_product_starts():
    """./run --port 0 prints data folder and address; page and API answer there"""
    with running() as (program, rest):
        check(any(str(scratch / "data") in line for line in program.lines), "data folder not shown")
        health = rest.get("/health")
        check(health["status"] == "ok", f"not healthy: {health}")
        status, headers, page = page_of(rest)
        check(status == 200 and b"<html" in page.lower(), f"the page answers {status}")
        check("text/html" in headers["Content-Type"], headers["Content-Type"])
        until("the simulated base is heard", 10, lambda: all(
            d["state"] == "up" for d in rest.get("/drivers")["items"]))


def in_a_world_it_sees():
    """./run --world NAME starts a robot with a lidar and a scanner that see that world"""
    with running("--world", "yard", data="world") as (_, rest):
        until("both sensors are heard", 30, lambda: sorted(
            (s["name"], s["kind"]) for s in rest.get("/sensors")["items"] if s["points"] > 0)
            == [("front", "sick"), ("top", "velodyne")], 0.2)
    with running(data="blind") as (_, rest):
        check(rest.get("/sensors")["items"] == [], "without a world there is no sensor")


def without_network():
    """Words to put before a command. It hears of any tool that would fetch, build or ask for packages
    in scratch/asked; where the system lets an ordinary user do that, there is no network either."""
    tools = scratch / "tools"
    tools.mkdir(exist_ok=True)
    for name in ("apt-get", "dpkg-query", "sudo", "npm", "npx", "node", "cmake", "ninja", "curl", "wget"):
        (tools / name).write_text(f'#!/bin/sh\necho "{name} $*" >>"{scratch}/asked"\nexit 1\n')
        (tools / name).chmod(0o755)
    own = ["env", f"PATH={tools}:{os.environ['PATH']}"]
    alone = ["unshare", "-rn", "sh", "-c", 'ip link set lo up && exec "$@"', "sh"]
    allowed = subprocess.run([*alone, "true"], capture_output=True, check=False).returncode == 0
    return [*(alone if allowed else []), *own]


def a_second_start_is_quick():
    """a second start listens soon, without network and packages, and finds what was saved before"""
    mission = {"name": "kept", "items": [{"type": "waypoint", "lat": 58.3781, "lon": 26.7290}]}
    with running() as (_, rest):
        saved = rest.do("POST", "/missions", mission)
    begin = time.monotonic()
    with running(before=without_network()):
        took_s = time.monotonic() - begin
    check(took_s < 10.0, f"{took_s:.2f} s until it listened")  # a hang guard; the figure is 2 s
    asked = scratch / "asked"
    check(not asked.exists(), f"a built product asks for {asked.exists() and asked.read_text()}")
    with running() as (_, rest):
        check(rest.get(f"/missions/{saved['id']}")["name"] == "kept", "the mission is lost")


def both_end():
    """Ctrl-C and SIGTERM end roverd and the simulator, and nothing is left behind"""
    for how in (signal.SIGINT, signal.SIGTERM):
        with running() as (program, _):
            children = children_of(program.process.pid)
            check({"roverd", "roverd-sim"} <= set(children), f"children are {children}")
            begin = time.monotonic()
            code = program.stop(how)
            took_s = time.monotonic() - begin
        check(code == 0, f"{how.name} ends it with {code}: {program.said()}")
        check(took_s < 10.0, f"{how.name} took {took_s:.2f} s")
        left = [name for name, pid in children.items() if alive(pid)]
        check(not left, f"still running: {left}")


def a_killed_script_leaves_nothing():
    """when the script itself is killed, both programs end too"""
    with running() as (program, _):
        children = children_of(program.process.pid)
        program.process.kill()
        until("both programs have ended", 5,
              lambda: not any(alive(children[n]) for n in ("roverd", "roverd-sim")))


def one_dies_the_other_ends():
    """if one of the two dies, the other is ended and the reason is said"""
    for victim, other in (("roverd-sim", "roverd"), ("roverd", "roverd-sim")):
        with running() as (program, _):
            children = children_of(program.process.pid)
            os.kill(children[victim], signal.SIGKILL)
            code = program.wait_exit(10)
        check(code != 0, f"exit code 0 after {victim} died")
        check(not alive(children[other]), f"{other} still runs")
        what = "simulator" if victim == "roverd-sim" else "roverd"
        check(any(what in line for line in program.errors), f"no reason: {program.errors}")


def a_busy_port_is_named():
    """a busy port is refused by its number, and the one that has it goes on"""
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = str(taken.getsockname()[1])
        refused("--port", port, "--data", scratch / "busy", names=[port])


def a_newer_database_is_refused():
    """a database of a newer version is refused, and not touched"""
    folder = scratch / "newer"
    with running(data="newer"):
        pass
    files = [f for f in folder.rglob("*") if f.is_file() and f.read_bytes()[:6] == b"SQLite"]
    check(len(files) == 1, f"one SQLite file expected in {folder}: {files}")
    with sqlite3.connect(files[0]) as connection:
        connection.execute("PRAGMA user_version = 9999")
    connection.close()
    before = files[0].read_bytes()
    refused("--port", "0", "--data", folder, names=["9999"])
    check(files[0].read_bytes() == before, "the file was changed")


if __name__ == "__main__":
    try:
        code = run_cases([
            help_tells_every_option, wrong_options_are_named, missing_files_are_named,
            a_vehicle_without_a_simulation_is_refused, an_unwritable_data_folder_is_named,
            wrong_configuration_is_named, wrong_links_are_named, wrong_input_has_its_own_exit_code,
            both_recordings_of_a_run_play, recordings_that_do_not_belong_together_are_refused,
            a_recorder_that_cannot_write_is_told, only_loopback_is_served, access_control_asks_for_a_log_in, a_missing_can_interface_is_named,
            a_vehicle_over_udp_needs_its_peer, the_product_starts, in_a_world_it_sees,
            a_second_start_is_quick, both_end, a_killed_script_leaves_nothing,
            one_dies_the_other_ends, a_busy_port_is_named, a_newer_database_is_refused])
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
    sys.exit(code)
