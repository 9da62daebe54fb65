"""The interface package in the repository is the one that the command writes, and ROS 2's own tools accept it."""

import subprocess
import sys
from xml.etree import ElementTree

import pytest

from tailor import __version__
from tailor.schemas.ros2 import interface_package, service
from tailor.schemas.ros2.interface_package import FOLDER, files, main, write


def content(folder):
    return {path.relative_to(folder).as_posix(): path.read_text() for path in folder.rglob("*") if path.is_file()}


def test_the_files_in_the_repository_are_those_that_the_command_writes():
    assert content(FOLDER) == files(), "run: make ros2"


def test_the_command_writes_into_any_workspace_and_removes_what_is_no_longer_a_type(tmp_path):
    write(tmp_path)
    (tmp_path / "msg" / "Gone.msg").write_text("bool gone\n")
    command = [sys.executable, "-m", "tailor.schemas.ros2.interface_package", tmp_path]
    subprocess.run(command, check=True)
    assert content(tmp_path) == files()


def test_an_installation_is_never_written_into(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(interface_package, "ROOT", tmp_path)
    monkeypatch.setattr(interface_package, "FOLDER", tmp_path / "ros2")
    assert main([]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert f"{tmp_path} is an installation, not the repository: expected a FOLDER" in line
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_cannot_be_written_is_told_in_one_line(tmp_path, capsys):
    (tmp_path / "file").touch()
    assert main([str(tmp_path / "file")]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line == f"interface_package: {tmp_path / 'file'}: File exists, expected a folder that can be written"


@pytest.mark.parametrize("manifest", [None, "<package><name>camera_msgs</name></package>"])
def test_messages_of_another_package_are_never_removed(manifest, tmp_path, capsys):
    message = tmp_path / "msg" / "Image.msg"
    message.parent.mkdir()
    message.touch()
    if manifest is not None:
        (tmp_path / "package.xml").write_text(manifest)
    assert main([str(tmp_path)]) == 2
    assert capsys.readouterr().err.startswith(f"interface_package: {tmp_path} holds other files, expected")
    assert message.is_file()


def test_all_is_plain_ascii_for_the_generators_of_ros():
    assert all(text.isascii() for text in files().values())


def test_the_manifest_and_the_build_name_the_package_and_every_interface(tmp_path):
    write(tmp_path)
    manifest = ElementTree.parse(tmp_path / "package.xml").getroot()
    assert (manifest.findtext("name"), manifest.findtext("version")) == ("tailor_msgs", __version__)
    build = (tmp_path / "CMakeLists.txt").read_text()
    assert all(f'"{name}"' in build for name in files() if name.endswith((".msg", ".srv", ".action")))


def test_the_service_file_has_the_two_parts_of_the_definition():
    request, response = service.text().split("---\n")
    assert (service.REQUEST in request, service.RESPONSE in response) == (True, True)
