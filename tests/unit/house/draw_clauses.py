"""Draws the clauses of the contract into docs/robots/contract.md."""

from tailor.tools.contract.suite import ordered_clauses
from tests.unit.house.arrows import ROOT

PAGE = ROOT / "docs" / "robots" / "contract.md"
BEGIN = "<!-- clauses: drawn by `python -m tests.unit.house.draw_clauses` -->\n"
FOR = {"package": "package", "action": "each action", "scenario": "each scenario"}


def drawn(page: str) -> str:
    """The page with today's clauses."""
    ordered = sorted(ordered_clauses(), key=lambda each: list(FOR).index(each.scope))
    rows = [f"| `{each.name}` | {FOR[each.scope]} | {each.text} | {each.needs} |" for each in ordered]
    table = "\n".join(["| clause | for | a package keeps to it if | needs |", "|---|---|---|---|", *rows])
    head, begin, _ = page.partition(BEGIN)
    return f"{head}{begin}\n{table}\n"


if __name__ == "__main__":
    PAGE.write_text(drawn(PAGE.read_text()))
