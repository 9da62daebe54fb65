"""Keys that are pressed faster than they are asked for come one after another; a shell's job control loses none."""

from __future__ import annotations

import os
import pty
import subprocess
import sys
import termios

import pytest

from tailor.tools.cli.keyboard import Keyboard
from tests.support.patience import PATIENCE_S, wait_until

IN_THE_BACKGROUND = """
import os, pty
from tailor.tools.cli.keyboard import Keyboard
shell, _ = pty.fork()
if shell:
    os._exit(os.waitstatus_to_exitcode(os.waitpid(shell, 0)[1]))
if (job := os.fork()) == 0:
    os.setpgid(0, 0)
    with Keyboard() as keyboard:
        os._exit(keyboard.there or keyboard.read() != b"")
_, status = os.waitpid(job, os.WUNTRACED)
os._exit(2 if os.WIFSTOPPED(status) else os.waitstatus_to_exitcode(status))
"""


class Typed(Keyboard):
    """A keyboard from which these bytes are read, one portion a time."""

    def __init__(self, *portions):
        super().__init__()
        self.portions = list(portions)

    def read(self):
        return self.portions.pop(0) if self.portions else b""


@pytest.mark.parametrize(
    ("portions", "names"),
    [
        ([b" ", b"", b"q"], ["space", "", "quit"]),
        ([b"s q"], ["right", "space", "quit"]),
        ([b"\x1b[A\x1b[A\x1b[", b"Bq"], ["up", "up", "down", "quit"]),
        ([b"x\x1bzq"], ["quit"]),
        ([b"\x1b", b"", b"q"], ["", "", "quit"]),
    ],
)
def test_no_key_is_lost(portions, names):
    keyboard = Typed(*portions)
    assert [keyboard.pressed() for _ in names] == names
    assert keyboard.pressed() == ""


def test_a_key_is_heard_without_enter_again_after_the_shell_had_the_terminal(monkeypatch):
    """After Ctrl-Z and `fg`, the stop key of `tailor status` waited for Enter."""
    ours, theirs = pty.openpty()
    for_lines = termios.tcgetattr(theirs)
    with open(theirs) as terminal, monkeypatch.context() as patched:
        patched.setattr(sys, "stdin", terminal)
        with Keyboard() as keyboard:
            termios.tcsetattr(theirs, termios.TCSANOW, for_lines)
            os.write(ours, b"s")
            wait_until(lambda: keyboard.read() == b"s", "the key")
        assert termios.tcgetattr(theirs) == for_lines
    os.close(ours)


def test_a_program_in_the_background_leaves_the_terminal_alone():
    """The system stopped `tailor replay run.mcap &` at once."""
    subprocess.run([sys.executable, "-c", IN_THE_BACKGROUND], check=True, timeout=PATIENCE_S)
