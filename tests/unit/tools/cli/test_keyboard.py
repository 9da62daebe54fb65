"""Keys that are pressed faster than they are asked for come one after another."""

from __future__ import annotations

import pytest

from tailor.tools.cli.keyboard import Keyboard


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
