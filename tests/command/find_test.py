#!/usr/bin/env python3
"""Finding the robot: its name, colour and picture; and what a real avahi-daemon tells the network of it.

The robot and another computer at the end of a wire are network namespaces, each with its own D-Bus and
avahi-daemon. Where the system permits none these cases are listed as not run, and with CI=true they fail."""

import base64
import contextlib
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.parse
import urllib.request

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
from station import BIN, ROOT, Program, Station, check, run_cases, until  # noqa: E402

INSIDE = ["unshare", "--user", "--map-root-user", "--net", "--mount"]
PNG = base64.b64decode("iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNkYPhfDwAChwGA60e6kgAAAABJRU5ErkJggg==")
NO_DEVICES = [part for name in ("bunker", "gnss", "mti") for part in ("--set", f"drivers.{name}.enabled=false")]
BUS = """<busconfig><type>system</type><listen>unix:path={folder}/bus</listen><auth>EXTERNAL</auth>
<policy context="default"><allow send_destination="*" eavesdrop="true"/><allow eavesdrop="true"/>
<allow own="*"/><allow user="*"/></policy></busconfig>"""
DAEMON = """[server]
host-name={name}
use-ipv4=yes
use-ipv6=yes
[publish]
publish-aaaa-on-ipv4=yes
publish-workstation=no
"""


def port_of(station):
    return urllib.parse.urlparse(station.address).port


def run(*command, **more):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, timeout=30, **more)
    check(done.returncode == 0, f"{' '.join(map(str, command))}: {done.stdout}{done.stderr}")
    return done.stdout


def named(**settings):
    return [part for key, value in settings.items() for part in ("--set", f"robot.{key}={value}")]


def who(station):
    return station.rest.get("/health")["robot"]


# ---- without a network


def its_own_name():
    """the robot has the name, colour and picture that its owner chose: in GET /health, as files, on /pair, in its
    certificate, in the log"""
    with tempfile.TemporaryDirectory() as scratch:
        picture = pathlib.Path(scratch) / "picture"
        picture.write_bytes(PNG)
        said = named(name="Põllu kask", colour="pink", picture=picture)
        with Station(arguments=("--tls", *said)) as station:
            check(who(station) == {"name": "Põllu kask", "host": None, "colour": "pink", "rgb": "#ad1457",
                                   "picture": "/robot.png"}, who(station))
            for path, kind, part in (("/robot.png", "image/png", PNG), ("/robot.svg", "image/svg+xml", b">PK</text>"),
                                     ("/roverd.webmanifest", "application/manifest+json", '"name":"Põllu kask"'.encode()),
                                     ("/pair", "text/html; charset=utf-8", "Pair with Põllu kask".encode()),
                                     ("/pair", "text/html; charset=utf-8", b'<img src="/robot.png"')):
                status, sort, body = fetch(station, path)
                check(status == 200 and sort == kind and part in body, f"{path}: {status} {sort} {body}")
            check("DNS:pollu-kask.local" in names_in_certificate(station), names_in_certificate(station))
            until("the log names it", 20, lambda: 'robot="Põllu kask"' in log_of(station))
            station.roverd.wait_line("^this robot is Põllu kask$")


def its_default_name():
    """a robot that nobody named is called as its computer, has a drawn badge, and no network hears of it"""
    with Station() as station:
        robot = who(station)
        check(robot["name"] == socket.gethostname().split(".")[0] and robot["picture"] == "/robot.svg", robot)
        check(robot["host"] is None, robot)
        check(fetch(station, "/robot.png")[0] == 404, "there is a picture")
        check(f'fill="{robot["rgb"]}"'.encode() in fetch(station, "/robot.svg")[2], "another colour is drawn")
        problems = [p["id"] for p in station.rest.get("/health")["problems"]]
        check("not_announced" not in problems, problems)


def refusals():
    """a colour that is none of the list, a name of two lines and a picture that is none are refused with their key"""
    with tempfile.TemporaryDirectory() as scratch:
        drawing = pathlib.Path(scratch) / "drawing.svg"
        drawing.write_text("<svg onload='x'/>", encoding="ascii")
        for said, cause in ((named(colour="red"), "robot.colour=red must be one of blue, green"),
                            (named(name="two\nlines"), "must be one line of UTF-8 text"),
                            (named(name="x" * 41), "must not be longer than 40 bytes"),
                            (named(picture=drawing) + NO_DEVICES, "must be a PNG, JPEG or WebP picture"),
                            (named(picture=f"{scratch}/none.png") + NO_DEVICES, "none.png")):
            program = Program(BIN / "roverd", "--config", ROOT / "config/robot.toml", "--data", f"{scratch}/data",
                              "--port", "0", *said)
            code = program.wait_exit(20)
            check(code == 2 and cause in " ".join(program.errors), f"{said}: {code} {program.errors}")


