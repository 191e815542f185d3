"""Starts the real programs for tests and talks to them; Python's standard library only.

    with Station() as station:            # roverd-sim and roverd on free ports
        station.rest("GET", "/vehicle")
"""

import contextlib
import json
import os
import pathlib
import re
import shutil
import signal
import socket
import sqlite3
import ssl
import subprocess
import tempfile
import threading
import time
import urllib.error
import urllib.request

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = pathlib.Path(os.environ.get("ROVERD_BIN", ROOT / "build/bin"))


class Failed(Exception):
    """A test's claim that does not hold."""


def check(claim, message):
    if not claim:
        raise Failed(message)


def until(what, seconds, ask, pause=0.05):
    """Asks until the answer is true; what it was is returned. @param what for the failure's text."""
    end = time.monotonic() + seconds
    while True:
        answer = ask()
        if answer:
            return answer
        if time.monotonic() > end:
            raise Failed(f"not within {seconds} s: {what}")
        time.sleep(pause)


def reset_stop(caller, body=None):
    """Where the program hung for half a second, what reaches it then may be older than the last stop, and
    is refused as late: whoever looks clicks again. @param caller has call()"""
    def asked():
        status, *_, answer = caller.call("POST", "/vehicle/estop/reset", {} if body is None else body)
        check(status == 200 or (status == 409 and answer["title"] == "Too late"),
              f"a reset answers {status}: {answer}")
        return status == 200

    until("the stop is reset", 10, asked, 0.2)


def hear_ctrl_c():
    """Where the tests were started in the background, Ctrl-C is ignored, and children inherit that."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


class Program:
    """A child process whose output lines are kept."""

    def __init__(self, *arguments, env=None, cwd=None):
        self.name = pathlib.Path(str(arguments[0])).name
        self.lines = []
        self.errors = []
        self.process = subprocess.Popen([str(a) for a in arguments], stdin=subprocess.DEVNULL,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                        errors="replace", env=env, cwd=cwd, start_new_session=True,
                                        preexec_fn=hear_ctrl_c)
        self.readers = [threading.Thread(target=self._read, args=pair, daemon=True) for pair in
                        ((self.process.stdout, self.lines), (self.process.stderr, self.errors))]
        for reader in self.readers:
            reader.start()

    @staticmethod
    def _read(stream, lines):
        for line in stream:
            lines.append(line.rstrip("\n"))

    def wait_line(self, pattern, seconds=30):
        """The match of the first line of stdout that fits."""
        def found():
            for line in list(self.lines):
                match = re.search(pattern, line)
                if match:
                    return match
            if self.process.poll() is not None:
                raise Failed(f"{self.name} ended with {self.process.returncode}: {self.said()}")
            return None
        return until(f"{self.name} says /{pattern}/; it said: {self.said()}", seconds, found, 0.02)

    def said(self):
        return " | ".join((self.lines + self.errors)[-8:])

    def wait_exit(self, seconds):
        try:
            code = self.process.wait(seconds)
        except subprocess.TimeoutExpired:
            raise Failed(f"{self.name} still runs after {seconds} s: {self.said()}") from None
        for reader in self.readers:
            reader.join(2)
        return code

    def stop(self, how=signal.SIGTERM, seconds=10):
        """@return its exit code."""
        if self.process.poll() is None:
            self.process.send_signal(how)
        try:
            return self.wait_exit(seconds)
        except Failed:
            self.process.kill()
            self.process.wait()
            raise


class Control:
    """The simulator's side channel: JSON lines. roverd never reads it."""

    def __init__(self, address):
        host, port = address.rsplit(":", 1)
        self.socket = socket.create_connection((host, int(port)), 10)
        self.file = self.socket.makefile("rw", encoding="utf-8", newline="\n")
        self.ask({"set": {"truth_hz": 0}})

    def ask(self, request):
        self.file.write(json.dumps(request) + "\n")
        self.file.flush()
        while True:
            answer = json.loads(self.file.readline())
            if "error" in answer:
                raise Failed(f"the simulator refuses {request}: {answer['error']}")
            if "ok" in answer:  # other lines are the truth it sends by itself
                return answer

    def close(self):
        self.file.close()
        self.socket.close()


