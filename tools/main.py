"""The `tailor` command: a table of commands; the module of a command is only loaded when it is called."""

from __future__ import annotations

import importlib
import io
import os
import sys
from collections.abc import Sequence
from contextlib import suppress

from tailor import __version__
from tailor.runtime.gc_freeze import gc_disabled
from tailor.schemas.errors import UnreachableError, UsageError
from tailor.tools.cli.closed_streams import drop_failed_output, replace_closed_streams
from tailor.tools.cli.extras import NEEDS, advice, extra_of, require
from tailor.tools.cli.plain_text import plain
from tailor.tools.cli.termination import interrupted_by_sigterm
from tailor.tools.command_parser import CommandParser, nearest

TRY_AGAIN = 75
INTERRUPTED = 130

# command -> (module, one line of help); each module has configure(parser) and run(arguments) -> exit code
COMMANDS: dict[str, tuple[str, str]] = {
    "up": ("tailor.tools.commands.run.up", "start a whole system: bus, simulator, executive, recorder"),
    "demo": ("tailor.tools.commands.run.demo", "run the same plan greedy and refined, and compare"),
    "letters": ("tailor.tools.commands.run.letters", "write letters with the arm, with and without refined velocities"),
    "bus": ("tailor.tools.commands.run.bus", "run only the bus router"),
    "gateway": ("tailor.tools.commands.run.gateway", "let other users and machines onto the bus, by role"),
    "keys": ("tailor.tools.commands.setup.keys", "make keys for a bus on several machines"),
    "sim": ("tailor.tools.commands.run.sim", "run a simulated robot on the bus"),
    "executive": ("tailor.tools.commands.run.executive", "run the executive on the bus"),
    "goal": ("tailor.tools.commands.run.goal", "send a PDDL goal to a running executive"),
    "arm": ("tailor.tools.commands.run.arm", "arm a driver for the running executive"),
    "estop": ("tailor.tools.commands.run.estop", "emergency stop of all drivers"),
    "status": ("tailor.tools.commands.look.status", "state and health of a running system, with an e-stop key"),
    "units": ("tailor.tools.commands.setup.units", "write systemd units for a robot"),
    "driver": ("tailor.tools.commands.drivers.driver", "drive a real robot: guard, arming and watchdogs around it"),
    "check-driver": (
        "tailor.tools.commands.drivers.check_driver",
        "check a driver against its contract, and whether the robot moves as its models expect",
    ),
    "record": ("tailor.tools.commands.run.record", "record the bus into an MCAP file"),
    "replay": ("tailor.tools.commands.look.replay", "play a recording on the bus"),
    "info": ("tailor.tools.commands.look.info", "summarise a recording"),
    "recover": ("tailor.tools.commands.look.recover", "recover a damaged recording"),
    "cut": ("tailor.tools.commands.look.cut", "cut a time span or some topics out of a recording"),
    "compare": ("tailor.tools.commands.look.compare", "compare two recorded runs"),
    "verify": ("tailor.tools.commands.look.verify", "replay a recording through today's core and compare bit for bit"),
    "picture": ("tailor.tools.commands.look.picture", "draw the paths of recordings as in the paper's Figure 1"),
    "view": ("tailor.tools.commands.look.view", "show a run in the browser, recorded or live"),
    "scene": ("tailor.tools.commands.look.scene", "give 3D viewers markers and transforms of a run, recorded or live"),
    "why": ("tailor.tools.commands.look.why", "explain the choice of subgoals, compared with greedy"),
    "new": ("tailor.tools.commands.setup.new", "write the package of a new robot"),
    "plan": ("tailor.tools.commands.run.plan", "plan with PDDL files, VHPOP-style"),
    "gather": ("tailor.tools.commands.learn.gather", "run actions in simulation and save the episodes"),
    "train": ("tailor.tools.commands.learn.train", "train action models from episodes"),
    "make-models": (
        "tailor.tools.commands.learn.make_models",
        "make the models of robots anew from seeds, by their recipes",
    ),
    "models": ("tailor.tools.commands.learn.models", "list, show, plot and check action models"),
    "evaluate": ("tailor.tools.commands.measure.evaluate", "reproduce the paper's tables and figures"),
    "bench": ("tailor.tools.commands.measure.bench", "measure speed and memory"),
    "completion": ("tailor.tools.completion", "print a script that completes commands and flags in a shell"),
}
# by the folder of a command's module
GROUPS = {
    "run": "robots and plans",
    "setup": "keys, services, new robots",
    "drivers": "real robots",
    "look": "runs, live and recorded",
    "learn": "action models",
    "measure": "evaluations and benchmarks",
    "completion": "the shell",
}
PRINTING = [[name] for name in ("completion", "compare", "info", "models", "plan", "why")]  # what they print is all
URGENT = [["estop"], ["arm"]]  # both stop robots: arm --off
WITH_WORKERS = ("learn", "measure")  # groups of commands that start processes of their own


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command.

    Args:
      argv: Arguments without the program name; default: those of the process.

    Returns:
      Exit code, see docs/guide/troubleshooting.md: 0 success, 1 negative result, 2 bad input, 130 interrupted, 143 by
      SIGTERM; 75 (EX_TEMPFAIL of sysexits.h) if what another process provides is not there and a supervisor, such as
      systemd, may try again.
    """
    arguments = list(sys.argv[1:] if argv is None else argv)
    if argv is None and arguments[:1] in URGENT:  # a program that calls this keeps its own priority
        _take_cpu_first()
    into_file = any(each.startswith(("-o", "--output")) for each in arguments)
    replace_closed_streams(prints=arguments[:1] in PRINTING and not into_file)
    name = " ".join(["tailor", *arguments[:1]])
    is_supervised = "NOTIFY_SOCKET" in os.environ  # a process takes it out
    _replace_what_cannot_be_printed()
    try:
        try:
            return _run(arguments)
        finally:
            if sys.stdout:
                sys.stdout.flush()  # here, where a closed pipe is handled
    except (UsageError, ModuleNotFoundError) as error:
        extra = extra_of(error) or extra_of(error.__cause__)
        if not extra and isinstance(error, ModuleNotFoundError):
            raise
        _report(f"{plain(name)}: {plain(advice([extra]) if extra else str(error))}")
        return TRY_AGAIN if is_supervised and isinstance(error, UnreachableError) else 2
    except KeyboardInterrupt:
        return INTERRUPTED
    except ImportError as error:
        if not isinstance(error.__cause__, KeyboardInterrupt):  # which libraries in C turn into their own error
            raise
        return INTERRUPTED
    except BrokenPipeError:
        sys.stdout = None  # the interpreter would flush it again at exit, and fail
        return 1
    except OSError as error:  # of a named path, or of standard output, which has no name
        path = "" if error.filename is None else f"{error.filename}: "
        expected = ", expected a folder" if isinstance(error, FileExistsError | NotADirectoryError) else ""
        _report(f"{plain(name)}: {plain(f'{path}{error.strerror or error}{expected}')}")
        drop_failed_output()
        return 1 if error.filename is None else 2


def _take_cpu_first() -> None:
    """Where the system permits it, and before the command is loaded: on busy cores that takes most of a second.

    The least real-time priority, below every loop: a nice value counts only among the processes of one terminal where
    the kernel groups them (sched_autogroup_enabled), as it does on desktops.
    """
    try:
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(1))
    except OSError:
        with suppress(OSError):
            os.setpriority(os.PRIO_PROCESS, 0, -20)


def _replace_what_cannot_be_printed() -> None:
    """Let "?" stand for a character that is missing in the encoding of the output, such as ° in ASCII.

    Python would end the command with a traceback. Names of files that are no UTF-8 are kept, where Python keeps them.
    """
    output = sys.stdout
    if isinstance(output, io.TextIOWrapper) and (output.errors, output.encoding) != ("surrogateescape", "utf-8"):
        output.reconfigure(errors="replace")


def _run(arguments: list[str]) -> int:
    if not arguments or arguments[0] in ("-h", "--help"):
        print(_overview())
        return 0
    if arguments[0] == "--version":
        print(f"tailor {__version__}")
        return 0
    name, *rest = arguments
    if name.startswith("-"):
        _report(f"tailor: '{plain(name)}' stands before the command, expected it behind: tailor COMMAND {plain(name)}")
        return 2
    if name not in COMMANDS:
        _report(f"tailor: unknown command '{plain(name)}'{nearest(name, COMMANDS)} (see tailor --help)")
        return 2
    return _call(name, rest)


def _report(line: str) -> None:
    """Print an error; red on a terminal, unless NO_COLOR is set (no-color.org). A closed standard error takes none."""
    if sys.stderr is None:
        return  # print would take the standard output instead
    coloured = sys.stderr.isatty() and not os.environ.get("NO_COLOR")
    print(f"\x1b[31m{line}\x1b[0m" if coloured else line, file=sys.stderr)


def _call(name: str, rest: Sequence[str]) -> int:
    with gc_disabled():  # modules stay: collections among them take a tenth of the time of their import
        module = importlib.import_module(COMMANDS[name][0])
    parser = CommandParser(prog=f"tailor {name}", description=module.__doc__, allow_abbrev=False)
    module.configure(parser)
    parsed = parser.parsed(rest)
    require(*NEEDS.get(name, ()))
    if module.__name__.split(".")[-2] not in WITH_WORKERS:
        return int(module.run(parsed))
    return interrupted_by_sigterm(lambda: int(module.run(parsed)), parser.prog)


def _overview() -> str:
    width = max(map(len, COMMANDS))
    lines = ["usage: tailor COMMAND [...]   (see tailor COMMAND --help)"]
    for group, title in GROUPS.items():
        lines += ["", f"{title}:"]
        own = (name for name, (module, _) in COMMANDS.items() if group in module.split("."))
        lines += [f"  {name:<{width}}  {COMMANDS[name][1]}" for name in own]
    return "\n".join(lines)


if __name__ == "__main__":
    sys.exit(main())
