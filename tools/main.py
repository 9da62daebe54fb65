"""The `tailor` command: a table of commands, each in a module of its own that is loaded when it is called."""

from __future__ import annotations

import argparse
import importlib
import sys
from collections.abc import Sequence
from typing import NoReturn

from tailor import __version__
from tailor.schemas.errors import UsageError
from tailor.tools.cli.plain_text import plain

# command -> (module, one line of help); the modules offer configure(parser) and run(arguments) -> exit code
COMMANDS: dict[str, tuple[str, str]] = {
    "up": ("tailor.tools.commands.run.up", "start a whole system: bus, simulator, executive, recorder"),
    "demo": ("tailor.tools.commands.run.demo", "greedy against refined from the same seed, with a picture"),
    "letters": ("tailor.tools.commands.run.letters", "the arm writes capitals, with and without refined velocities"),
    "bus": ("tailor.tools.commands.run.bus", "run the bus router alone"),
    "sim": ("tailor.tools.commands.run.sim", "run a simulated robot on the bus"),
    "executive": ("tailor.tools.commands.run.executive", "run the executive on the bus"),
    "goal": ("tailor.tools.commands.run.goal", "send a PDDL goal to a running executive"),
    "arm": ("tailor.tools.commands.run.arm", "let a driver obey the running executive"),
    "estop": ("tailor.tools.commands.run.estop", "stop every driver until it is reset"),
    "record": ("tailor.tools.commands.run.record", "record the bus into an MCAP file"),
    "replay": ("tailor.tools.commands.look.replay", "play a recording on the bus"),
    "info": ("tailor.tools.commands.look.info", "what a recording holds"),
    "recover": ("tailor.tools.commands.look.recover", "make a whole recording of a damaged one"),
    "cut": ("tailor.tools.commands.look.cut", "cut a span of time or some topics out of a recording"),
    "compare": ("tailor.tools.commands.look.compare", "two recorded runs side by side"),
    "verify": ("tailor.tools.commands.look.verify", "feed a recording through today's core and compare bit for bit"),
    "picture": (
        "tailor.tools.commands.look.picture",
        "draw the paths of recordings in the manner of the paper's Figure 1",
    ),
    "view": ("tailor.tools.commands.look.view", "show a run as a page, of a recording or live"),
    "why": ("tailor.tools.commands.look.why", "say why subgoals were chosen, and what greedy would have done"),
    "plan": ("tailor.tools.commands.run.plan", "plan with PDDL files, in VHPOP's manner"),
    "gather": ("tailor.tools.commands.learn.gather", "run actions in simulation and keep the episodes"),
    "train": ("tailor.tools.commands.learn.train", "make action models from episodes"),
    "train-gate": (
        "tailor.tools.commands.learn.train_gate",
        "learn when not to refine, with the action models that there are",
    ),
    "models": ("tailor.tools.commands.learn.models", "list, show, plot and check action models"),
    "evaluate": ("tailor.tools.commands.measure.evaluate", "reproduce the paper's tables and figures"),
    "bench": ("tailor.tools.commands.measure.bench", "measure speed and memory"),
}


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command; returns its exit code: 0 done, 1 a negative answer, 2 bad input."""
    arguments = list(sys.argv[1:] if argv is None else argv)
    if not arguments or arguments[0] in ("-h", "--help"):
        print(_overview())
        return 0
    if arguments[0] == "--version":
        print(f"tailor {__version__}")
        return 0
    name, *rest = arguments
    if name not in COMMANDS:
        print(f"tailor: unknown command '{name}' (expected one of: {', '.join(COMMANDS)})", file=sys.stderr)
        return 2
    try:
        code = _call(name, rest)
        if sys.stdout:
            sys.stdout.flush()  # here, where a reader that has left is no error
        return code
    except UsageError as error:
        print(f"tailor {name}: {plain(str(error))}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:
        sys.stdout = None  # the interpreter would flush it once more at its end, and complain
        return 1
    except OSError as error:  # of a path that was named, or of standard output, which has no name
        where = "" if error.filename is None else f"{error.filename}: "
        print(f"tailor {name}: {plain(f'{where}{error.strerror or error}')}", file=sys.stderr)
        return 1 if error.filename is None else 2


def _call(name: str, rest: Sequence[str]) -> int:
    module = importlib.import_module(COMMANDS[name][0])
    parser = _Parser(prog=f"tailor {name}", description=module.__doc__, allow_abbrev=False)
    module.configure(parser)
    return int(module.run(parser.parse_args(rest)))


class _Parser(argparse.ArgumentParser):
    """Tells a mistake in one line, as all mistakes are told, instead of with the usage above it."""

    def error(self, message: str) -> NoReturn:
        raise UsageError(f"{message} ({self.prog} --help tells more)")


def _overview() -> str:
    width = max(map(len, COMMANDS))
    rows = [f"  {name:<{width}}  {text}" for name, (_, text) in COMMANDS.items()]
    return "\n".join(["usage: tailor COMMAND [...]   (tailor COMMAND --help tells more)", "", "commands:", *rows])


if __name__ == "__main__":
    sys.exit(main())
