"""Hashes of sources: a changed number changes them, a comment does not."""

from pathlib import Path

import pytest

from tailor.schemas.installed.episode_files import episode_files
from tailor.schemas.installed.source_text import content_sha256
from tailor.schemas.packages.spec import DomainSpec

MODULE = 'LIMIT = 0.5  # metres\n\n\ndef slow(v: float) -> float:\n    """Half."""\n    return LIMIT * v\n'
SAME = '"""Limits."""\n\nLIMIT = 0.5\n\ndef slow(\n    v: float,\n) -> float:\n    return (LIMIT * v)\n'


def hash_of(folder: Path, name: str, text: str) -> str:
    path = folder / name
    path.write_text(text)
    return content_sha256(path)


def test_comments_docstrings_and_layout_do_not_count(tmp_path: Path) -> None:
    assert hash_of(tmp_path, "a.py", MODULE) == hash_of(tmp_path, "b.py", SAME)
    assert hash_of(tmp_path, "a.xml", "<a>\n  <b c='1'/> <!-- b -->\n</a>") == hash_of(
        tmp_path, "b.xml", "<a><b c='1'/></a>"
    )
    assert hash_of(tmp_path, "a.toml", "a = 1  # one\nb = 2\n") == hash_of(tmp_path, "b.toml", "b = 2\na = 1\n")


@pytest.mark.parametrize(
    ("old", "new"),
    [("0.5", "0.6"), ("0.5", "None"), ("0.5", "'0.5'"), ("LIMIT * v", "LIMIT + v"), ("LIMIT * v", "v * LIMIT"),
     ('"""Half."""', "v = 2 * v"), ("v: float", "w: float")],
)  # fmt: skip
def test_what_the_program_does_counts(tmp_path: Path, old: str, new: str) -> None:
    assert hash_of(tmp_path, "a.py", MODULE) != hash_of(tmp_path, "b.py", MODULE.replace(old, new))


def test_a_number_in_a_scene_counts(tmp_path: Path) -> None:
    assert hash_of(tmp_path, "a.xml", "<a b='1'/>") != hash_of(tmp_path, "b.xml", "<a b='2'/>")
    assert hash_of(tmp_path, "a.toml", "a = 1") != hash_of(tmp_path, "b.toml", "a = 1.5")


def test_controllers_belief_body_and_sampler_determine_episodes() -> None:
    arm, soccer = episode_files("arm"), episode_files("soccer")
    assert {"executive/actions/reach.py", "simnodes/powercube/scene.xml", "simnodes/powercube/motor.py"} <= arm.keys()
    assert {"executive/belief/planar_ekf.py", "tools/lockstep/samplers/soccer.py"} <= soccer.keys()
    assert "executive/actions/dribble_ball.py" not in arm
    assert not any(name.startswith(("schemas", "executive/refinement", "executive/planning")) for name in soccer)


def test_a_package_outside_of_tailor_is_followed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also through relative imports, and without being imported."""
    package = tmp_path / "cart_h5"
    package.mkdir()
    (package / "__init__.py").write_text("raise RuntimeError('is not to be imported')\n")
    (package / "cart.py").write_text("from .limits import FASTEST_MPS\nimport numpy\n")
    (package / "limits.py").write_text("FASTEST_MPS = 2.0\n")
    (package / "scene.xml").write_text("<scene/>")
    spec = DomainSpec("cart", "cart", "cart_h5.cart:make", body="cart_h5.cart:Body")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr("tailor.schemas.installed.episode_files.spec_of", lambda _: spec)
    files = episode_files("cart")
    assert {name for name in files if name.startswith("cart_h5")} == {
        "cart_h5/cart.py", "cart_h5/limits.py", "cart_h5/scene.xml"
    }  # fmt: skip
    (package / "limits.py").write_text("FASTEST_MPS = 1.0\n")
    assert {name for name, value in episode_files("cart").items() if value != files[name]} == {"cart_h5/limits.py"}


IMPORTS = {
    "function": "def make():\n    import {}",
    "class": "class Body:\n    import {}",
    "if": "if True:\n    pass\nelif False:\n    pass\nelse:\n    import {}",
    "loop": "for _ in ():\n    import {}",
    "after a loop": "while False:\n    pass\nelse:\n    import {}",
    "with": "with open('a'):\n    import {}",
    "try": "try:\n    import {}\nfinally:\n    pass",
    "except": "try:\n    pass\nexcept ValueError:\n    import {}",
    "finally": "try:\n    pass\nfinally:\n    import {}",
    "case": "match 1:\n    case 1:\n        import {}",
    "behind a semicolon": "a = 1; import {}",
}


@pytest.mark.parametrize("where", IMPORTS)
def test_an_import_in_any_block_is_followed(where: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = tmp_path / "blocks_h5"
    package.mkdir()
    (package / "__init__.py").write_text("")
    (package / "cart.py").write_text(IMPORTS[where].format("blocks_h5.limits"))
    (package / "limits.py").write_text("FASTEST_MPS = 2.0\n")
    monkeypatch.syspath_prepend(tmp_path)
    spec = DomainSpec("cart", "cart", "blocks_h5.cart:make")
    monkeypatch.setattr("tailor.schemas.installed.episode_files.spec_of", lambda _: spec)
    assert "blocks_h5/limits.py" in episode_files("cart")