def fetch(station, path):
    """@return status, content type, body"""
    try:
        with urllib.request.urlopen(station.address + path, timeout=20, context=station.rest.trust) as answer:
            return answer.status, answer.headers["Content-Type"], answer.read()
    except urllib.error.HTTPError as error:
        with error:
            return error.code, error.headers["Content-Type"], error.read()


def names_in_certificate(station):
    return run("openssl", "x509", "-noout", "-ext", "subjectAltName", "-in", station.scratch / "data/tls/server.pem")


# ---- with networks


class Computer:
    """A D-Bus, an avahi-daemon and what talks to them; in a network of its own, or (name "robot") in ours."""

    def __init__(self, name, networks=(1,)):
        self.name = name
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="roverd-find.", dir="/tmp"))
        self.programs = []
        self.enter = []
        self.daemon = None
        self.env = {**os.environ, "DBUS_SYSTEM_BUS_ADDRESS": f"unix:path={self.folder}/bus"}
        self.holder = None
        if name != "robot":
            self._leave(networks)
        (self.folder / "bus.conf").write_text(BUS.format(folder=self.folder), encoding="ascii")
        (self.folder / "avahi.conf").write_text(DAEMON.format(name=name), encoding="ascii")

    def _leave(self, networks):
        self.holder = subprocess.Popen(["unshare", "--net", "--mount", "sh", "-c",
                                        "mount -t tmpfs none /run && echo ready && exec sleep 600"],
                                       stdout=subprocess.PIPE, text=True)
        check(self.holder.stdout.readline() == "ready\n", "no mount namespace")
        self.enter = ["nsenter", "--net", "--mount", "--target", str(self.holder.pid)]
        self.run("ip", "link", "set", "lo", "up")
        for number in networks:
            here = f"{self.name[:8]}{number}"
            run("ip", "link", "add", "name", here, "type", "veth", "peer", "name", f"net{number}", "netns",
                str(self.holder.pid))
            run("ip", "link", "set", here, "master", f"net{number}", "up")
            self.run("ip", "link", "set", f"net{number}", "up")
            last = 10 + len(self.name)
            self.run("ip", "address", "add", f"10.77.{number}.{last}/24", "dev", f"net{number}")
            self.run("ip", "-6", "address", "add", f"fd77:{number}::{last}/64", "dev", f"net{number}", "nodad")

    def __enter__(self):
        self.start(Program(*self.enter, "dbus-daemon", f"--config-file={self.folder}/bus.conf", "--nofork",
                           "--nopidfile"))
        until("the bus listens", 20, (self.folder / "bus").exists)
        return self

    def start(self, program):
        self.programs.insert(0, program)
        return program

    def begin_avahi(self):
        self.daemon = self.start(Program(*self.enter, "avahi-daemon", "--file", self.folder / "avahi.conf",
                                         "--no-drop-root", "--no-chroot", "--no-rlimits", env=self.env))
        until(f"avahi-daemon runs on {self.name}", 30, lambda: self.ask("avahi-browse", "-t", "-p", "_none._tcp")[0] == 0)
        return self

    def end_avahi(self):
        self.daemon.stop()
        self.programs.remove(self.daemon)

    def __exit__(self, *_):
        for program in self.programs:
            program.stop()
        if self.holder:
            self.holder.kill()
            self.holder.wait()
        shutil.rmtree(self.folder, ignore_errors=True)

    def run(self, *command):
        return run(*self.enter, *command)

    def ask(self, *command):
        done = subprocess.run([*self.enter, *command], env=self.env, capture_output=True, text=True, timeout=60)
        return done.returncode, done.stdout

    def browse(self, sort="_roverd._tcp"):
        """What avahi-browse finds: lists of interface, protocol, name, host, address, port, TXT."""
        lines = [line.split(";", 9) for line in self.ask("avahi-browse", "-rpt", sort)[1].splitlines()]
        return [[f[1], f[2], f[3], f[6], f[7], f[8], f[9]] for f in lines if f[0] == "=" and len(f) == 10]

    def names(self, sort="_roverd._tcp"):
        return sorted({found[2] for found in self.browse(sort)})

    def resolve(self, name, *options):
        """Addresses under which it is found there."""
        said = self.ask("avahi-resolve", *options, "-n", name)[1].split()
        return said[1:2]

    def curl(self, station, name, address):
        port = port_of(station)
        address = f"[{address}]" if ":" in address else address
        done = subprocess.run([*self.enter, "curl", "--silent", "--show-error", "--max-time", "10", "--noproxy", "*",
                               "--cacert", str(station.authority), "--resolve", f"{name}:{port}:{address}",
                               f"https://{name}:{port}/api/v1/health"], capture_output=True, text=True, timeout=30)
        return done.stdout + done.stderr


