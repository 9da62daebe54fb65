"""Draws the clauses of the contract into docs/robots/contract.md."""

from tailor.tools.contract.suite import CLAUSES
from tests.unit.house.arrows import ROOT

PAGE = ROOT / "docs" / "robots" / "contract.md"
BEGIN = "<!-- clauses: drawn by `python -m tests.unit.house.draw_clauses` -->\n"
FOR = {"package": "package", "action": "each action", "scenario": "each scenario"}


def drawn(page: str) -> str:
    """The page with today's clauses."""
    rows = [
        f"| `{clause.name}` | {FOR[clause.scope]} | {clause.text} | {clause.needs} |"
        for clause in sorted(CLAUSES.values(), key=lambda each: list(FOR).index(each.scope))
    ]
    table = "\n".join(["| clause | for | a package keeps to it if | needs |", "|---|---|---|---|", *rows])
    head, begin, _ = page.partition(BEGIN)
    return f"{head}{begin}\n{table}\n"


if __name__ == "__main__":
    PAGE.write_text(drawn(PAGE.read_text()))
