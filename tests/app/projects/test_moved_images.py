from __future__ import annotations

from pathlib import Path

from calibgui.app.photographs.image_store import compute_file_digest
from calibgui.app.projects.moved_images import find_moved_images, list_missing_images
from calibgui.app.projects.project import Project, add_images


def test_moved_images_are_known_by_name_and_content(tmp_path: Path) -> None:
    new = tmp_path / "new" / "deep"
    new.mkdir(parents=True)
    for name, content in (("a.png", b"first"), ("renamed.png", b"second"), ("c.png", b"other")):
        (new / name).write_bytes(content)
    old = {name: str(tmp_path / "old" / name) for name in ("a.png", "b.png", "c.png", "d.png")}
    project = add_images(Project(), [*old.values(), str(new / "a.png")])
    missing = list_missing_images(project)
    assert missing == list(old.values())
    digests = {
        old["a.png"]: compute_file_digest(new / "a.png"),
        old["b.png"]: compute_file_digest(new / "renamed.png"),
        old["c.png"]: compute_file_digest(new / "a.png"),
    }
    moved = find_moved_images(missing, tmp_path / "new", digests)
    # c.png has another content now, though another file has its old one; d.png is nowhere.
    assert moved == {
        old["a.png"]: str(new / "a.png"),
        old["b.png"]: str(new / "renamed.png"),
        old["c.png"]: str(new / "a.png"),
    }
    assert find_moved_images([old["c.png"]], tmp_path / "new", {}) == {
        old["c.png"]: str(new / "c.png")
    }


def test_of_files_of_the_same_name_that_of_the_same_folder_is_taken(tmp_path: Path) -> None:
    for name in ("left/1.png", "right/1.png"):
        (tmp_path / "new" / name).parent.mkdir(parents=True)
        (tmp_path / "new" / name).write_text(name)
    missing = [str(tmp_path / "old" / name) for name in ("right/1.png", "left/1.png")]
    assert find_moved_images(missing, tmp_path / "new", {}) == {
        missing[0]: str(tmp_path / "new" / "right" / "1.png"),
        missing[1]: str(tmp_path / "new" / "left" / "1.png"),
    }
