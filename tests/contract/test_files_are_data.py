"""No module unpickles, or runs text: models, PDDL, recordings and settings stay data, whoever wrote the file."""

import ast

import pytest

from tests.unit.house.arrows import MODULES, ROOT

READERS = {"pickle", "marshal", "shelve", "dill", "cloudpickle", "runpy"}  # whose files run code as they are read
LOADERS = {"joblib.load", "np.load", "numpy.load", "yaml.load"}
RUNNERS = {"eval", "exec", "compile"}


def unsafe(source: str) -> set[str]:
    """What a piece of code imports or calls that can run what a file holds."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names} & READERS
        elif isinstance(node, ast.ImportFrom):
            found |= {node.module or ""} & READERS
        elif isinstance(node, ast.Call):
            found |= {ast.unparse(node.func)} & (LOADERS | RUNNERS)
    return found


@pytest.mark.promise("P40")
def test_no_module_unpickles_or_runs_text() -> None:
    code = ("import pickle", "def f():\n    from marshal import loads", "eval(text)", "model = np.load(path)")
    assert [unsafe(text) for text in code] == [{"pickle"}, {"marshal"}, {"eval"}, {"np.load"}]
    own = {*MODULES, *(path.relative_to(ROOT).as_posix() for path in (ROOT / "src" / "tailor").glob("*.py"))}
    assert len(own) > 500
    found = {path: unsafe((ROOT / path).read_text()) for path in sorted(own)}
    assert {path: names for path, names in found.items() if names} == {}
