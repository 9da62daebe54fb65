"""Models and data sets go to a hub or a folder and come back unchanged; what is damaged or in the way is refused."""

import errno
import filecmp
import json
import os
import shutil
import time

import huggingface_hub.constants
import numpy as np
import pytest
from huggingface_hub import DatasetCard, ModelCard

from tailor.models.episodes.episodes import Episode, read_data_set, write_part
from tailor.models.episodes.manifest import write_manifest
from tailor.models.runtime import ZOO, load_model
from tailor.tools.hub import transfer
from tailor.tools.hub.checksums import write_checksums
from tailor.tools.main import main
from tests.support.stand_ins.hub import TOKEN, running_hub

ROBOT = "powercube"


@pytest.fixture
def hub(monkeypatch, tmp_path):
    with running_hub() as hub:
        files = f"{hub.url}/{{repo_id}}/resolve/{{revision}}/{{filename}}"  # both are read when the client is imported
        monkeypatch.setattr(huggingface_hub.constants, "ENDPOINT", hub.url)
        monkeypatch.setattr(huggingface_hub.constants, "HUGGINGFACE_CO_URL_TEMPLATE", files)
        monkeypatch.setenv("HF_ENDPOINT", hub.url)
        monkeypatch.setenv("HF_TOKEN", TOKEN)
        monkeypatch.chdir(tmp_path)
        yield hub


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Models as a folder of the hub."""
    monkeypatch.chdir(tmp_path)
    assert main(["models", "push", ROBOT, "--to", "./pushed"]) == 0
    return tmp_path / "pushed"


def data_sets(folder):
    """Two data sets of a robot."""
    arguments = [{"name": name, "unit": "m", "lower": 0.0, "upper": 1.0} for name in ("x", "xg")]
    for action in ("go", "turn"):
        (folder / action).mkdir(parents=True)
        rows = [np.array([[0.1, k / 10], [0.2, k / 10]]) for k in range(3)]
        episodes = [Episode(k, row[0], row, 0.2, True, "") for k, row in enumerate(rows)]
        write_part(folder / action / "part-00000.parquet", episodes, ["x", "xg"])
        about = {"source": "lock-step", "seed": 3, "episodes": 3}
        write_manifest(folder / action, {"robot": "rover", "action": action, "arguments": arguments, **about})
    return folder


def equal(one, other, names):
    return filecmp.cmpfiles(one, other, names, shallow=False)[0] == names


def refused(capsys, *arguments):
    """The one line on stderr."""
    capsys.readouterr()
    assert main(["models", *map(str, arguments)]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1
    return captured.err


FILES = [f"{ROBOT}/reach/{kind}.{end}" for kind in ("duration", "energy") for end in ("onnx", "card.json")]


@pytest.mark.parametrize("robot", sorted(folder.name for folder in ZOO.iterdir() if folder.is_dir()))
def test_the_models_of_every_robot_that_ships_can_be_shared(robot, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["models", "push", robot, "--to", "./pushed"]) == 0
    page = (tmp_path / "pushed" / "README.md").read_text()
    for card in (ZOO / robot).glob("*/*.card.json"):
        assert f"| {card.parent.name}/{card.name.removesuffix('.card.json')} |" in page


def test_models_come_back_from_the_hub_unchanged(hub, tmp_path, capsys):
    assert main(["models", "push", ROBOT, "--to", "user/arm-models", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["pushed"].endswith("/user/arm-models/commit/1")
    assert hub.visibility == {("model", "user/arm-models"): "private"}
    assert main(["models", "pull", "--from", "user/arm-models", "--zoo", "zoo", "--json"]) == 0
    assert len(json.loads(capsys.readouterr().out)["pulled"]) == 2
    assert equal(ZOO, tmp_path / "zoo", FILES)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["zoo"]


def test_a_repository_is_public_only_on_request(hub):
    assert main(["models", "push", ROBOT, "--to", "user/arm-models", "--public"]) == 0
    assert hub.visibility == {("model", "user/arm-models"): "public"}


def test_data_sets_come_back_from_the_hub_unchanged(hub, tmp_path, capsys):
    data = data_sets(tmp_path / "data")
    assert main(["models", "push", "--data", str(data), "--to", "user/episodes"]) == 0
    assert main(["models", "pull", "--data", "theirs", "--from", "user/episodes"]) == 0
    names = [f"{action}/{file}" for action in ("go", "turn") for file in ("manifest.json", "part-00000.parquet")]
    assert equal(data, tmp_path / "theirs", names)
    assert read_data_set(tmp_path / "theirs" / "go").sha256 == read_data_set(data / "go").sha256


def test_the_card_of_models_has_the_hub_s_metadata_and_our_figures(folder):
    card = ModelCard.load(folder / "README.md")
    assert (card.data.license, card.data.library_name) == ("apache-2.0", "tailor")
    assert {"robotics", "onnx", ROBOT} <= set(card.data.tags)
    figures = {result.metric_name: result.metric_value for result in card.data.eval_results}
    test = load_model("powercube/reach/duration").card["test"]
    assert figures["reach: mean absolute error of the duration (s)"] == round(test["mae_s"], 4)
    assert load_model("powercube/reach/duration").card["command"] in card.text


def test_the_card_of_data_names_the_parts_of_each_configuration(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    data_sets(tmp_path / "data")
    command = ["models", "push", "--data", "data", "--to", "./pushed", "--license", "cc-by-4.0"]
    assert main(command) == 0
    card = DatasetCard.load(tmp_path / "pushed" / "README.md")
    described = [line.split(" | ")[0] for line in card.text.splitlines() if line.startswith("| ")]
    assert described.count("| in_context") == described.count("| tick") == len(card.data.configs)
    assert (card.data.license, card.data.size_categories) == ("cc-by-4.0", ["n<1K"])
    for each in card.data.configs:
        (files,) = each["data_files"]
        assert files["split"] == "train"
        assert [p.parent.name for p in (tmp_path / "pushed").glob(files["path"])] == [each["config_name"]]
    assert [each["config_name"] for each in card.data.configs] == ["go", "turn"]
    for column in read_columns(tmp_path / "pushed" / "go" / "part-00000.parquet"):
        assert f"| {column} |" in card.text


def read_columns(part):
    import pyarrow.parquet as pq

    return pq.read_schema(part).names


@pytest.mark.parametrize("file", [FILES[0], FILES[1]])
def test_a_changed_file_is_refused_and_nothing_is_installed(folder, tmp_path, capsys, file):
    content = (folder / file).read_bytes()
    (folder / file).write_bytes(content[:-9] + b"_" + content[-8:])
    line = refused(capsys, "pull", "--from", "./pushed", "--zoo", "zoo")
    assert f"{file}: sha256 is" in line
    assert "by SHA256SUMS" in line
    assert not list((tmp_path / "zoo").rglob("*"))


def test_a_file_changed_on_the_way_is_refused(hub, tmp_path, capsys):
    assert main(["models", "push", ROBOT, "--to", "user/arm-models"]) == 0
    content = hub.files["model", "user/arm-models"][FILES[0]]
    hub.answers[FILES[0]] = content[:-1] + bytes([content[-1] ^ 1])
    assert "by SHA256SUMS" in refused(capsys, "pull", "--from", "user/arm-models", "--zoo", "zoo")


def test_models_that_are_there_are_kept_without_replace(folder, tmp_path, capsys):
    mine = tmp_path / "zoo" / ROBOT / "reach"
    mine.mkdir(parents=True)
    (mine / "duration.onnx").write_bytes(b"mine")
    (mine / "success.onnx").write_bytes(b"old")
    assert "exists, expected an empty place, or --replace" in refused(
        capsys, "pull", "--from", "./pushed", "--zoo", "zoo"
    )
    assert (mine / "duration.onnx").read_bytes() == b"mine"
    assert main(["models", "pull", "--from", "./pushed", "--zoo", "zoo", "--replace"]) == 0
    assert equal(ZOO, tmp_path / "zoo", FILES)
    assert not (mine / "success.onnx").exists()


def test_an_interrupted_pull_leaves_what_was_there(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    data_sets(tmp_path / "data")
    shutil.copytree(tmp_path / "data", tmp_path / "mine")
    (tmp_path / "mine" / "go" / "part-00001.parquet").write_bytes(b"mine")
    assert main(["models", "push", "--data", "data", "--to", "./pushed"]) == 0

    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(transfer, "read_data_set", interrupted)
    assert main(["models", "pull", "--data", "mine", "--from", "./pushed", "--replace"]) == 130
    assert (tmp_path / "mine" / "go" / "part-00001.parquet").read_bytes() == b"mine"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["data", "mine", "pushed"]


@pytest.mark.parametrize("pulling", [False, True])
def test_a_full_disk_is_named_and_not_the_file_that_is_read(tmp_path, monkeypatch, capsys, pulling):
    monkeypatch.chdir(tmp_path)
    data_sets(tmp_path / "data")
    assert main(["models", "push", "--data", "data", "--to", "./pushed"]) == 0

    def full(source, *_, **__):
        raise OSError(errno.ENOSPC, "No space left on device", str(source))

    monkeypatch.setattr(shutil, "copyfile", full)
    words = (
        ("pull", "--data", "there/mine", "--from", "./pushed")
        if pulling
        else ("push", "--data", "data", "--to", "./there/mine")
    )
    assert (
        refused(capsys, *words)
        == "tailor models: there: No space left on device, expected space for what is written there\n"
    )
    assert sorted(p.name for p in tmp_path.iterdir()) == ["data", "pushed"]


def test_a_swap_that_was_killed_is_completed_by_the_next_one(tmp_path):
    (tmp_path / ".old.replaced").mkdir()  # what was there; a kill came before the new one took its place
    (tmp_path / ".old.replaced" / "kept").touch()
    (tmp_path / "new").mkdir()
    transfer._swap(tmp_path / "new", tmp_path / "old")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["old"]


def test_replacing_removes_data_sets_and_nothing_else(tmp_path, monkeypatch, capsys):
    """Whoever pushed them chose the names: a data set called as a folder of the user removed it."""
    monkeypatch.chdir(tmp_path)
    data_sets(tmp_path / "data")
    assert main(["models", "push", "--data", "data", "--to", "./pushed"]) == 0
    (tmp_path / "mine" / "turn").mkdir(parents=True)
    (tmp_path / "mine" / "turn" / "thesis.tex").touch()
    line = refused(capsys, "pull", "--data", "mine", "--from", "./pushed", "--replace")
    assert line == "tailor models: mine/turn: is no data set, expected one where --replace is to remove it\n"
    assert [path.name for path in (tmp_path / "mine").rglob("*")] == ["turn", "thesis.tex"]
    shutil.rmtree(tmp_path / "mine" / "turn")
    (tmp_path / "mine" / "turn").write_text("a file")
    assert "mine/turn: is no data set" in refused(capsys, "pull", "--data", "mine", "--from", "./pushed", "--replace")


def test_a_link_to_a_data_set_is_replaced_again_and_again(tmp_path, monkeypatch):
    """The link was left aside, where the next pull failed; what it points to is kept."""
    monkeypatch.chdir(tmp_path)
    data = data_sets(tmp_path / "data")
    assert main(["models", "push", "--data", "data", "--to", "./pushed"]) == 0
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "go").symlink_to(data / "go")
    for _ in range(2):
        assert main(["models", "pull", "--data", "mine", "--from", "./pushed", "--replace"]) == 0
        assert sorted(path.name for path in (tmp_path / "mine").iterdir()) == ["go", "turn"]
    assert not (tmp_path / "mine" / "go").is_symlink()
    assert (data / "go" / "manifest.json").is_file()


def listed_anew(folder):
    """The checksums of a folder of models that somebody has changed by hand."""
    files = [file.relative_to(folder) for file in folder.rglob("*") if file.suffix in (".onnx", ".json")]
    write_checksums(folder, files)


def test_a_model_in_the_place_of_another_is_neither_pulled_nor_pushed(folder, tmp_path, capsys):
    """Its checksum and its card are right; it went into the zoo, where every command refused it."""
    for end in ("onnx", "card.json"):
        shutil.copyfile(folder / f"{ROBOT}/reach/energy.{end}", folder / f"{ROBOT}/reach/duration.{end}")
    listed_anew(folder)
    expected = f"{ROBOT}/reach/duration.onnx: holds a model of {ROBOT}/reach/energy, expected {ROBOT}/reach/duration"
    assert f"models: pushed/{expected}" in refused(capsys, "pull", "--from", "./pushed", "--zoo", "zoo")
    assert not (tmp_path / "zoo").exists()
    assert expected in refused(capsys, "push", ROBOT, "--zoo", "pushed", "--to", "./again")
    assert not (tmp_path / "again").exists()


def test_a_refused_model_is_named_by_its_place(folder, capsys):
    """The message named a folder that no longer was there."""
    (folder / FILES[1]).unlink()
    listed_anew(folder)
    assert f"tailor models: pushed/{FILES[1]}: no such file" in refused(
        capsys, "pull", "--from", "./pushed", "--zoo", "zoo"
    )


def test_what_is_no_file_is_not_pulled(folder, tmp_path, capsys):
    """A pipe ended a pull with exit code 1 and no name, a folder called x.onnx with "is a directory"."""
    (folder / ROBOT / "reach" / "x.onnx").mkdir()
    assert main(["models", "pull", "--from", "./pushed", "--zoo", "zoo"]) == 0
    (folder / FILES[0]).unlink()
    os.mkfifo(folder / FILES[0])
    assert f"pushed: {FILES[0]} is missing" in refused(capsys, "pull", "--from", "./pushed", "--zoo", "other")


def test_models_are_pushed_without_the_copies_that_macos_leaves(folder, tmp_path):
    (folder / ROBOT / "reach" / "._duration.onnx").write_bytes(b"of the Finder")
    assert main(["models", "push", ROBOT, "--zoo", "pushed", "--to", "./again"]) == 0
    assert equal(folder, tmp_path / "again", FILES)


def test_nothing_is_pushed_over_a_link_to_nowhere(folder, tmp_path, capsys):
    (tmp_path / "link").symlink_to("nowhere")
    assert "models: link: exists, expected a new folder" in refused(capsys, "push", ROBOT, "--to", "./link")


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (("push", ROBOT), "push needs --to USER/NAME"),
        (("pull",), "pull needs --from USER/NAME"),
        (("push", "--to", "./a"), "push: expected one ROBOT"),
        (("push", ROBOT, "--to", "a b"), "'a b': expected USER/NAME, a repository of the hub, or a folder as ./NAME"),
        (("push", ROBOT, "--to", "tests/arm"), "'tests/arm': there is a folder of that name here"),
        (("push", ROBOT, "--to", "./a", "--replace"), "push takes no --replace"),
        (("list", "--to", "./a"), "list takes no --to"),
        (("push", "hal", "--to", "./a"), "hal"),
        (("pull", "--from", "./nothing"), "nothing: no such folder"),
        (("pull", "--from", "./tests"), "there is no SHA256SUMS"),
        (("push", "--data", "nowhere", "--to", "./a"), "nowhere: data sets of none"),
        (("push", ROBOT, "--to", "~nobody-of-this-name/a"), "'~nobody-of-this-name/a': Could not determine home"),
        (("push", ROBOT, "--to", "./a", "--public"), "--public is for a repository of the hub, found the folder ./a"),
        (("pull", "--from", "./tests", "--revision", "v1"), "--revision is for a repository of the hub"),
        (("pull", "--data", "a", "--zoo", "b", "--from", "./tests"), "pull --data takes no --zoo"),
    ],
)
def test_bad_input_is_refused_in_one_line(arguments, expected, tmp_path, monkeypatch, capsys):
    (tmp_path / "tests").mkdir()
    monkeypatch.chdir(tmp_path)
    assert expected in refused(capsys, *arguments)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["tests"]


def test_a_list_of_checksums_names_no_file_outside_of_its_folder(folder, capsys):
    with (folder / "SHA256SUMS").open("a") as file:
        file.write(f"{'0' * 64}  ../../secret\n")
    assert "no list of checksums" in refused(capsys, "pull", "--from", "./pushed", "--zoo", "zoo")


def test_what_a_pull_reads_whole_has_a_limit(folder, tmp_path, capsys):
    """Cards and models had one; the list and the manifests of a hostile place went into memory whole."""
    data = data_sets(tmp_path / "data")
    os.truncate(data / "go" / "manifest.json", 11_000_000)
    write_checksums(data, [file.relative_to(data) for file in data.rglob("*") if file.is_file()])
    line = refused(capsys, "pull", "--data", "theirs", "--from", "./data")
    assert "data/go/manifest.json: has 11000000 bytes, expected at most 10000000" in line
    os.truncate(folder / "SHA256SUMS", 12_000_000)
    line = refused(capsys, "pull", "--from", "./pushed", "--zoo", "zoo")
    assert "pushed/SHA256SUMS: has 12000000 bytes, expected at most 10000000" in line


def test_a_file_that_is_too_large_is_not_downloaded(hub, capsys):
    assert main(["models", "push", ROBOT, "--to", "user/arm-models"]) == 0
    hub.announced[FILES[0]] = 100_000_000_000
    line = refused(capsys, "pull", "--from", "user/arm-models", "--zoo", "zoo")
    assert f"user/arm-models/{FILES[0]}: has 100000000000 bytes, expected at most 67108864" in line
    assert hub.sent == []


def test_a_file_that_is_larger_than_announced_is_refused(hub, capsys):
    assert main(["models", "push", ROBOT, "--to", "user/arm-models"]) == 0
    hub.answers[FILES[1]] = b" " * (1 << 20) + b"{}"
    line = refused(capsys, "pull", "--from", "user/arm-models", "--zoo", "zoo")
    assert f"user/arm-models/{FILES[1]}: has 1048578 bytes, expected at most 1048576" in line
    assert len(hub.sent) == 5


def test_a_refused_pull_leaves_no_folders(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert "no such folder" in refused(capsys, "pull", "--from", "./nothing", "--zoo", "new/zoo")
    assert list(tmp_path.iterdir()) == []


def test_models_are_no_data_sets(folder, tmp_path, capsys):
    """They were said to be missing, though they were there."""
    line = refused(capsys, "pull", "--data", "theirs", "--from", "./pushed")
    assert "pushed: SHA256SUMS lists no file of a dataset" in line


def test_a_damaged_part_is_named_before_anything_is_pushed(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    part = data_sets(tmp_path / "data") / "go" / "part-00000.parquet"
    part.write_bytes(part.read_bytes()[:100])
    assert "data/go/part-00000.parquet: cannot be read (" in refused(capsys, "push", "--data", "data", "--to", "./a")
    assert not (tmp_path / "a").exists()


def test_a_part_that_training_would_refuse_is_neither_pushed_nor_pulled(tmp_path, monkeypatch, capsys):
    """Its footer was read alone."""
    monkeypatch.chdir(tmp_path)
    data_sets(tmp_path / "data")
    assert main(["models", "push", "--data", "data", "--to", "./pushed"]) == 0
    unknown = Episode(0, np.zeros(2), np.full((2, 2), np.nan), 0.2, True, "")
    for folder in ("data", "pushed"):
        write_part(tmp_path / folder / "turn" / "part-00000.parquet", [unknown], ["x", "xg"])
    pushed = tmp_path / "pushed"
    write_checksums(pushed, [file.relative_to(pushed) for file in pushed.glob("*/*.*")])
    wrong = "turn/part-00000.parquet: column x holds values that are not finite numbers"
    assert f"data/{wrong}" in refused(capsys, "push", "--data", "data", "--to", "./again")
    assert f"pushed/{wrong}" in refused(capsys, "pull", "--data", "theirs", "--from", "./pushed")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["data", "pushed"]


def test_nothing_is_pushed_that_no_pull_would_take(tmp_path, monkeypatch, capsys):
    """The list of checksums takes no other names: such a folder was pushed, and every pull of it failed."""
    monkeypatch.chdir(tmp_path)
    data = data_sets(tmp_path / "data")
    shutil.copytree(data / "go", data / ".go.replaced")  # of a pull that was killed
    assert main(["models", "push", "--data", "data", "--to", "./pushed"]) == 0
    assert main(["models", "pull", "--data", "theirs", "--from", "./pushed"]) == 0
    assert sorted(path.name for path in (tmp_path / "theirs").iterdir()) == ["go", "turn"]
    (data / "go").rename(data / "go there")
    line = refused(capsys, "push", "--data", "data", "--to", "./other")
    assert "tailor models: go there/" in line
    assert ": expected names of letters, digits, _, . and -, the first no . or -" in line
    assert not (tmp_path / "other").exists()


def test_what_the_hub_refuses_is_reported_in_one_line(hub, capsys, monkeypatch):
    assert "user/none: no such repository" in refused(capsys, "pull", "--from", "user/none", "--zoo", "zoo")
    hub.files["model", "user/empty"] = {}
    assert "no such revision" in refused(capsys, "pull", "--from", "user/empty", "--revision", "v9", "--zoo", "zoo")
    monkeypatch.setenv("HF_TOKEN", "hf_other")
    assert "user/mine: the hub refuses with status 401" in refused(capsys, "push", ROBOT, "--to", "user/mine")
    monkeypatch.setenv("HF_ENDPOINT", "http://127.0.0.1:9")
    monkeypatch.setattr(time, "sleep", lambda _: None)  # the hub's client tries six times, 1 to 8 s apart
    assert "user/mine: the hub cannot be reached" in refused(capsys, "pull", "--from", "user/mine", "--zoo", "zoo")
    assert "user/mine: the hub cannot be reached" in refused(capsys, "push", ROBOT, "--to", "user/mine")


def test_a_part_that_no_checksum_covers_is_left_out(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    data_sets(tmp_path / "mine")
    assert main(["models", "push", "--data", "mine", "--to", "./pushed"]) == 0
    stray = tmp_path / "pushed" / "go" / "part-00020.parquet"
    shutil.copyfile(tmp_path / "pushed" / "go" / "part-00000.parquet", stray)
    assert main(["models", "pull", "--data", "theirs", "--from", "./pushed"]) == 0
    assert [path.name for path in (tmp_path / "theirs" / "go").glob("*.parquet")] == ["part-00000.parquet"]
