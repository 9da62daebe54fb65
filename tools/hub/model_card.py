"""README.md of a robot's models in the hub's format: metadata in YAML, then text, with the figures of the cards."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from huggingface_hub import EvalResult, ModelCardData

from tailor.models.cards.card import SUCCESS_KINDS, UNITS, Card
from tailor.models.cards.card_shape import TEST_FIGURES
from tailor.tools.learning.card_lines import missed_failures

TAGS = ["robotics", "onnx", "tailor", "action-models"]
METRICS = {  # of the hub, by kind: name of the metric, entry of the card's test
    "duration": ("mae", "mae_s", "mean absolute error of the duration (s)"),
    "duration_beside": ("mae", "mae_s", "mean absolute error of the duration beside objects (s)"),
    "energy": ("mae", "mae_j", "mean absolute error of the energy (J)"),
    "success": ("accuracy", "accuracy_pct", "share of correct predictions of success"),
    "clearance": ("accuracy", "accuracy_pct", "share of correct predictions of success beside an object"),
}


def model_card(robot: str, cards: Sequence[Card], licence: str) -> str:
    """The text of README.md.

    Args:
      robot: Name of the robot.
      cards: Cards of all its models.
      licence: SPDX id in lower case.
    """
    data = ModelCardData(
        license=licence,
        library_name="tailor",
        tags=[*TAGS, robot],
        pipeline_tag="robotics",
        metrics=sorted({METRICS[card["kind"]][0] for card in cards}),
        model_name=f"{robot} action models",
        eval_results=[_result(card) for card in cards],
    )
    return f"---\n{data.to_yaml()}\n---\n\n" + "\n".join(_text(robot, cards)) + "\n"


def _result(card: Card) -> EvalResult:
    metric, entry, name = METRICS[card["kind"]]
    task = "tabular-classification" if card["kind"] in SUCCESS_KINDS else "tabular-regression"
    return EvalResult(
        task_type=task,
        dataset_type=f"{card['robot']}-{card['action']}",
        dataset_name=f"unseen episodes of {card['action']}",
        dataset_args={"episodes": card["test"].get("n", 0)},
        metric_type=metric,
        metric_value=round(card["test"][entry] / (100 if entry.endswith("_pct") else 1), 4),
        metric_name=f"{card['action']}: {name}",
    )


def _text(robot: str, cards: Sequence[Card]) -> Iterator[str]:
    yield f"# Action models of {robot}"
    yield ""
    yield "They predict, from the parameters of an action alone, how long it takes and whether it succeeds."
    yield ""
    yield "```sh"
    yield "pip install 'tailor[hub]'"
    yield "tailor models pull --from USER/NAME"
    yield "```"
    yield ""
    yield "Each `ACTION/KIND.onnx` takes `arguments`, float64 (n, k); its card, `KIND.card.json`, states ranges, golden"
    yield "examples and the hash of the file. `SHA256SUMS` lists them all."
    yield ""
    yield "## Models"
    yield ""
    yield "| model | learner | episodes | test episodes | error of unseen episodes |"
    yield "|---|---|---|---|---|"
    for card in cards:
        learner, count, tested = card["learner"]["name"], card["episodes"]["count"], card["test"].get("n", "")
        yield f"| {card['action']}/{card['kind']} | {learner} | {count} | {tested} | {_error(card)} |"
    yield from _arguments(cards)
    yield from _provenance(cards)


def _error(card: Card) -> str:
    test, kind = card["test"], card["kind"]
    if kind in SUCCESS_KINDS:
        return f"{test['accuracy_pct']:.1f} % correct; missed failures: {missed_failures(test)}"
    (error, mean), unit = TEST_FIGURES[kind], UNITS[kind]
    return f"{test[error]:.3f} {unit} of {test[mean]:.1f} {unit}"


def _arguments(cards: Sequence[Card]) -> Iterator[str]:
    """Ranges within which the models were trained; the runtime predicts elsewhere, too."""
    yield from ("", "## Ranges", "", "The models were trained and tested within these ranges, and nowhere else.", "")
    yield from ("| model | arguments |", "|---|---|")
    for card in cards:
        ranges = ", ".join(f"{a['name']} {a['lower']:g}..{a['upper']:g} {a['unit']}" for a in card["arguments"])
        yield f"| {card['action']}/{card['kind']} | {ranges} |"


def _provenance(cards: Sequence[Card]) -> Iterator[str]:
    yield from ("", "## Provenance", "", "Equal source, libraries and command give equal models, bit for bit.", "")
    yield from ("| model | command | data set (SHA-256) | versions |", "|---|---|---|---|")
    for card in cards:
        versions: Mapping[str, str] = card["versions"]
        listed = ", ".join(f"{name} {version}" for name, version in versions.items())
        data = str(card["episodes"].get("sha256", ""))[:16]
        yield f"| {card['action']}/{card['kind']} | `{card['command']}` | {data} | {listed} |"
