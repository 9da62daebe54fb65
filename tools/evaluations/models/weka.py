"""Runs WEKA's M5P and J48, the learners of the paper, if installed (Debian's package weka)."""

from __future__ import annotations

import re
import shutil
import subprocess
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

JAR = Path("/usr/share/java/weka.jar")  # of Debian's package
TIMEOUT_S = 600


def installed() -> bool:
    """Whether WEKA can be run here."""
    return JAR.exists() and shutil.which("java") is not None


def m5p(features: NDArray[Any], targets: NDArray[Any], fresh: NDArray[Any]) -> tuple[NDArray[np.float64], int, float]:
    """Predictions of M5P with its default settings, (n,), the number of its leaves, and seconds of the whole run."""
    started = time.perf_counter()
    output = _run(["weka.classifiers.trees.M5P"], features, targets, fresh, "numeric")
    count = re.search(r"Number of Rules\s*:\s*(\d+)", output)
    return np.array(_predictions(output), np.float64), int(count[1]) if count else 0, time.perf_counter() - started


def j48(
    features: NDArray[Any], success: NDArray[np.bool_], fresh: NDArray[Any], cost_ratio: float
) -> NDArray[np.bool_]:
    """Successes predicted by J48 with a cost matrix, (n,)."""
    matrix = f"[0.0 {cost_ratio}; 1.0 0.0]"  # rows: observed fail, success
    inner = ["-W", "weka.classifiers.trees.J48"]
    command = ["weka.classifiers.meta.CostSensitiveClassifier", "-cost-matrix", matrix, *inner]
    output = _run(command, features, np.where(success, "success", "fail"), fresh, "{fail,success}")
    return np.array([value.endswith("success") for value in _predictions(output)])


def _run(command: Sequence[str], features: NDArray[Any], targets: NDArray[Any], fresh: NDArray[Any], kind: str) -> str:
    with tempfile.TemporaryDirectory() as folder:
        train, test = Path(folder) / "train.arff", Path(folder) / "test.arff"
        _write(train, features, targets, kind)
        _write(test, fresh, np.full(len(fresh), targets[0]), kind)
        name, *options = command
        java = ["java", "-Xmx1g", "-cp", str(JAR), name, "-t", str(train), "-T", str(test)]
        model = _call([*java, "-v", *options]) if kind == "numeric" else ""  # prints the number of rules
        return model + "\n" + _call([*java, "-p", "0", *options])


def _call(command: Sequence[str]) -> str:
    done = subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT_S, check=True)
    return done.stdout


def _write(path: Path, features: NDArray[Any], targets: NDArray[Any], kind: str) -> None:
    names = [f"@attribute f{k} numeric" for k in range(features.shape[1])]
    rows = [",".join([*map(repr, row), str(target)]) for row, target in zip(features.tolist(), targets, strict=True)]
    path.write_text("\n".join(["@relation action", *names, f"@attribute target {kind}", "@data", *rows, ""]))


def _predictions(output: str) -> list[Any]:
    """Third column of the lines "number actual predicted ..." that WEKA prints."""
    lines = output.rsplit("Predictions on test data", maxsplit=1)[-1]
    return re.findall(r"^\s*\d+\s+\S+\s+(\S+)", lines, re.MULTILINE)
