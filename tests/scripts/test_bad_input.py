"""Bad input through the command line: one clear sentence and a non-zero exit, each."""
import os

import numpy as np
import pytest
from conftest import fails_with_one_sentence, run_loam, write_png16, write_tiff_float


def test_a_truncated_png(tmp_path):
    write_png16(tmp_path / "h.png", np.random.default_rng(1).integers(0, 65535, (64, 64)))
    whole = (tmp_path / "h.png").read_bytes()
    for share in (0.02, 0.3, 0.6, 0.95):
        (tmp_path / "cut.png").write_bytes(whole[:int(len(whole) * share)])
        line = fails_with_one_sentence(run_loam("import", tmp_path / "cut.png", tmp_path / "p", "--range", 0, 100))
        assert "cut.png" in line
        assert not (tmp_path / "p").exists()


def test_a_truncated_tiff(tmp_path):
    write_tiff_float(tmp_path / "h.tif", np.zeros((64, 64)))
    (tmp_path / "cut.tif").write_bytes((tmp_path / "h.tif").read_bytes()[:8000])
    assert "cut.tif" in fails_with_one_sentence(run_loam("import", tmp_path / "cut.tif", tmp_path / "p"))


def test_a_text_file_as_png(tmp_path):
    (tmp_path / "h.png").write_text("these are no heights\n")
    assert "text" in fails_with_one_sentence(run_loam("import", tmp_path / "h.png", tmp_path / "p", "--range", 0, 1))


def test_nan_heights_are_counted_and_located(tmp_path):
    heights = np.full((20, 30), 5.0)
    heights[7, 11] = np.nan
    heights[9, 2] = np.inf
    write_tiff_float(tmp_path / "h.tif", heights)
    line = fails_with_one_sentence(run_loam("import", tmp_path / "h.tif", tmp_path / "p"))
    assert "2 of 600" in line and "column 11, row 7" in line and "--fill-nan" in line
    assert run_loam("import", tmp_path / "h.tif", tmp_path / "p", "--fill-nan", 1, "--layer-size", 0).returncode == 0


def test_a_missing_file_and_a_missing_project(tmp_path):
    assert "does not exist" in fails_with_one_sentence(run_loam("import", tmp_path / "no.png", tmp_path / "p"))
    for verb in ("info", "verify", "render"):
        assert "no-project" in fails_with_one_sentence(run_loam(verb, tmp_path / "no-project"))


def test_a_database_of_zeros(plain):
    (plain / "terrain.db").write_bytes(b"\0" * 40960)
    for side in ("terrain.db-wal", "terrain.db-shm"):
        (plain / side).unlink(missing_ok=True)
    for verb in ("info", "verify", "render"):
        fails_with_one_sentence(run_loam(verb, plain))


def test_a_script_with_an_unknown_command_names_file_and_line(plain, tmp_path):
    script = tmp_path / "s.jsonl"
    script.write_text('{"cmd":"crater","x":50,"y":50,"radius_m":5,"seed":1}\n# fine\n{"cmd":"explode"}\n')
    line = fails_with_one_sentence(run_loam("replay", plain, script))
    assert "s.jsonl:3:" in line and "explode" in line
    assert "nothing" not in line


def test_a_missing_script(plain, tmp_path):
    assert "no.jsonl" in fails_with_one_sentence(run_loam("replay", plain, tmp_path / "no.jsonl"))


def test_a_file_where_the_project_should_be(tmp_path):
    (tmp_path / "file").write_text("x")
    fails_with_one_sentence(run_loam("info", tmp_path / "file"))
    fails_with_one_sentence(run_loam("new", tmp_path / "file" / "project", "--recipe", "plain", "--size", 64))
    fails_with_one_sentence(run_loam("new", tmp_path / "file", "--recipe", "plain", "--size", 64))


@pytest.fixture
def open_folder():
    """A folder that any user may enter: pytest's own is closed to others."""
    import shutil
    import tempfile
    from pathlib import Path
    path = Path(tempfile.mkdtemp(prefix="loam_read_only_"))
    path.chmod(0o755)
    yield path
    for folder in [path, *(f for f in path.rglob("*") if f.is_dir())]:
        folder.chmod(0o700)
    shutil.rmtree(path)


