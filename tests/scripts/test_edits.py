"""Edits through the Python module: they change what they say, undo brings back every bit, all of it survives closing."""
import json

import loam
import numpy as np
import pytest
from conftest import fails_with_one_sentence, run_loam


def test_raise_lifts_the_ground_at_its_centre_and_nowhere_else(plain):
    with loam.open(str(plain)) as p:
        near, far = p.height(128, 128), p.height(40, 40)
        dirt = p.sculpt("raise", [(128, 128)], radius_m=10, strength=2)
        assert dirt["height"]
        assert p.height(128, 128) == pytest.approx(near + 2, abs=0.002)
        assert p.height(40, 40) == far
        p.undo()
        assert p.height(128, 128) == near


def test_every_kind_of_command_is_undone_bit_for_bit(plain):
    with loam.open(str(plain)) as p:
        before = p.digest()
        p.sculpt("raise", [(60, 60), (62, 60)], radius_m=8)
        p.sculpt("smooth", [(60, 60)], radius_m=8, strength=0.7)
        p.sculpt("flatten", [(90, 60)], radius_m=8, strength=1, target_m=12)
        p.paint([(100, 100)], layer=p.layers[1], radius_m=6)
        p.paint([(100, 100)], tint=(1, 0.2, 0.2), radius_m=6)
        p.crater(180, 180, radius_m=12, seed=5)
        p.footprints([(30, 30, 0.0), (30.2, 30.7, 0.1)])
        after = p.digest()
        assert after != before
        for _ in range(7):
            p.undo()
        assert p.digest() == before
        assert not p.can_undo
        for _ in range(7):
            p.redo()
        assert p.digest() == after
        with pytest.raises(loam.Error, match="nothing to redo"):
            p.redo()


def test_edits_and_their_undo_survive_closing(plain):
    with loam.open(str(plain)) as p:
        before = p.digest()
        p.crater(128, 128, radius_m=15, seed=2)
        inside = p.height(128, 128)
        after = p.digest()
    with loam.open(str(plain)) as p:
        assert p.digest() == after
        assert p.height(128, 128) == inside
        assert p.history()[0]["command"]["cmd"] == "crater"
        p.undo()
        assert p.digest() == before
    assert loam.verify(str(plain)) == []


def test_a_group_is_undone_as_one(plain):
    with loam.open(str(plain)) as p:
        before = p.digest()
        for i in range(5):
            p.sculpt("raise", [(100 + i, 100)], group=77)
        p.undo()
        assert p.digest() == before


def test_what_was_recorded_replays_to_the_same_document(plain_template, tmp_path):
    import shutil
    first, second, script = tmp_path / "a", tmp_path / "b", tmp_path / "script.jsonl"
    shutil.copytree(plain_template, first)
    shutil.copytree(plain_template, second)
    with loam.open(str(first)) as p:
        p.record_to(str(script))
        p.sculpt("lower", [(50, 50), (55, 52)], radius_m=9)
        p.crater(120, 90, radius_m=8, seed=9)
        p.undo()
        p.paint([(80, 80)], layer=p.layers[0])
        digest = p.digest()
    script.write_text("# a comment\n\n" + script.read_text())
    done = run_loam("replay", second, script, "--json")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["commands"] == 4
    with loam.open(str(second)) as p:
        assert p.digest() == digest


def test_numpy_values_and_json_text_are_commands_too(plain):
    with loam.open(str(plain)) as p:
        p.apply({"cmd": "crater", "x": np.float32(64), "y": np.float64(64), "radius_m": np.int32(5), "seed": 1})
        p.apply('{"cmd":"crater","x":90,"y":64,"radius_m":5,"seed":2}')
        assert [o["x"] for o in p.operators()] == [64, 90]


def test_bad_commands_say_what_is_wrong_and_change_nothing(plain):
    with loam.open(str(plain)) as p:
        before = p.digest()
        for command in ({"cmd": "explode"}, {"cmd": "crater", "x": 1}, {"cmd": "crater", "x": 1, "y": 2, "depht": 3},
                        {"cmd": "paint", "dabs": [[1, 1]], "layer": "no such layer"}, "not json"):
            with pytest.raises(loam.Error) as problem:
                p.apply(command)
            assert len(str(problem.value)) > 10
        assert p.digest() == before


