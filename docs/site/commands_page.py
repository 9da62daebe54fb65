"""The reference of commands, generated from their parsers."""

from __future__ import annotations

import argparse
import importlib

from tailor.tools.main import COMMANDS, GROUPS

HEAD = "# Commands\n\nGenerated from the commands themselves: `tailor COMMAND --help` prints the same.\n"


def commands_page() -> str:
    """Markdown with one section a command, grouped as in `tailor --help`."""
    parts = [HEAD]
    for group, title in GROUPS.items():
        own = [name for name, (module, _) in COMMANDS.items() if group in module.split(".")]
        parts += [f"\n## {title[0].upper()}{title[1:]}\n"]
        parts += [_section(name) for name in own]
    return "\n".join(parts)


def _section(name: str) -> str:
    module = importlib.import_module(COMMANDS[name][0])
    parser = argparse.ArgumentParser(prog=f"tailor {name}", description=module.__doc__, allow_abbrev=False)
    module.configure(parser)
    usage = parser.format_usage().removeprefix("usage: ").strip()
    shown = [action for action in parser._actions if action.help != argparse.SUPPRESS]
    rows = [_row(action) for action in shown if not isinstance(action, argparse._HelpAction)]
    table = "| argument | meaning |\n|---|---|\n" + "\n".join(rows) if rows else ""
    epilog = f"```text\n{parser.epilog}\n```\n" if parser.epilog else ""
    return f"### tailor {name}\n\n{(parser.description or '').strip()}\n\n```text\n{usage}\n```\n\n{table}\n\n{epilog}"


def _row(action: argparse.Action) -> str:
    choices = f"{{{','.join(map(str, action.choices))}}}" if action.choices else ""
    value = action.metavar or choices or (action.dest.upper() if action.nargs != 0 and action.option_strings else "")
    names = ", ".join(action.option_strings) or str(action.metavar or choices or action.dest)
    shown = f"{names} {value}" if action.option_strings and value else names
    text = str(action.help or "") % {**vars(action), "prog": "tailor"} if action.help else ""
    meaning = " ".join(text.split()).replace("|", "/").replace("<", "&lt;")  # <robot> is no HTML
    return f"| `{shown}` | {meaning} |"  # a bar in code ends no cell of this site