def run_unprivileged(*words):
    """Root may write everywhere, so the program runs as nobody (65534) then."""
    return run_loam(*words, **({"user": 65534, "group": 65534, "extra_groups": []} if os.geteuid() == 0 else {}))


def test_a_read_only_folder(plain, open_folder):
    import shutil
    try:
        if run_unprivileged("--help").returncode != 0:
            pytest.skip("the program does not run as another user")
    except PermissionError:
        pytest.skip("another user may not run the program")
    locked, project, script = open_folder / "locked", open_folder / "plain", open_folder / "s.jsonl"
    locked.mkdir()
    locked.chmod(0o555)
    write_png16(open_folder / "h.png", np.arange(64).reshape(8, 8) * 900)
    shutil.copytree(plain, project)
    script.write_text('{"cmd":"crater","x":50,"y":50,"radius_m":5,"seed":1}\n')
    for path in (open_folder / "h.png", script):
        path.chmod(0o444)
    for path in [*project.rglob("*"), project]:
        path.chmod(0o555 if path.is_dir() else 0o444)
    before = (project / "terrain.db").read_bytes()
    assert "locked" in fails_with_one_sentence(
        run_unprivileged("new", locked / "project", "--recipe", "plain", "--size", 64, "--layer-size", 64))
    assert "locked" in fails_with_one_sentence(
        run_unprivileged("import", open_folder / "h.png", locked / "p", "--range", 0, 1, "--layer-size", 0))
    assert str(project) in fails_with_one_sentence(run_unprivileged("replay", project, script))
    assert list(locked.iterdir()) == [] and (project / "terrain.db").read_bytes() == before
    # What only reads works there.
    assert run_unprivileged("info", project).returncode == 0


def test_a_picture_into_a_missing_or_read_only_place(plain, tmp_path, has_device):
    (tmp_path / "file").write_text("x")
    for out in (tmp_path / "no folder" / "o.png", tmp_path / "file" / "o.png"):
        assert "o.png" in fails_with_one_sentence(run_loam("render", plain, "-o", out, "--size", "64x36", "--max-frames", 2))


def test_a_picture_in_colour_and_one_that_is_too_large(tmp_path):
    from conftest import oiio
    oiio("--pattern", "fill:topleft=1,0,0:topright=0,1,0:bottomleft=0,0,1:bottomright=1,1,0", "64x64", "3", "-d", "uint16", "-o", tmp_path / "c.png")
    assert "channels" in fails_with_one_sentence(run_loam("import", tmp_path / "c.png", tmp_path / "p", "--range", 0, 1))
    write_png16(tmp_path / "wide.png", np.zeros((4, 16385)))
    assert "16384" in fails_with_one_sentence(run_loam("import", tmp_path / "wide.png", tmp_path / "p", "--range", 0, 1, "--spacing", 0.5))
    write_png16(tmp_path / "far.png", np.zeros((4, 1000)))
    assert "16800" in fails_with_one_sentence(run_loam("import", tmp_path / "far.png", tmp_path / "p", "--range", 0, 1, "--spacing", 30))


def test_wrong_usage_exits_with_2(plain):
    for words, said in ((["rendr", plain], "render"), (["render", plain, "--sise", "3x3"], "--size"), (["render"], "PROJECT"),
                        (["render", plain, "--camera", "1,2"], "--camera"), (["info", plain, "more"], "more")):
        done = run_loam(*words)
        assert done.returncode == 2
        assert said in fails_with_one_sentence(done)


def test_every_verb_has_help():
    for verb in ("edit", "new", "import", "export", "layer", "pack", "encode", "replay", "render", "info", "verify", "bench"):
        done = run_loam(verb, "--help")
        assert done.returncode == 0 and verb in done.stdout


def test_a_cancelled_new_leaves_nothing(tmp_path):
    import signal
    import subprocess
    import time
    program = os.environ["LOAM_PROGRAM"]
    process = subprocess.Popen([program, "new", str(tmp_path / "p"), "--size", "4096"], stderr=subprocess.PIPE, text=True)
    time.sleep(1.0)
    process.send_signal(signal.SIGINT)
    assert process.wait(60) == 1
    assert "cancelled" in process.stderr.read()
    assert list(tmp_path.iterdir()) == []