def test_queries_take_scalars_and_arrays(plain):
    with loam.open(str(plain), read_only=True) as p:
        x = np.linspace(10, 200, 7)
        heights = p.height(x, 50.0)
        assert heights.shape == (7,)
        assert heights[3] == p.height(float(x[3]), 50.0)
        normals = p.normal(x, x)
        assert normals.shape == (7, 3)
        np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-3)
        assert p.layer(x, x).dtype.kind in "if"
        hit = p.ray_cast((128, 128, 500), (0, 0, -1))
        assert hit[2] == pytest.approx(p.height(128, 128), abs=0.01)
        assert p.ray_cast((128, 128, 500), (0, 0, 1)) is None


def test_a_closed_project_says_so(plain):
    p = loam.open(str(plain))
    p.close()
    assert p.closed
    with pytest.raises(loam.Error, match="closed"):
        p.digest()


def test_a_read_only_project_refuses_edits(plain):
    with loam.open(str(plain), read_only=True) as p:
        with pytest.raises(loam.Error):
            p.crater(10, 10)


def test_a_large_fill_is_one_step_and_is_taken_back(tmp_path):
    folder = tmp_path / "large"
    assert run_loam("new", folder, "--recipe", "plain", "--size", "2200", "--layer-size", "64").returncode == 0
    with loam.open(str(folder)) as p:
        names = [layer["name"] for layer in p.stats()["settings"]["layers"]]
        first, second, third = names[:3]
        p.fill(layer=first)
        p.paint([[1100, 1100]], second, radius_m=900, hardness=1.0)
        dirt = p.fill(layer=third, replace=second)
        assert dirt["index"]
        places = [(1100, 1100), (300, 1100), (1900, 1100), (1100, 1999), (20, 20), (2190, 2190)]
        expected = [third, third, third, third, first, first]
        shown = lambda: [names[int(p.layer(x, y))] for x, y in places]
        assert shown() == expected
        p.undo()
        assert shown() == [second if e == third else e for e in expected]
        p.redo()
        assert shown() == expected
        assert p.count_stale_pages() == 0
        with pytest.raises(loam.Error, match="unknown layer"):
            p.fill(layer=first, replace="lava")
        assert shown() == expected


def test_settings_of_the_ground_are_set_and_refused(plain):
    done = run_loam("set", plain, "ground.tile_hiding", "true")
    assert done.returncode == 0, done.stderr
    assert run_loam("set", plain, "ground.distortion_amplitude_m", "0.2").returncode == 0
    with loam.open(str(plain)) as p:
        ground = p.stats()["settings"]["ground"]
        assert ground["tile_hiding"] is True and ground["distortion_amplitude_m"] == 0.2
        p.set("ground.tile_hiding", False)
        p.set("ground.distortion_period_m", 12)
        with pytest.raises(loam.Error, match="unknown setting"):
            p.set("ground.colour", 1)
        p.set("ground.vista_scale", 8)
        with pytest.raises(loam.Error, match="vista_scale is 0, must be 1"):
            p.set("ground.vista_scale", 0)
        with pytest.raises(loam.Error, match="one index texel"):
            p.set("ground.distortion_amplitude_m", 1000)
    text = (plain / "project.toml").read_text()
    assert "tile_hiding = false" in text and "distortion_period_m = 12.0" in text and "vista_scale = 8.0" in text
    assert "must be true or false" in fails_with_one_sentence(run_loam("set", plain, "ground.tile_hiding", "1"))
    assert "must be a number" in fails_with_one_sentence(run_loam("set", plain, "sun.azimuth_rad", "north"))


