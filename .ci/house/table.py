"""The table of rooms.toml as objects: which room a file lives in, and what that room may do."""

import pathlib
import re
import tomllib
from dataclasses import dataclass, field

TABLE = pathlib.Path(__file__).with_name("rooms.toml")
TOPS = ("server", "drivers")


@dataclass
class Rights:
    """What a file may do. Doors are full names, "drivers/gnss:codec" for a codec alone."""
    doors: set = field(default_factory=set)
    headers: set = field(default_factory=set)
    libraries: list = field(default_factory=list)
    uses: set = field(default_factory=set)
    never: list = field(default_factory=list)


@dataclass
class Room:
    name: str
    is_what: str
    row: dict
    rights: Rights
    driver: Rights = None  # of a device's files named *driver*

    @property
    def top(self):
        return "/".join(self.name.split("/")[:2])

    @property
    def short(self):
        return self.name.split("/", 1)[1]

    def kind(self, path):
        return "driver" if self.driver and "driver" in pathlib.PurePath(path).name else "codec"

    def rights_of(self, path):
        return self.driver if self.driver and self.kind(path) == "driver" else self.rights


class Table:
    def __init__(self, file=TABLE):
        self.raw = tomllib.loads(file.read_text(encoding="utf-8"))
        self.headers = {name: set(text.split()) for name, text in self.raw["headers"].items()}
        self.libraries = {name: self.library(row) for name, row in self.raw["library"].items()}
        self.symbols = {name: [re.compile(p) for p in patterns]
                        for name, patterns in self.raw["symbol"].items()}
        self.rooms = {}
        rows = self.raw["room"]
        self.names = [row["name"] for row in rows]
        for row in sorted(rows, key=lambda r: r["name"].count("/")):
            self.rooms[row["name"]] = self.room(row)
        self.rooms = {name: self.rooms[name] for name in self.names}

    @staticmethod
    def library(row):
        symbols = row.get("symbols")
        return row["headers"].split(), re.compile(symbols) if symbols else None

    def room(self, row):
        name = row["name"]
        parent = self.rooms.get(name.rsplit("/", 1)[0])
        inherited = parent.row if parent and not name.startswith("web") else {}
        base = inherited | {k: v for k, v in row.items() if k not in ("name", "is")}
        driver = None
        if "device" in row:
            device = self.raw["device"]
            extra = row["device"]
            base = {key: device.get(key, []) + extra.get(key, [])
                    for key in ("doors", "headers", "libraries", "uses", "never")}
            more = device["driver"]
            driver = {key: base[key] + more.get(key, []) for key in base}
            driver["never"] = more["never"]
            # A codec meets codecs only; the driver sees the same ones.
            driver = self.rights(name, driver)
        row = row | {k: v for k, v in base.items() if k != "device"}
        return Room(name, row.get("is", ""), row, self.rights(name, row), driver)

    def rights(self, name, row):
        doors = set()
        for door in row.get("doors", []):
            doors |= self.opened(door)
        for door in row.get("but", []):
            doors -= self.opened(door)
        headers = set()
        for group in row.get("headers", []):
            headers |= self.headers.get(group, {group})
        return Rights(doors, headers, row.get("libraries", []),
                      {"plain", *row.get("uses", [])}, row.get("never", []))

    def opened(self, door):
        """The full names behind a door's word."""
        bare, _, part = door.partition(":")
        if bare == "*":
            return {n for n in self.names if n.startswith(TOPS)}
        if bare.endswith("/*"):
            return {n for n in self.names if n.startswith(bare[:-1]) and n != "drivers/sim"}
        for top in ("", "server/", "drivers/"):
            if top + bare in self.names:
                return {top + bare + (":" + part if part else "")}
        raise SystemExit(f"rooms.toml: a door to {door}, which is no room")

    def room_of(self, path):
        """The deepest room that holds a path relative to the repository, or None."""
        parts = pathlib.PurePath(path).parts[:-1]
        for length in range(len(parts), 0, -1):
            room = self.rooms.get("/".join(parts[:length]))
            if room:
                return None if room.row.get("loose") and length < len(parts) else room
        return None

    def is_open(self, room, rights, other, path):
        """Whether a file of `room` may include `path` of `other`."""
        if other is room:
            # A codec is pure whoever asks: it never sees its own driver.
            return not (room.driver and rights is room.rights and room.kind(path) == "driver")
        if other.name in rights.doors:
            return True
        if other.name + ":codec" in rights.doors:
            return other.kind(path) == "codec"
        # From outside, a door to a room opens the rooms inside it.
        if other.top == room.top:
            return False
        parent = other.name
        while "/" in parent:
            parent = parent.rsplit("/", 1)[0]
            if parent in rights.doors:
                return True
        return False

    def circle(self):
        """A circle among the top rooms, as a list of names, or None."""
        arrows = {}
        for room in self.rooms.values():
            for rights in filter(None, (room.rights, room.driver)):
                for door in rights.doors:
                    other = "/".join(door.split(":")[0].split("/")[:2])
                    if other != room.top and not room.name.startswith("web/src"):
                        arrows.setdefault(room.top, set()).add(other)
        done, path = set(), []

        def visit(name):
            if name in path:
                return path[path.index(name):] + [name]
            if name in done:
                return None
            path.append(name)
            for other in sorted(arrows.get(name, ())):
                found = visit(other)
                if found:
                    return found
            path.pop()
            done.add(name)
            return None

        for name in sorted(arrows):
            found = visit(name)
            if found:
                return found
        return None

    def library_of(self, header):
        """The names of all libraries that have this header."""
        return {name for name, (prefixes, _) in self.libraries.items()
                if any(header == p or (p.endswith("/") and header.startswith(p)) for p in prefixes)}

    def groups_of(self, symbol):
        """The groups of [symbol] and [library] that a demangled name belongs to."""
        found = {name for name, patterns in self.symbols.items()
                 if any(p.fullmatch(symbol) for p in patterns)}
        found |= {name for name, (_, pattern) in self.libraries.items()
                  if pattern and pattern.fullmatch(symbol)}
        return found
