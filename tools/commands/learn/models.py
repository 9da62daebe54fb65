"""List, show, explain, draw and check action models; share them, and data sets, on the Hugging Face hub."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Mapping
from pathlib import Path

from rich.console import Console
from rich.markup import escape
from rich.table import Column, Table

from tailor.models.cards.card import SUCCESS_KINDS, UNITS, Card
from tailor.models.cards.card_shape import TEST_FIGURES
from tailor.models.episodes.manifest import MANIFEST
from tailor.models.inference import OnnxModel
from tailor.models.runtime import load_model
from tailor.schemas.errors import UsageError
from tailor.tools.cli.plain_text import plain
from tailor.tools.cli.terminal import table_console
from tailor.tools.hub import sharing
from tailor.tools.learning.card_lines import card_lines, missed_failures
from tailor.tools.learning.model_folders import located

EPILOG = """\
examples:
  tailor models list
  tailor models show agilo/goToPose/duration
  tailor models rules agilo/goToPose
  tailor models rules b21/grip --of bag:3
  tailor models plot agilo/goToPose --data data/agilo --out out/models
  tailor models check
  tailor models push agilo --to USER/agilo-models         (a repository of the hub, private if it is new)
  tailor models push agilo --to ./agilo-models            (the same as a folder, with README.md and checksums)
  tailor models pull --from USER/agilo-models --zoo out/zoo
  tailor models push --data data/agilo --to USER/agilo-episodes          (data sets instead of models)
  tailor models pull --data data/theirs --from USER/agilo-episodes