class Rest:
    """The API of one running roverd."""

    def __init__(self, address, authority=None):
        """@param authority PEM file of whom to trust, for https"""
        self.address = address
        self.trust = ssl.create_default_context(cafile=authority) if authority else None

    def call(self, method, path, body=None, headers=None, seconds=30):
        """@param body bytes go as they are, anything else as JSON. @return status, headers, body
        (JSON decoded where it says so)."""
        url = self.address + (path if path.startswith("/api/") else "/api/v1" + path)
        data = body if body is None or isinstance(body, bytes) else json.dumps(body).encode()
        request = urllib.request.Request(url, data=data, method=method, headers=dict(headers or {}))
        if data is not None and not request.has_header("Content-type"):
            request.add_header("Content-Type", "application/json")
        try:
            with urllib.request.urlopen(request, timeout=seconds, context=self.trust) as answer:
                return answer.status, answer.headers, self._decode(answer)
        except urllib.error.HTTPError as error:
            with error:
                return error.code, error.headers, self._decode(error)

    @staticmethod
    def _decode(answer):
        text = answer.read()
        if "json" in answer.headers.get("Content-Type", ""):
            return json.loads(text)
        return text

    def get(self, path):
        status, _, body = self.call("GET", path)
        check(status == 200, f"GET {path} answers {status}: {body}")
        return body

    def do(self, method, path, body=None, headers=None):
        """A call that must succeed. @return the decoded answer."""
        status, _, answer = self.call(method, path, body, headers)
        check(200 <= status < 300, f"{method} {path} answers {status}: {answer}")
        return answer


class Station:
    """roverd-sim and roverd, each on free ports, with a data folder of their own."""

    def __init__(self, can=None, seed=1, sim=(), arguments=(), config=None, data=None,
                 authority=None):
        """@param authority whom to trust with --tls, if it is not roverd's own"""
        self.scratch = pathlib.Path(tempfile.mkdtemp(prefix="roverd-test."))
        self.sim = self.roverd = self.control = None
        try:
            bus = ("--can", can) if can else ("--cansock", self.scratch / "can")
            self.sim = Program(BIN / "roverd-sim", *bus, "--gnss", "tcp:0", "--control", "0",
                               "--seed", seed, *sim)
            ready = self.sim.wait_line(r"^ready can=(\S+) gnss=(\S+)(?: mti=(\S+))? control=(\S+)")
            self.control = Control(ready[4])
            self.control_address = ready[4]
            self.roverd = Program(BIN / "roverd", "--config", config or ROOT / "config/robot.toml",
                                  "--data", data or self.scratch / "data", "--port", "0",
                                  "--set", f"drivers.bunker.link={ready[1]}",
                                  "--set", f"drivers.gnss.link={ready[2]}",
                                  *(("--set", f"drivers.mti.link={ready[3]}") if ready[3] else ()),
                                  *arguments)
            self.address = self.roverd.wait_line(r"^listening on (https?://\S+)")[1]
            own = pathlib.Path(data or self.scratch / "data") / "tls/authority.pem"
            self.authority = authority or (own if self.address.startswith("https:") else None)
            self.rest = Rest(self.address, self.authority)
        except BaseException:
            self.close()
            raise

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        try:
            if self.control:
                self.control.close()
            for program in (self.roverd, self.sim):
                if program:
                    program.stop()
        finally:
            shutil.rmtree(self.scratch, ignore_errors=True)


def make_large(database, megabytes):
    """A table of noise in the database of a roverd that does not run."""
    with contextlib.closing(sqlite3.connect(database)) as connection, connection:
        connection.execute("CREATE TABLE noise (bytes BLOB)")
        connection.executemany("INSERT INTO noise VALUES (randomblob(2000))", [()] * (500 * megabytes))


def said_by(explain):
    """What explain says; a robot that does not answer any more must not hide why the case failed."""
    try:
        return list(explain()) if explain else []
    except Exception as error:
        return [f"nothing more is known: {error}"]


def run_cases(cases, explain=None):
    """Runs functions in order; a docstring is the case's name. @param explain lines that tell how things
    stood when a case failed, or none. With SECOND_TRY=yes a case that failed is tried once more, and that is
    told; not where something was touched or a program ended. @return the exit code."""
    again = os.environ.get("SECOND_TRY") == "yes"
    return 0 if all([passes(case, explain, again) for case in cases]) else 1


def passes(case, explain, again):
    """@param again whether it will be tried once more, if it fails."""
    name = " ".join((case.__doc__ or case.__name__).split())
    begin = time.monotonic()
    try:
        case()
        print(f"ok - {name} ({time.monotonic() - begin:.1f} s)", flush=True)
        return True
    except Exception as error:  # any way to fail is a failure of this case
        cause = " ".join(str(error).split()) or type(error).__name__
        again = again and not re.search(r"touch|contact|ended|exit|did not stop", cause)
        print(f"{'again' if again else 'not ok'} - {name}: {cause}", flush=True)
        for line in said_by(explain):
            print(f"# {line}", flush=True)
        if again:
            return passes(case, explain, False)
    return False