@contextlib.contextmanager
def robot_in_the_networks(*arguments, computer):
    os.environ["DBUS_SYSTEM_BUS_ADDRESS"] = computer.env["DBUS_SYSTEM_BUS_ADDRESS"]
    with Station(arguments=("--lan", *arguments)) as station:
        yield station


def log_of(station):
    return (station.scratch / "data/roverd.log").read_text(encoding="utf-8")


def not_announced(station):
    return [p["detail"] for p in station.rest.get("/health")["problems"] if p["id"] == "not_announced"]


def found_by_others():
    """another computer finds the robot by its name in both networks, over IPv4 and IPv6, at an address that comes
    later, too; with port, TXT record and a certificate for NAME.local; and not any more when it ended"""
    with Computer("robot") as robot, Computer("phone", networks=(1, 2)) as phone:
        robot.begin_avahi()
        phone.begin_avahi()
        with robot_in_the_networks(*named(name="kask"), computer=robot) as station:
            seen = until("the phone finds it in both networks, both ways", 60, lambda: found_everywhere(phone))
            for interface, way, name, _, address, port, txt in seen:
                check(name == "kask" and port == str(port_of(station)), seen)
                number = interface.removeprefix("net")
                right = (f"10.77.{number}.1",) if way == "IPv4" else (f"fd77:{number}::1", f"10.77.{number}.1")
                check(address in right or address.startswith("fe80:"), f"{interface} {way}: {address}")
                printed = station.roverd.wait_line(r"^fingerprint (\S+)$")[1]
                for fact in ('"path=/"', '"vehicle=bunker"', f'"fingerprint={printed}"', '"version='):
                    check(fact in txt, txt)
            check(phone.names("_https._tcp") == ["kask"], phone.browse("_https._tcp"))
            for options in (("-4",), ("-6",)):
                addresses = until(f"kask.local {options}", 30, lambda o=options: phone.resolve("kask.local", *o))
                check(addresses[0].startswith(("10.77.", "fd77:", "fe80:")), addresses)
            check('"status":"ok"' in phone.curl(station, "kask.local", "10.77.1.1").replace(" ", ""),
                  phone.curl(station, "kask.local", "10.77.1.1"))
            check(who(station)["host"] == "kask.local", who(station))
            check(not_announced(station) == [], not_announced(station))
            run("ip", "address", "del", "10.77.1.1/24", "dev", "net1")
            run("ip", "address", "add", "10.77.1.99/24", "dev", "net1")
            until("the phone finds the new address", 60,
                  lambda: any(one[4] == "10.77.1.99" for one in phone.browse()))
            run("ip", "address", "del", "10.77.1.99/24", "dev", "net1")
            run("ip", "address", "add", "10.77.1.1/24", "dev", "net1")
        until("it is gone", 30, lambda: phone.names() == [])


def found_everywhere(phone):
    seen = phone.browse()
    ways = {(one[0], one[1]) for one in seen}
    return seen if len(ways) == 4 else None


def a_daemon_that_comes_and_goes():
    """without an avahi-daemon that is said once in the log and in GET /health, which stays ok; the robot is told as
    soon as one runs, and again by the next"""
    with Computer("robot") as robot, Computer("phone") as phone:
        phone.begin_avahi()
        with robot_in_the_networks(*named(name="kask"), computer=robot) as station:
            until("it is said", 20, lambda: not_announced(station))
            check("no avahi-daemon runs" in not_announced(station)[0], not_announced(station))
            for _ in range(2):
                robot.begin_avahi()
                until("the phone finds it", 60, lambda: phone.names() == ["kask"])
                until("nothing is wrong", 20, lambda: not not_announced(station))
                robot.end_avahi()
                until("it is said again", 20, lambda: not_announced(station))
            check(log_of(station).count("no avahi-daemon runs") == 3, log_of(station))
            check(station.rest.get("/health")["status"] == "ok", station.rest.get("/health"))


def no_bus():
    """where there is no D-Bus at all that is said once, and the robot is as it is"""
    with Computer("robot") as robot:
        robot.env["DBUS_SYSTEM_BUS_ADDRESS"] = f"unix:path={robot.folder}/none"
        with robot_in_the_networks(computer=robot) as station:
            until("it is said", 20, lambda: not_announced(station))
            time.sleep(6)  # and one more try
            check(log_of(station).count("no avahi-daemon can be reached") == 1, log_of(station))


