"""The last lines of the demonstration."""

import shutil
import sys
from pathlib import Path

import pytest

from tailor.tools.commands.run.demo import next_lines


@pytest.mark.parametrize(("found", "command"), [("/usr/bin/tailor", "tailor"), (None, ".venv/bin/tailor")])
def test_the_next_commands_can_be_copied_without_an_active_environment(monkeypatch, found, command):
    monkeypatch.setattr(shutil, "which", lambda name: found)
    monkeypatch.setattr(sys, "argv", [".venv/bin/tailor", "demo"])
    commands = [line for line in next_lines(Path("out/demo")) if line.startswith("next: ")]
    assert len(commands) == 4
    assert all(line.startswith(f"next: {command} ") for line in commands)