def test_transitions_are_commands(plain, tmp_path):
    """Undone, redone, recorded, replayed and kept like every other edit, also among layers that are added meanwhile."""
    layers = lambda: [line for line in (plain / "project.toml").read_text().splitlines() if "blend" in line or "removed =" in line]
    with loam.open(str(plain)) as p:
        count = len(p.layers)
        camera = loam.Camera.look_at((128, 100, p.height(128, 100) + 6), (128, 128, float(p.height(128, 128))))
        p.record_to(str(tmp_path / "script.jsonl"))
        p.apply({"cmd": "transition", "name": "edge", "from": "grass", "to": "dirt", "threshold": 0.125})
        p.apply({"cmd": "paint", "dabs": [[128, 128]], "radius_m": 40, "layer": "edge"})
        low = np.asarray(p.render(camera=camera, size=(200, 120))).astype(int)
        p.transition("edge", threshold=0.875)
        high = np.asarray(p.render(camera=camera, size=(200, 120))).astype(int)
        assert np.abs(high - low).mean() > 3
        p.undo()
        assert np.abs(np.asarray(p.render(camera=camera, size=(200, 120))).astype(int) - low).max() <= 1
        p.redo()
        assert np.abs(np.asarray(p.render(camera=camera, size=(200, 120))).astype(int) - high).max() <= 1
        p.remove_transition("edge")
        assert "edge" not in p.layers
    with loam.open(str(plain)) as p:  # the history survives
        p.undo()
        assert p.layers[count] == "edge" and "threshold = 0.875" in (plain / "project.toml").read_text()
        p.undo()
        assert "threshold = 0.125" in (plain / "project.toml").read_text()
        p.undo()
        p.undo()  # made it
        assert not p.can_undo and "edge" not in p.layers and len(p.layers) == count + 1, "its number is kept"
        for _ in range(4):
            p.redo()
        assert not p.can_redo and "edge" not in p.layers
        p.undo()
        assert np.abs(np.asarray(p.render(camera=camera, size=(200, 120))).astype(int) - high).max() <= 1
        for bad, said in (({"name": ""}, "needs a name"), ({"name": "x"}, "needs the layers"), ({"name": "grass"}, "is a layer"),
                          ({"name": "edge", "threshold": 1.5}, "threshold is 1.5"), ({"name": "edge", "blend": 1}, "unknown key"),
                          ({"name": "edge", "remove": True, "to": "dirt"}, "stands alone"),
                          ({"name": "edge", "to": "grass"}, "to itself")):
            with pytest.raises(loam.Error, match=said):
                p.apply({"cmd": "transition", **bad})
        before = layers()
    assert run_loam("verify", plain).returncode == 0
    assert before == layers() and len(before) == 1
    # Made of the recorded script, another project has the same list.
    with loam.open(str(plain)) as p:
        for _ in range(3):
            p.undo()
        assert not p.can_undo
    done = run_loam("replay", plain, tmp_path / "script.jsonl")
    assert done.returncode == 0, done.stderr
    assert "removed = true" in "".join(layers())


def test_transitions_are_made_placed_changed_and_removed(plain):
    done = run_loam("transition", plain, "edge", "--from", "grass", "--to", "dirt", "--threshold", "0.4")
    assert done.returncode == 0, done.stderr
    with loam.open(str(plain)) as p:
        edge = p.layers.index("edge")
        p.apply({"cmd": "paint", "dabs": [[128, 128]], "radius_m": 60, "layer": "grass"})
        p.apply({"cmd": "paint", "dabs": [[128, 128]], "radius_m": 12, "layer": "dirt", "transitions": True})
        x = np.arange(100, 157, 0.5)
        row = p.layer(x, np.full_like(x, 128.0))
        assert set(row) == {p.layers.index("grass"), edge, p.layers.index("dirt")}
        p.undo()
        assert edge not in set(p.layer(x, np.full_like(x, 128.0)))
        p.redo()
        p.transition("edge", threshold=0.8)
        p.remove_transition("edge")
        assert "edge" not in p.layers and len(p.layers) == edge + 1, "its number is kept"
        p.transition("new edge", "dirt", "grass")
        assert p.layers.index("new edge") == edge, "and taken again"
        with pytest.raises(loam.Error, match="to itself"):
            p.transition("none", "dirt", "dirt")
        with pytest.raises(loam.Error, match="no layer \"mud\" with textures"):
            p.transition("none", "dirt", "mud")
        with pytest.raises(loam.Error, match="true or false"):
            p.apply({"cmd": "paint", "dabs": [[1, 1]], "layer": "dirt", "transitions": 1})
    assert "there is no transition" in fails_with_one_sentence(run_loam("transition", plain, "edge", "--remove"))
    assert "threshold is 2" in fails_with_one_sentence(run_loam("transition", plain, "new edge", "--threshold", "2"))