def a_daemon_that_hangs():
    """an avahi-daemon that hangs, since before the start or since the robot was told, keeps it from neither: it
    serves, and it ends as fast as ever"""
    for told in (True, False):
        with Computer("robot") as robot:
            robot.begin_avahi()
            hang = robot.daemon.process
            if not told:
                hang.send_signal(signal.SIGSTOP)
            with robot_in_the_networks(*named(name="kask"), computer=robot) as station:
                try:
                    if told:
                        until("it is found", 60, lambda: robot.names() == ["kask"])
                        hang.send_signal(signal.SIGSTOP)
                    check(station.rest.get("/health")["status"] == "ok", station.rest.get("/health"))
                    began = time.monotonic()
                    check(station.roverd.stop(seconds=60) == 0, station.roverd.said())
                    took_s = time.monotonic() - began
                finally:
                    hang.send_signal(signal.SIGCONT)
            since = "after it was told" if told else "before the start"
            print(f"with a daemon that hangs since {since} it ends in {took_s:.2f} s", flush=True)
            check(took_s < 5, f"{took_s:.1f} s")


def two_of_one_name():
    """the second robot of a name is NAME-2, in the network, on its page, in its certificate and in its log; it has
    another colour"""
    with Computer("robot") as robot, Computer("other") as other:
        robot.begin_avahi()
        other.begin_avahi()
        first = other.start(Program(*other.enter, BIN / "roverd", "--config", ROOT / "config/robot.toml", "--data",
                                    other.folder / "data", "--lan", "--port", "8123", *NO_DEVICES, *named(name="kask"),
                                    env=other.env))
        first.wait_line("^listening on ")
        until("the first is told", 60, lambda: robot.names() == ["kask"])
        with robot_in_the_networks(*named(name="kask"), computer=robot) as station:
            until("both are found", 60, lambda: other.names() == ["kask", "kask-2"])
            check(until("the host is told", 20, lambda: who(station)["host"]) == "kask-2.local", who(station))
            check(who(station)["name"] == "kask-2", who(station))
            check("another robot in this network is called kask: this one is kask-2" in log_of(station),
                  log_of(station))
            until("kask-2.local is in the certificate", 30,
                  lambda: "DNS:kask-2.local" in names_in_certificate(station))
            said = until("kask-2.local is found", 30, lambda: other.resolve("kask-2.local", "-4"))
            check(said == ["10.77.1.1"], said)
            check('"kask-2"' in other.curl(station, "kask-2.local", "10.77.1.1"), "another robot answers")


def be_avahi():
    """The daemon wants its folder to belong to avahi, a user that a namespace need not have: here that is root."""
    with tempfile.TemporaryDirectory() as scratch:
        for file in ("passwd", "group"):
            lines = [line for line in pathlib.Path("/etc", file).read_text().splitlines() if not line.startswith("avahi:")]
            entry = "avahi:x:0:0::/:/bin/false" if file == "passwd" else "avahi:x:0:"
            pathlib.Path(scratch, file).write_text("\n".join([entry, *lines]) + "\n")
            run("mount", "--bind", f"{scratch}/{file}", f"/etc/{file}")


def run_networks():
    be_avahi()
    run("mount", "-t", "tmpfs", "none", "/run")
    run("ip", "link", "set", "lo", "up")
    for number in (1, 2):
        run("ip", "link", "add", "name", f"net{number}", "type", "bridge")
        run("ip", "link", "set", f"net{number}", "up")
        run("ip", "address", "add", f"10.77.{number}.1/24", "dev", f"net{number}")
        run("ip", "-6", "address", "add", f"fd77:{number}::1/64", "dev", f"net{number}", "nodad")
    return run_cases(IN_NETWORKS)


CASES = [its_own_name, its_default_name, refusals]
IN_NETWORKS = [found_by_others, a_daemon_that_comes_and_goes, no_bus, a_daemon_that_hangs, two_of_one_name]


def in_networks():
    probe = subprocess.run([*INSIDE, "sh", "-c", "mount -t tmpfs none /run && ip link add name a type bridge"],
                           capture_output=True, text=True)
    missing = [name for name in ("avahi-daemon", "avahi-browse", "dbus-daemon") if shutil.which(name) is None]
    if probe.returncode == 0 and not missing:
        return subprocess.run([*INSIDE, sys.executable, __file__, "inside"]).returncode
    why = f"not installed: {' '.join(missing)}" if missing else \
        "this system permits no namespaces: " + " ".join(probe.stderr.split())
    for case in IN_NETWORKS:
        word = "not ok" if os.environ.get("CI") == "true" else "skip"
        print(f"{word} - {' '.join(case.__doc__.split())}: {why}", flush=True)
    return 1 if os.environ.get("CI") == "true" else 0


if __name__ == "__main__":
    if sys.argv[1:] == ["inside"]:
        sys.exit(run_networks())
    sys.exit(max(run_cases(CASES), in_networks()))
