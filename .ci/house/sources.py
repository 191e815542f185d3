"""Checks every source of the house against the table: includes, words, files, sizes, imports."""

import json
import pathlib
import re
import subprocess

from scan import scan
from table import TOPS

UNFINISHED = re.compile(r"\b(TO" r"DO|FIX" r"ME|XX" r"X|HA" r"CK)\b")
SIZE_ADVICE, SIZE_LIMIT = 400, 600
SOURCES = {".cpp", ".hpp", ".ts", ".mjs", ".svelte", ".css", ".py", ".sh", ".js"}
CPP = {".cpp", ".hpp"}
# What else may lie in a room; the compiler reads none of it.
BESIDE = {".cmake", ".json", ".in", ".txt", ".md"}
CPP_LIKE = re.compile(r"\.(c|cc|cxx|c\+\+|C|h|hh|hxx|h\+\+|H|inc|inl|ipp|tpp|txx|ixx|cppm|cu|m|mm|s|S|def)$")
GENERATED = {"app/version.hpp"}
WEB_TOPS = ("web/src/", "web/tests/", "tests/page/")
PICTURES = {".png", ".svg", ".webmanifest"}


class House:
    def __init__(self, root, table, repository):
        self.root, self.table, self.repository = root, table, repository
        self.findings, self.advice = [], []

    def find(self, path, line, cause):
        self.findings.append(f"{path}:{line}: {cause}")

    def check(self, names):
        """@param names paths of all files, relative to the root, as text."""
        circle = self.table.circle()
        if circle:
            self.find(".ci/house/rooms.toml", 1, f"doors in a circle: {' → '.join(circle)}")
        inhabited = set()
        for name in names:
            path = pathlib.PurePosixPath(name)
            if path.parts[0] in TOPS:
                inhabited.add(self.room_file(name))
            elif path.parts[0] == "tests" and not name.startswith("tests/page/"):
                self.test_file(name)
            self.any_file(name)
        self.web([n for n in names if n.startswith(WEB_TOPS)])
        inhabited |= {r and r.name for r in map(self.table.room_of, names)}
        for empty in sorted(set(self.table.names) - inhabited):
            self.find(".ci/house/rooms.toml", 1, f"{empty} stands in the table and holds no file")
        return self.findings

    def text(self, name):
        return (self.root / name).read_text(encoding="utf-8", errors="replace")

    def room_file(self, name):
        path = pathlib.PurePosixPath(name)
        room = self.table.room_of(name)
        if (self.root / name).is_symlink():
            self.find(name, 1, "a file lives in its room; no symbolic links")
        if room is None:
            if path.name != "CMakeLists.txt" or len(path.parts) > 2:
                self.find(name, 1, f"{path.parent} is no room of this house")
        elif CPP_LIKE.search(path.name):
            self.find(name, 1, "sources here end in .cpp, headers in .hpp")
            self.cpp(name, room)
        elif path.suffix in CPP:
            self.cpp(name, room)
        elif path.suffix not in BESIDE:
            self.find(name, 1, f"{path.name} is of no kind that belongs in a room")
        return room and room.name

    # ---- C++

    def cpp(self, name, room):
        rights = room.rights_of(name)
        text = self.text(name)
        source = scan(text)
        for include in source.includes:
            cause = self.include(include, name, room, rights)
            if cause:
                self.find(name, include.line, cause)
        for line, what in source.oddities:
            self.find(name, line, f"{what} in {room.short}")
        for rule in rights.never:
            self.words(name, source, text, self.table.raw["never"][rule])
        self.foreign(name, source)

    def include(self, include, name, room, rights):
        """The cause why an include is refused, or None."""
        if not include.quote:
            return f"an include names its header, not {include.name[:40]!r}"
        if include.how in ("include_next", "import", "embed"):
            return f"#{include.how} is not used here"
        header = include.name
        owned = self.ours(header)
        if owned or include.quote == '"':
            return self.own_include(header, owned, room, rights)
        if header in rights.headers:
            return None
        libraries = self.table.library_of(header)
        if libraries & set(rights.libraries):
            return None
        return f"{room.short} does not use <{header}>"

    def ours(self, header):
        """Where a header of ours lies, relative to the root; None if it is not ours."""
        for top in TOPS:
            if (self.root / top / header).exists():
                return f"{top}/{header}"
        return None

    def own_include(self, header, owned, room, rights):
        parts = pathlib.PurePosixPath(header).parts
        if ".." in parts or "." in header.split("/") or header.startswith("/") or "//" in header or "\\" in header:
            return f'an include names its room ("base/time.hpp"), not the way to it: "{header}"'
        if header in GENERATED and header.split("/")[0] == room.short:
            return None
        if owned is None:
            return f'an include names its room ("base/time.hpp"); there is no "{header}"'
        if not header.endswith(".hpp"):
            return f'what is included is a header: "{header}"'
        other = self.table.room_of(owned)
        if other is None:
            return f'"{header}" lies in no room'
        if not self.table.is_open(room, rights, other, owned):
            if other is room or (other.driver and other.name + ":codec" in rights.doors):
                return f"{room.short} has no door to a driver: {header}"
            return f"{room.short} has no door to {other.short}"
        return None

    def words(self, name, source, text, rule):
        if "words" in rule:
            lines, joined = [], []
            at = 0
            for line, word in source.words:
                lines.append((at, line))
                joined.append(word)
                at += len(word) + 1
            joined = " ".join(joined)
            for found in re.finditer(rule["words"], joined):
                line = next(n for a, n in reversed(lines) if a <= found.start())
                self.find(name, line, f"{rule['cause']}: {found[0]}")
        if "strings" in rule:
            whole = "\n".join(content for _, content in source.strings)
            for line, content in source.strings:
                if re.search(rule["strings"], content):
                    self.find(name, line, f"{rule['cause']}: {content.strip()[:60]}")
                    break
            else:
                if re.search(rule["strings"], whole):
                    self.find(name, source.strings[0][0], f"{rule['cause']}, not in pieces either")
        if "text" in rule:
            for number, line in enumerate(text.splitlines(), 1):
                if re.search(rule["text"], line):
                    self.find(name, number, f"{rule['cause']}: {line.strip()[:60]}")

    def foreign(self, name, source):
        """A function of others is declared by its header, never by hand."""
        words = source.words
        for at, (line, word) in enumerate(words[:-1]):
            if word == "extern" and words[at + 1][1] == '""':
                self.find(name, line, 'extern "C": include the header that declares it')

    # ---- tests

    def test_file(self, name):
        path = pathlib.PurePosixPath(name)
        if path.suffix not in CPP:
            if CPP_LIKE.search(path.name) and not name.startswith("tests/data/"):
                self.find(name, 1, "sources here end in .cpp, headers in .hpp")
            return
        source = scan(self.text(name))
        for include in source.includes:
            cause = self.test_include(include, name)
            if cause:
                self.find(name, include.line, cause)
        for line, what in source.oddities:
            self.find(name, line, f"{what} in a test")

    def test_include(self, include, name):
        if not include.quote:
            return f"an include names its header, not {include.name[:40]!r}"
        if include.how in ("include_next", "import", "embed"):
            return f"#{include.how} is not used here"
        owned = self.ours(include.name)
        if owned is None:
            if include.quote != '"':
                return None
            beside = [self.root / name, *self.test_folders(name)]
            beside[0] = beside[0].parent
            found = [b / include.name for b in beside if (b / include.name).exists()]
            if not found:
                return f'there is no "{include.name}"'
            inside = found[0].resolve().relative_to(self.root.resolve()).parts[0]
            return None if inside == "tests" else f'an include names its room, not the way to it: "{include.name}"'
        if not include.name.endswith(".hpp"):
            return f'what is included is a header: "{include.name}"'
        parts = pathlib.PurePosixPath(name).parts
        if parts[1] != "unit":
            return None
        return self.unit_include(parts[2], owned)

    def test_folders(self, name):
        parts = pathlib.PurePosixPath(name).parts
        return [self.root / "tests", self.root / "tests" / "loop", self.root / "/".join(parts[:3])]

    def unit_include(self, unit, owned):
        """A unit test sees the room that it tests and what that room may see."""
        seen = {"server/base", "drivers/link"}
        table = self.table
        for word in [unit, *table.raw["tests"]["unit"].get(unit, [])]:
            try:
                rooms = table.opened(word)
            except SystemExit:
                continue
            for name in rooms:
                room = table.rooms[name.split(":")[0]]
                seen |= {room.name} | {d.split(":")[0] for d in room.rights.doors}
                seen |= {d.split(":")[0] for d in room.driver.doors} if room.driver else set()
        other = table.room_of(owned)
        names = {other.name, other.top} if other else set()
        return None if names & seen else f"a unit test of {unit} does not see {owned}"

    # ---- the page

    def web(self, names):
        names = [n for n in names if not n.endswith((".d.ts", ".json"))
                 and pathlib.PurePosixPath(n).suffix not in PICTURES]
        if not names:
            return
        rooms = []
        for room in self.table.rooms.values():
            if not room.name.startswith(("web/", "tests/page")):
                continue
            row = room.row
            rooms.append({
                "name": room.name, "doors": sorted(room.rights.doors), "packages": row["packages"],
                "test_packages": ["vitest", "node:*"], "browser": row["browser"],
                "browser_words": row.get("browser_words", []), "loose": row.get("loose", False)})
        words = {"network": self.table.raw["web"]["network"].split(), "network_room": "web/src/link"}
        asked = json.dumps({"rooms": rooms, "files": names, "words": words})
        told = subprocess.run(["node", pathlib.Path(__file__).with_name("web.mjs"), self.root, self.repository],
                              input=asked, capture_output=True, text=True, check=False)
        if told.returncode:
            lost = "Cannot find module" in told.stderr
            self.find("web", 1, "its packages are not here: npm --prefix web ci" if lost
                      else "cannot be checked: " + told.stderr.strip().splitlines()[-1])
            return
        for finding in json.loads(told.stdout):
            self.find(finding["file"], finding["line"], finding["cause"])

    # ---- every file

    def any_file(self, name):
        path = self.root / name
        if path.suffix not in SOURCES and path.name not in ("run", "test", "doors"):
            return
        lines = self.text(name).splitlines()
        for number, line in enumerate(lines, 1):
            if UNFINISHED.search(line):
                self.find(name, number, f"unfinished: {line.strip()[:80]}")
        if len(lines) > SIZE_LIMIT:
            self.find(name, len(lines), f"{len(lines)} lines; {SIZE_LIMIT} is the limit, "
                                        f"{SIZE_ADVICE} the aim: find the missing noun")
        elif len(lines) > SIZE_ADVICE:
            self.advice.append(f"{name}: {len(lines)} lines")
