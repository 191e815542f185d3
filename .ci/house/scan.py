"""Reads C++ as a compiler does before it compiles: what a file includes, and its words.

Lines joined by a backslash, comments wherever they may stand, raw strings, digraphs and digit
separators are taken as the standard's translation phases say (C++20 [lex.phases]), so that nothing
is hidden from the doors by the way it is written. Branches of #if are all read: what is switched
off today is included tomorrow.
"""

import re
from dataclasses import dataclass, field

SPLICE = re.compile(r"\\[ \t\f\v]*\r?\n")
NAME = re.compile(r"[A-Za-z_$\u0080-\U0010ffff][\w$\u0080-\U0010ffff]*")
NUMBER = re.compile(r"\.?[0-9](?:[eEpP][+-]|'?[\w.])*")
RAW = {"R", "u8R", "uR", "UR", "LR"}
PREFIXES = {"u8", "u", "U", "L"}


@dataclass
class Include:
    line: int
    how: str  # "include", "include_next", "import", "embed", "__has_include"
    quote: str  # '"', "<", or "" where a macro stands for the name
    name: str


@dataclass
class Source:
    includes: list = field(default_factory=list)
    words: list = field(default_factory=list)  # (line, token): names, numbers, punctuation
    strings: list = field(default_factory=list)  # (line, content)
    oddities: list = field(default_factory=list)  # (line, what nobody needs)


class Joined:
    """The text with spliced lines joined; every character knows its line."""

    def __init__(self, text):
        self.original = text
        chars, origin, at = [], [], 0
        for splice in SPLICE.finditer(text):
            chars.append(text[at:splice.start()])
            origin.extend(range(at, splice.start()))
            at = splice.end()
        chars.append(text[at:])
        origin.extend(range(at, len(text)))
        self.text = "".join(chars)
        self.origin = origin
        self.breaks = [m.start() for m in re.finditer("\n", text)]

    def line(self, at):
        from bisect import bisect_left
        place = self.origin[at] if at < len(self.origin) else len(self.original)
        return bisect_left(self.breaks, place) + 1

    def after(self, place):
        """The index of the first joined character at or behind an original one."""
        from bisect import bisect_left
        return bisect_left(self.origin, place)


class Scanner:
    def __init__(self, text):
        self.joined = Joined(text.replace("\ufeff", ""))
        self.text = self.joined.text
        self.at = 0
        self.source = Source()

    def run(self):
        fresh = True  # only white space and comments since the line's beginning
        while self.at < len(self.text):
            char = self.text[self.at]
            if char == "\n":
                fresh = True
                self.at += 1
            elif char.isspace() or self.comment():
                self.at += char.isspace()
            elif fresh and (char == "#" or self.text.startswith("%:", self.at)):
                self.at += 1 if char == "#" else 2
                self.directive()
                fresh = False
            else:
                fresh = False
                self.token()
        return self.source

    def comment(self):
        if self.text.startswith("//", self.at):
            end = self.text.find("\n", self.at)
            self.at = len(self.text) if end < 0 else end
        elif self.text.startswith("/*", self.at):
            end = self.text.find("*/", self.at + 2)
            self.at = len(self.text) if end < 0 else end + 2
        else:
            return False
        # Run-time white space is skipped by the caller; a comment counts as one blank.
        if self.at < len(self.text):
            self.at -= 0
        return True

    def blanks(self):
        while self.at < len(self.text):
            char = self.text[self.at]
            if char != "\n" and char.isspace():
                self.at += 1
            elif not self.comment():
                return

    def directive(self):
        line = self.joined.line(self.at)
        self.blanks()
        found = NAME.match(self.text, self.at)
        if not found:
            return
        self.at = found.end()
        if found[0] in ("include", "include_next", "import", "embed"):
            self.header(found[0], line)

    def header(self, how, line):
        """The header's name behind #include or inside __has_include(…)."""
        self.blanks()
        rest = self.text[self.at:]
        named = re.match(r'<([^>\n]+)>|"([^"\n]+)"', rest)
        if named:
            self.at += named.end()
            self.source.includes.append(Include(line, how, named[0][0], named[1] or named[2]))
        else:
            self.source.includes.append(Include(line, how, "", rest.split("\n", 1)[0].strip()))

    def token(self):
        line = self.joined.line(self.at)
        name = NAME.match(self.text, self.at)
        if name:
            self.at = name.end()
            self.name(name[0], line)
            return
        number = NUMBER.match(self.text, self.at)
        if number:
            self.at = number.end()
            self.source.words.append((line, number[0]))
        elif self.text[self.at] in "\"'":
            self.quoted(line)
        else:
            two = self.text[self.at:self.at + 2]
            mark = two if two in ("::", "->", "##") else self.text[self.at]
            self.at += len(mark)
            self.source.words.append((line, mark))

    def name(self, name, line):
        following = self.text[self.at:self.at + 1]
        if name in RAW and following == '"':
            self.raw(line)
        elif name in PREFIXES and following and following in "\"'":
            self.quoted(line)
        else:
            self.source.words.append((line, name))
            if name in ("__has_include", "__has_include_next", "__has_embed"):
                self.blanks()
                if self.text[self.at:self.at + 1] == "(":
                    self.at += 1
                    self.header(name, line)

    def quoted(self, line):
        quote = self.text[self.at]
        found = re.compile(rf"(?:\\.|[^{quote}\\\n])*", re.S).match(self.text, self.at + 1)
        if quote == '"':
            self.source.strings.append((line, found[0]))
        self.at = found.end() + (self.text[found.end():found.end() + 1] == quote)
        self.source.words.append((line, quote + quote))

    def raw(self, line):
        """A raw string is read from the original: nothing is joined in it."""
        original = self.joined.original
        begin = self.joined.origin[self.at] + 1
        opening = re.compile(r"([^()\\\s]{0,16})\(").match(original, begin)
        if not opening:
            self.at += 1
            return
        end = original.find(f'){opening[1]}"', opening.end())
        end = len(original) if end < 0 else end
        self.source.strings.append((line, original[opening.end():end]))
        self.source.words.append((line, '""'))
        self.at = self.joined.after(end + len(opening[1]) + 2)


MODULE = re.compile(r"^\s*(?:export\s+)?(?:import\s*(?:<[^>]*>|\"[^\"]*\"|[\w.:]+)\s*;|module\b\s*[\w.:]*\s*;)", re.M)


def scan(text):
    """What the C++ in `text` includes and says."""
    source = Scanner(text).run()
    for trigraph in re.finditer(r"\?\?[=/'()!<>-]", text):
        source.oddities.append((text.count("\n", 0, trigraph.start()) + 1, "a trigraph"))
    lines = {}
    for line, word in source.words:
        lines.setdefault(line, []).append(word)
    for line, words in lines.items():
        if MODULE.match(" ".join(words).replace(" :: ", "::")):
            source.oddities.append((line, "a module"))
    for line, word in source.words:
        if word in ("asm", "__asm__", "__asm"):
            source.oddities.append((line, "assembler"))
    return source
