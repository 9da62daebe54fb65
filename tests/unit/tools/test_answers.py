"""Answers from the bus are text of whoever answered: on a terminal they must not act."""

import argparse
from contextlib import nullcontext

import pytest

from tailor.tools.commands.run import goal, record

CLEARS_THE_SCREEN = "\x1b[2J"


class Impostor:
    connected = True

    def call(self, key, text):
        return False, f"{CLEARS_THE_SCREEN}accepted"

    def call_all(self, key, text):
        return [self.call(key, text)]


@pytest.mark.parametrize(("command", "words", "code"), [(goal, ["(at a)"], 2), (record, ["--write"], 1)])
def test_an_answer_is_printed_without_control_characters(monkeypatch, capsys, command, words, code):
    parser = argparse.ArgumentParser()
    command.configure(parser)
    monkeypatch.setattr(record, "stop_on_signals", lambda: None)
    monkeypatch.setattr(command, "open_bus", lambda *_, **__: nullcontext(Impostor()))
    assert command.run(parser.parse_args(words)) == code
    assert capsys.readouterr().err == "\\x1b[2Jaccepted\n"
