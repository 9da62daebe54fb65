"""A command that runs until it is stopped says so once it works; under a supervisor, which shows that, it does not."""

from argparse import Namespace
from contextlib import nullcontext
from types import SimpleNamespace

import pytest

from tailor.runtime.processes.notify import Notifier
from tailor.tools.commands.look import scene
from tailor.tools.commands.run import gateway

STOPPED = SimpleNamespace(requested=True)
WORDS = {"listen": "tcp/127.0.0.1:9", "keys": None, "only": ["people"], "sender": ""}


def opening_nothing(monkeypatch, command, supervised):
    """Words of the command, where everything that it opens is there, and a stop is requested at once."""
    notifier = Notifier.from_environment({})
    monkeypatch.setattr(Notifier, "supervised", property(lambda _: supervised))
    put = {
        "Notifier": SimpleNamespace(from_environment=lambda: notifier),
        "bus_settings": lambda _: SimpleNamespace(endpoint="tcp/127.0.0.1:9"),
        "run_folder": lambda _: SimpleNamespace(running=lambda: True),
        "open_gateway": lambda *_: nullcontext(),
        "open_run": lambda *_: nullcontext(SimpleNamespace(session=None)),
        "publish_scenes": lambda *_: None,
        "opened_anew": lambda *_: None,
        "BusRenewal": lambda _: None,
        "codec": SimpleNamespace(prime=lambda: None),
        "set_for_host": lambda: None,
        "stop_on_signals": lambda: STOPPED,
        "resource": SimpleNamespace(RLIMIT_NOFILE=0, getrlimit=lambda _: (1, 1), setrlimit=lambda *_: None),
    }
    for name, value in put.items():
        monkeypatch.setattr(command, name, value, raising=False)
    monkeypatch.setattr("os.nice", lambda _: 0)
    return Namespace(**WORDS)


@pytest.mark.parametrize(
    ("command", "run", "line"),
    [
        (gateway, gateway.run, "tcp/127.0.0.1:9 lets in people; Ctrl-C ends it\n"),
        (scene, scene._live, "publishing scenes on tcp/127.0.0.1:9; Ctrl-C stops\n"),
    ],
)
@pytest.mark.parametrize("supervised", [False, True])
def test_a_command_that_goes_on_says_that_it_works(monkeypatch, capsys, command, run, line, supervised):
    assert run(opening_nothing(monkeypatch, command, supervised)) == 0
    assert capsys.readouterr().out == ("" if supervised else line)