MODEL is ROBOT/ACTION/KIND. KIND is duration (the default), duration_beside (beside objects), energy, success, or
clearance (success beside an object). ROBOT alone stands for all its models, no MODEL for those of all robots.
--of is for models of trees: a bag (durations of b21's arm) or a forest."""
VERBS = ("list", "show", "rules", "plot", "check", "push", "pull")
TAKEN_BY = {  # flag -> verbs; the others would ignore it
    "--json": ("list", "show", "check", *sharing.VERBS),
    "--data": ("rules", "plot", *sharing.VERBS),
    "--of": ("rules",),
    "--distilled": ("rules",),
    "--out": ("plot",),
}
OUT = Path("out/models")


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = EPILOG
    checks = "check: run all checks (exit code 1 if any fails)"
    seen = "list: one line per model; show: its card; rules: the model as rules; plot: pictures"
    parser.add_argument("verb", choices=VERBS, help=f"{seen}; {checks}; push: share; pull: get and check")
    parser.add_argument("models", nargs="*", default=[], metavar="MODEL", help="models (default: all)")
    parser.add_argument("--zoo", type=Path, help="folder of models (default: the one of the robot)")
    data = "plot, rules: folder with data sets (default: data/ROBOT); push, pull: data sets there instead of models"
    parser.add_argument("--data", type=Path, metavar="DIR", help=data)
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--of", metavar="TREE", help="rules: a single tree of the model, as bag:3 or forest:1")
    which.add_argument(
        "--distilled", action="store_true", help="rules: a tree distilled from the model (default if it has several)"
    )
    parser.add_argument("--out", type=Path, help=f"plot: folder (default: {OUT})")
    json_help = "list, show, check, push, pull: print JSON; show: a card, of several models a list of them"
    parser.add_argument("--json", action="store_true", help=json_help)
    sharing.configure(parser)


def run(arguments: argparse.Namespace) -> int:
    """Run the verb; exit code 0, or 1 if a check fails."""
    _check_flags(arguments)
    if arguments.verb in sharing.VERBS:
        return sharing.run(arguments)
    found = located(arguments.models, arguments.zoo)
    if arguments.verb == "check":
        return _check(found, arguments)
    loaded, unread = _loaded(found, whole=bool(arguments.models or arguments.zoo))
    _check_data(arguments.data, {model.card["action"] for _, _, model in loaded})
    if arguments.verb == "list":
        _list([model.card for _, _, model in loaded], arguments.json)
    elif arguments.verb == "show":
        _show([model.card for _, _, model in loaded], arguments.json)
    elif arguments.verb == "rules":
        for zoo, name, model in loaded:
            print(_rules(model, zoo / f"{name}.onnx", arguments))
    else:
        _plot({name: model for _, name, model in loaded}, arguments)
    for error in unread:
        print(plain(error), file=sys.stderr)
    return 1 if unread else 0


def _loaded(found: Mapping[Path, list[str]], whole: bool) -> tuple[list[tuple[Path, str, OnnxModel]], list[str]]:
    """Models with their folders and names, and errors of the others: one at fault hinders only those who name it.

    Raises:
      UsageError: One cannot be loaded, and the `whole` is demanded, or none can.
    """
    loaded, errors = [], []
    for zoo, name in ((zoo, name) for zoo, names in found.items() for name in names):
        try:
            loaded.append((zoo, name, load_model(name, zoo)))
        except UsageError as error:
            if whole:
                raise
            errors.append(f"{name}: {error}")
    if not loaded:
        raise UsageError("; ".join(errors))
    return loaded, errors


def _plot(models: Mapping[str, OnnxModel], arguments: argparse.Namespace) -> None:
    from tailor.tools.figures.learned_models import pictures

    for name, model in models.items():
        drawn = map(str, pictures.draw(model, arguments.data, arguments.out or OUT))
        print("\n".join(drawn) or f"{name}: no picture without its episodes")


def _check_flags(arguments: argparse.Namespace) -> None:
    """Refuse flags that the verb does not take, and would ignore.

    Raises:
      UsageError: There is one; the message names it.
    """
    sharing.check_flags(arguments)
    given = {f"--{name}" for name in ("json", "data", "of", "distilled", "out") if getattr(arguments, name)}
    wrong = [flag for flag, verbs in TAKEN_BY.items() if flag in given and arguments.verb not in verbs]
    if wrong:
        raise UsageError(f"{arguments.verb} takes no {', '.join(wrong)} (see tailor models --help)")


def _check_data(data: Path | None, actions: set[str]) -> None:
    """Raise UsageError if a folder of data sets is named that has none of these actions."""
    if data is not None and not any((data / action / MANIFEST).exists() for action in actions):
        expected = ", ".join(f"{action}/{MANIFEST}" for action in sorted(actions))
        raise UsageError(f"{data}: no data sets of these models, expected {expected} (`tailor gather` writes them)")


def _rules(model: OnnxModel, path: Path, arguments: argparse.Namespace) -> str:
    from tailor.tools.learning.model_rules import DISTILLED, rules, tree_number

    tree = tree_number(arguments.of) if arguments.of else DISTILLED if arguments.distilled else None
    return rules(model, path, tree, arguments.data)


def _quality(card: Card) -> str:
    test, kind = card["test"], card["kind"]
    if kind in SUCCESS_KINDS:
        return f"{test['accuracy_pct']:.1f} % correct; missed: {missed_failures(test)}"
    (error, mean), unit = TEST_FIGURES[kind], UNITS[kind]
    return f"MAE {test[error]:.3f} {unit} of {test[mean]:.1f} {unit}"


def _list(cards: list[Card], as_json: bool) -> None:
    rows = [
        {
            "model": f"{card['robot']}/{card['action']}/{card['kind']}",
            "learner": card["learner"]["name"],
            "features": card["features"],
            "episodes": card["episodes"]["count"],
            "test": _quality(card),
            "sha256": card["sha256"][:12],
        }
        for card in cards
    ]
    if as_json:
        print(json.dumps(rows))
        return
    table = Table(Column("model", no_wrap=True), *list(rows[0])[1:])
    for row in rows:
        table.add_row(*map(str, row.values()))
    table_console().print(table)


def _show(cards: list[Card], as_json: bool) -> None:
    """Print cards, with --json as one value: that of a single model, or a list."""
    if as_json:
        written = json.dumps(cards[0] if len(cards) == 1 else cards)
        print(json.dumps(json.loads(written, parse_constant=lambda _: None)))  # of one made by hand: NaN is no JSON
        return
    console = Console(highlight=False)
    for card in cards:
        console.rule(f"{card['robot']}/{card['action']}/{card['kind']}")
        for key, text in card_lines(card):
            console.print(f"[bold]{escape(plain(key))}[/bold]: {escape(plain(text))}")


def _check(found: Mapping[Path, list[str]], arguments: argparse.Namespace) -> int:
    """Check models by their folders; exit code 0 if all are sound, else 1."""
    from tailor.tools.learning.remaking import remaking_advice
    from tailor.tools.learning.zoo_checks import checked

    failed: dict[str, str] = {}
    stale: dict[str, str] = {}
    for zoo, names in found.items():
        for name, failure, differs in checked(names, arguments.models, zoo):
            failed |= {name: failure} if failure else {}
            stale |= {name: differs} if differs else {}
            if not arguments.json:
                print(plain(f"{name}: {failure or (f'stale: {differs}' if differs else 'sound')}"))
    if arguments.json:
        every = [name for names in found.values() for name in names]
        print(json.dumps({"checked": [*dict.fromkeys((*every, *failed))], "failed": failed, "stale": stale}))
    else:
        for robot in dict.fromkeys(name.split("/")[0] for name in stale):
            print(f"stale models of {robot} are made anew by {remaking_advice(robot, arguments.zoo)}")
    return 1 if failed or stale else 0
