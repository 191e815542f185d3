#!/usr/bin/env python3
"""The arguments of every command of roverd: what is wrong is said in one line, with exit code 2."""

import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
from station import BIN, ROOT, check, run_cases  # noqa: E402

# arguments → what the one line must say
WRONG = {
    ("decode",): "decode wants KIND and FILE (roverd decode --help)",
    ("decode", "bunker"): "decode wants KIND and FILE (roverd decode --help)",
    ("decode", "bunker", "a", "b"): "decode wants KIND and FILE (roverd decode --help)",
    ("decode", "tape", "-"): 'decode does not know "tape" (roverd decode --help)',
    ("decode", "--loud", "bunker", "-"): "decode: --loud is not known (roverd decode --help)",
    ("replay",): "replay: wants a FILE (roverd replay --help)",
    ("replay", "--report"): "replay: wants a FILE (roverd replay --help)",
    ("replay", "a.log", "--loud"): "replay: --loud is not known (roverd replay --help)",
    ("replay", "a.log", "--format", "pdf"): "must be csv or geojson",
    ("replay", "a.log", "--every", "nan"): "0 .. 3600",
    ("replay", "a.log", "--every", "-1"): "0 .. 3600",
    ("replay", "a.log", "--every", "3601"): "0 .. 3600",
    ("replay", "a.log", "--every", "1s"): "0 .. 3600",
    ("replay", "a.log", "--every"): "--every",
    ("replay", "a.log", "--set"): "--set",
    ("replay", "/nowhere/a.log"): "/nowhere/a.log",
    ("report",): "report: which runs?",
    ("report", "x"): '"x" is no run\'s number',
    ("report", "0"): '"0" is no run\'s number',
    ("report", "1.5"): '"1.5" is no run\'s number',
    ("report", "99999999999999999999"): "is no run's number",
    ("report", "--data"): "--data",
    ("report", "--loud", "1"): "report: --loud is not known (roverd report --help)",
    ("ntrip",): "usage: roverd ntrip table CASTER",
    ("ntrip", "table"): "usage: roverd ntrip table CASTER",
    ("ntrip", "list", "a"): "usage: roverd ntrip table CASTER",
    ("ntrip", "table", "host:99999"): "argument 1: ",
    ("ntrip", "table", "good.example", "http://x/"): "argument 2: ",
    ("backup", "roverd.db"): "usage: roverd backup [--data DIR] [--keep N] (roverd backup --help)",
    ("backup", "--keep", "0"): "--keep",
    ("failsafes", "page.md"): "usage: roverd failsafes",
    ("--port", "65536"): "--port",
    ("--replay-speed", "nan"): "0 .. 1000",
    ("--loud",): "--loud",
    ("loud",): "loud",
}


def run(*arguments):
    return subprocess.run([BIN / "roverd", *arguments], stdin=subprocess.DEVNULL, capture_output=True,
                          text=True, timeout=60, check=False, cwd=ROOT)


def wrong_ones_are_named():
    """each in one line on standard error, nothing on standard output"""
    for arguments, wanted in WRONG.items():
        done = run(*arguments)
        lines = done.stderr.splitlines()
        check(done.returncode == 2 and len(lines) == 1 and wanted in lines[0] and not done.stdout
              and lines[0].startswith("roverd: "),
              f"roverd {' '.join(arguments)}: {done.returncode} {lines} {done.stdout[:80]!r}")


def help_is_given():
    """every command tells its arguments and ends with 0"""
    for arguments, words in ((("--help",), ("--config", "--port", "decode", "replay", "report", "backup", "ntrip",
                                            "study")),
                             (("decode", "--help"), ("KIND", "FILE", "bunker", "nmea", "ubx", "mti", "sick", "vlp16")),
                             (("replay", "-h"), ("FILE", "--report", "--format", "--every", "--vehicle", "--set")),
                             (("report", "--help"), ("RUN", "--data")),
                             (("backup", "--help"), ("--data", "--keep")),
                             (("ntrip", "--help"), ("table",)),
                             (("ntrip", "table", "--help"), ("CASTER", "--json"))):
        done = run(*arguments)
        missing = [w for w in words if w not in done.stdout]
        check(done.returncode == 0 and not missing and not done.stderr, f"{arguments}: {missing} {done.stderr}")


def options_and_files_may_be_mixed():
    """an option's value never swallows the file behind it"""
    with tempfile.TemporaryDirectory() as folder:
        tape = pathlib.Path(folder) / "gnss.log"
        tape.write_text("")
        for arguments in (("--set", "nav.speed.max_mps=1", tape), (tape, "--set", "nav.speed.max_mps=1"),
                          ("--every", "0", tape, "--report")):
            done = run("replay", *map(str, arguments))
            check("wants a FILE" not in done.stderr and "gnss.log" in done.stderr, f"{arguments}: {done.stderr}")


if __name__ == "__main__":
    sys.exit(run_cases([wrong_ones_are_named, help_is_given, options_and_files_may_be_mixed]))
