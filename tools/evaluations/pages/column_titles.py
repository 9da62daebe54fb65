"""Columns of reports in words; JSON keeps their names."""

from __future__ import annotations

UNITS = {"pct": "%", "s": "s", "ms": "ms", "m": "m", "mps": "m/s", "rad": "rad", "mrad": "mrad", "deg": "°", "j": "J"}
WORDS = {"ci95": "95 % interval", "more": "difference", "mae": "MAE", "rms": "RMS", "wilcoxon": "Wilcoxon"}


def column_title(name: str) -> str:
    """The title of a column: `mean_greedy_s` is "mean greedy, s"; significances ("…_p") have no unit."""
    first, *others = name.split("_")
    units = [UNITS[word] for word in others if word in UNITS and others[-1] != "p"]
    words = [first, *(word for word in others if word not in UNITS)]
    return ", ".join([" ".join(WORDS.get(word, word) for word in words), *units])
