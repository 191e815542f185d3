#!/usr/bin/env python3
"""Starts user-mode-linux so that it runs on every x86-64 processor. Usage: uml.py PROGRAM ARGUMENT…

Debian's 6.1 restores a process's vector registers with PTRACE_SETREGSET of NT_X86_XSTATE and a buffer
of the size known before AMX; on a processor with more state the host refuses that, and the kernel
panics. Where the call does not work at all from the beginning it uses the older FXSAVE calls. So a
filter answers these two calls with EIO, for the started program and its children alone: no rights
are needed. FXSAVE does not keep the wide vector registers: nothing inside may use AVX (./run sees to
that).

Exit code 3: the filter cannot be installed here; nothing was started.
"""

import ctypes
import errno
import os
import struct
import sys

SYS_PTRACE = 101
PTRACE_GETREGSET, PTRACE_SETREGSET = 0x4204, 0x4205
NT_X86_XSTATE = 0x202
PR_SET_SECCOMP, PR_SET_NO_NEW_PRIVS = 22, 38
SECCOMP_MODE_FILTER = 2

# Classic BPF over struct seccomp_data: the call's number at 0, its six arguments from 16, 8 bytes each.
LOAD, JUMP_IF_EQUAL, RETURN = 0x20, 0x15, 0x06
NUMBER, FIRST, THIRD = 0, 16, 32
ALLOW, ANSWER_EIO = 0x7FFF0000, 0x00050000 | errno.EIO
FILTER = (  # code, steps if true, steps if false, value
    (LOAD, 0, 0, NUMBER),
    (JUMP_IF_EQUAL, 0, 6, SYS_PTRACE),
    (LOAD, 0, 0, FIRST),
    (JUMP_IF_EQUAL, 1, 0, PTRACE_GETREGSET),
    (JUMP_IF_EQUAL, 0, 3, PTRACE_SETREGSET),
    (LOAD, 0, 0, THIRD),
    (JUMP_IF_EQUAL, 0, 1, NT_X86_XSTATE),
    (RETURN, 0, 0, ANSWER_EIO),
    (RETURN, 0, 0, ALLOW),
)


class Program(ctypes.Structure):
    """struct sock_fprog"""
    _fields_ = [("length", ctypes.c_ushort), ("filter", ctypes.c_void_p)]


def refuse(why):
    print(f"uml.py: {why}", file=sys.stderr)
    sys.exit(3)


def main():
    libc = ctypes.CDLL(None, use_errno=True)
    code = ctypes.create_string_buffer(b"".join(struct.pack("=HBBI", *step) for step in FILTER))
    program = Program(len(FILTER), ctypes.addressof(code))
    if os.uname().machine != "x86_64":
        refuse(f"for x86_64, not {os.uname().machine}")
    if libc.prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 or libc.prctl(
            PR_SET_SECCOMP, SECCOMP_MODE_FILTER, ctypes.byref(program), 0, 0) != 0:
        refuse(f"no seccomp filter here: {os.strerror(ctypes.get_errno())}")
    # Without the filter: ESRCH, for there is no process 0.
    ctypes.set_errno(0)
    libc.syscall(SYS_PTRACE, PTRACE_GETREGSET, 0, NT_X86_XSTATE, 0)
    if ctypes.get_errno() != errno.EIO:
        refuse(f"the filter does not act: {os.strerror(ctypes.get_errno())}")
    os.execvp(sys.argv[1], sys.argv[1:])


if __name__ == "__main__":
    main()
