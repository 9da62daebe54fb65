"""Models are looked up in the robot's package first, then in the user's data folder."""

from pathlib import Path

import pytest

from tailor.schemas import installed


@pytest.fixture
def folders(tmp_path: Path, monkeypatch) -> tuple[Path, Path]:
    own, share = tmp_path / "package" / "models", tmp_path / "share"
    monkeypatch.setattr(installed, "package_models_folder", lambda robot: own)
    monkeypatch.setenv("XDG_DATA_HOME", str(share))
    return own, share / "tailor" / "models"


def test_the_package_comes_first(folders: tuple[Path, Path]) -> None:
    own, users = folders
    assert installed.models_folder("cart") == own, "named in the error where there are no models"
    (users / "cart").mkdir(parents=True)
    assert installed.models_folder("cart") == users
    assert installed.models_folder("trolley") == own
    (own / "cart").mkdir(parents=True)
    assert installed.models_folder("cart") == own


@pytest.mark.parametrize("unset", ["", "not/absolute"])
def test_without_a_data_folder_it_is_the_one_in_the_home_folder(unset: str, tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setenv("XDG_DATA_HOME", unset)
    monkeypatch.setenv("HOME", str(tmp_path))
    assert installed.user_models_folder() == tmp_path / ".local" / "share" / "tailor" / "models"
