"""Files whose hash is right, and which onnxruntime refuses, cannot run, or runs to results of other shapes."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import numpy as np
import pytest

from tailor.models import inference, runtime
from tailor.models.cards.card import card_path, read_card, sha256_of, write_card
from tailor.schemas.errors import UsageError


class Altered:
    """A session of an altered file: as it was, but for its predictions."""

    def __init__(self, session: Any, run: Callable[..., Any]) -> None:
        self.get_inputs, self.get_modelmeta, self.run = session.get_inputs, session.get_modelmeta, run


def raising(*_: object) -> None:
    raise RuntimeError("indices element out of data bounds\nand more")


def single(_: object, rows: dict[str, np.ndarray]) -> list[np.ndarray]:
    return [np.zeros(1)] * 3


UNUSABLE = [
    (raising, "onnxruntime cannot run it (indices element out of data bounds)"),
    (lambda *_: [], "returns shapes none for 32 rows, expected 3 columns of numbers"),
    (single, "returns shapes [1], [1], [1] for 32 rows, expected 3 columns of numbers"),
    (lambda *_: [np.zeros((32, 1))] * 3, "returns shapes [32, 1], [32, 1], [32, 1] for 32 rows"),
    (lambda *_: [np.full(32, "x")] * 3, "returns shapes [32], [32], [32] for 32 rows, expected 3 columns of numbers"),
    (lambda *_: [[np.zeros(1), np.zeros(2)]] * 3, "returns shapes (list), (list), (list) for 32 rows, expected 3 col"),
]


@pytest.mark.promise("P32")
@pytest.mark.parametrize(("run", "message"), UNUSABLE, ids=range(len(UNUSABLE)))
def test_a_model_that_cannot_run_or_returns_other_shapes_is_refused(monkeypatch, run, message: str) -> None:
    monkeypatch.setattr(runtime, "open_session", lambda content: Altered(inference.open_session(content), run))
    with pytest.raises(UsageError, match=re.escape(f"goToPose/duration.onnx: {message}")) as refused:
        runtime.load_model("agilo/goToPose/duration")
    assert "\n" not in str(refused.value)


def test_a_model_that_can_predict_for_many_rows_only_is_refused(monkeypatch) -> None:
    session = runtime.load_model("agilo/goToPose/duration").session

    def many(names: None, given: dict[str, np.ndarray]) -> list[np.ndarray]:
        return session.run(names, given) if len(given["arguments"]) > 1 else single(names, given)[:2]

    monkeypatch.setattr(runtime, "open_session", lambda _: Altered(session, many))
    with pytest.raises(UsageError, match=r"returns shapes \[1\], \[1\] for 1 rows, expected 3 columns"):
        runtime.load_model("agilo/goToPose/duration")


@pytest.mark.promise("P32")
@pytest.mark.parametrize("run", [run for run, _ in UNUSABLE], ids=range(len(UNUSABLE)))
def test_what_cannot_be_predicted_is_invalid(run) -> None:
    duration = dataclasses.replace(runtime.load_model("agilo/goToPose/duration"), session=Altered(Mock(), run))
    success = dataclasses.replace(runtime.load_model("agilo/approachBall/success"), session=duration.session)
    rows = np.zeros((5, 8))
    for values in (*duration.predict(rows), *duration.interval(rows), success.probability(rows)):
        assert np.array_equal(values, np.full(5, np.nan), equal_nan=True)


@pytest.mark.parametrize(("found", "put"), [(b"BRANCH_LEQ", b"BRANCH_LEX"), (b"Gather", b"G\xffther")])
def test_a_file_that_onnxruntime_refuses_costs_one_line(tmp_path: Path, capfd, found: bytes, put: bytes) -> None:
    shipped, path = runtime.ZOO / "agilo" / "approachBall" / "success.onnx", tmp_path / "success.onnx"
    altered = shipped.read_bytes().replace(found, put, 1)
    assert altered != shipped.read_bytes()
    path.write_bytes(altered)
    write_card(card_path(path), {**read_card(card_path(shipped)), "sha256": sha256_of(altered)})
    with pytest.raises(UsageError, match="not a model that onnxruntime can run"):
        runtime.load_model(path)
    assert capfd.readouterr() == ("", "")
