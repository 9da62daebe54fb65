"""Verdicts and step responses as text: lines for a terminal, Markdown for a file, plain values for JSON."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from tailor.tools.conformance.clause import Verdict
from tailor.tools.conformance.fit import Response


@dataclass(frozen=True, slots=True)
class Report:
    """Outcome of one check.

    Attributes:
      robot, kind: Name of the robot; simulator or hardware.
      verdicts: One of each clause.
      responses: Of this robot; `models`: of the robot that the models were learned on; empty if not compared.
      misfits: Differences between both that matter.
      not_compared: Why the comparison was not possible; empty if it was, or was not wanted.
      remarks: What people should know although no clause is broken.
    """

    robot: str
    kind: str
    verdicts: Sequence[Verdict]
    responses: Sequence[Response] = ()
    models: Sequence[Response] = ()
    misfits: Sequence[str] = ()
    not_compared: str = ""
    remarks: Sequence[str] = ()

    @property
    def kept(self) -> bool:
        """Whether every clause was tried and kept."""
        return not any(each.faults or each.skipped for each in self.verdicts)


def line(verdict: Verdict) -> str:
    """One clause in a terminal; its faults below it."""
    mark = "not tried" if verdict.skipped else "BROKEN" if verdict.faults else "kept"
    faults = [f"    {each}" for each in (*verdict.faults, verdict.skipped) if each]
    return "\n".join([f"{mark:<10} {verdict.clause.replace('_', ' ')}", *faults])


def advice(report: Report) -> str:
    """What to do about a robot that moves otherwise."""
    if not report.misfits:
        return ""
    return (
        "The action models were learned on another motion, so their durations are wrong. Give the simulated body these "
        f"figures, then learn anew: tailor gather {report.robot} && tailor train {report.robot}"
    )


def markdown(report: Report) -> str:
    """The report as a page."""
    rows = [
        f"| {each.clause.replace('_', ' ')} | {_outcome(each)} | {each.text} |".replace("\n", " ")
        for each in report.verdicts
    ]
    parts = [
        f"# Driver of {report.robot} ({report.kind})",
        "",
        "| clause | outcome | what it demands |",
        "|---|---|---|",
    ]
    parts += rows
    if report.responses:
        parts += [
            "",
            "## Step responses",
            "",
            "| axis | commanded | dead time, s | slope, 1/s | speed |",
            "|---|---|---|---|---|",
        ]
        for name, found in (("", report.responses), (" of the models' robot", report.models)):
            parts += [
                f"| {r.axis}{name} | {r.commanded:.3g} {r.unit} | {r.dead_s:.2f} | {r.slope:.3g} | {r.speed:.3g} |"
                for r in found
            ]
        parts += ["", *(f"- {each}" for each in report.misfits or ["It moves as the models' robot does."])]
        parts += ["", advice(report)] if report.misfits else []
    if report.not_compared:
        parts += ["", f"Step responses: not tried: {report.not_compared}"]
    if report.remarks:
        parts += ["", "## Remarks", "", *(f"- {each}" for each in report.remarks)]
    return "\n".join([*parts, ""])


def values(report: Report) -> dict[str, Any]:
    """The report for JSON."""
    return {**asdict(report), "kept": report.kept}


def _outcome(verdict: Verdict) -> str:
    if verdict.skipped:
        return f"not tried: {verdict.skipped}"
    return f"**broken**: {'; '.join(verdict.faults)}" if verdict.faults else "kept"
