"""What a program that was killed left on the disk."""

import shutil
import sqlite3

from station import check


def examine(data, copy, when):
    """A copy of the files, as the cut left them: to open them is to mend them.
    @param copy a folder that is not there yet; it is removed again"""
    copy.mkdir()
    for file in data.glob("roverd.db*"):
        shutil.copy(file, copy)
    database = sqlite3.connect(copy / "roverd.db")
    verdict = database.execute("PRAGMA integrity_check").fetchall()
    strays = database.execute("PRAGMA foreign_key_check").fetchall()
    database.close()
    shutil.rmtree(copy)
    check(verdict == [("ok",)] and not strays, f"{when}: {verdict[:3]} {strays[:3]}")
