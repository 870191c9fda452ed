"""Procedural decals: functions in the picture, in the project, in what verify says; what gives no number stays within its decal."""
import json
import os

import loam
import numpy as np
import pytest
from conftest import fails_with_one_sentence, run_loam

ABOVE = (128, 128, 24, 0, -90)
SIZE = (200, 120)


def body(text):
    return "void decal(Place at, inout Surface s) {\n" + text + "\n}\n"


RED = body("  s.colour = vec3(1.0, 0.0, 0.0);")


def pictures(p, **options):
    return p.render(ABOVE, size=SIZE, **options)[..., :3].astype(int)


@pytest.mark.usefixtures("has_device")
def test_a_function_is_seen_and_changes_where_it_shows(plain):
    with loam.open(str(plain), validation=True) as p:
        bare = pictures(p)
        p.set_function("mine", RED)
        p.decal(128, 128, half_m=[4, 4], function="mine", edge=0)
        red = pictures(p)
        changed = (red != bare).any(axis=2)
        assert 0.02 < changed.mean() < 0.4
        middle = red[55:65, 95:105].reshape(-1, 3).mean(axis=0)
        assert middle[0] > 90 and middle[1] < 30 and middle[2] < 30
        # Another text: the same texels, no others, and back bit for bit.
        dirt = p.set_function("mine", body("  s.colour = vec3(0.0, 0.0, 1.0);"))
        assert len(dirt["texture"]) == 1 and not dirt["height"]
        blue = pictures(p)
        assert ((blue != bare).any(axis=2) == changed).all() and blue[60, 100, 2] > 90
        with pytest.raises(loam.Error, match="decals/mine.glsl:2: 'nothing' : undeclared"):
            p.set_function("mine", body("  s.gloss = nothing;"))
        assert (pictures(p) == blue).all(), "the version before stays"
        p.set_function("mine", RED)
        assert (pictures(p) == red).all()
        p.undo()
        assert (pictures(p) == bare).all()
    assert loam.verify(str(plain)) == []


@pytest.mark.usefixtures("has_device")
def test_what_gives_no_number_stays_within_its_decal_and_is_reported(plain):
    """Division by zero, NaN and infinity in every field, on one half of a decal: that half shows the ground."""
    fields = ("s.colour.g", "s.gloss", "s.metalness", "s.occlusion", "s.slope.x", "s.cover")
    values = ("z / z", "1.0 / z", "-1.0 / z", "sqrt(z - 1.0)", "log(z - 1.0)", "pow(z - 1.0, 0.5)", "inversesqrt(z)")
    with loam.open(str(plain), validation=True) as p:
        bare, bare_reference = pictures(p), pictures(p, reference=True)
        p.set_function("bad", RED)
        p.decal(128, 128, half_m=[4, 4], function="bad", edge=0)
        red = pictures(p)
        inside = (red != bare).any(axis=2)
        west = np.arange(SIZE[0]) < SIZE[0] // 2 - 2
        east = np.arange(SIZE[0]) > SIZE[0] // 2 + 1
        for i, value in enumerate(values):
            field = fields[i % len(fields)]
            # A zero that no compiler knows of.
            p.set_function("bad", body(f"  float z = min(at.p.x, 0.0) * 0.0; s.colour = vec3(1.0, 0.0, 0.0);\n"
                                       f"  if (at.p.x > 0.0) {field} = {value};"))
            now = pictures(p)
            assert not ((now != bare).any(axis=2) & ~inside).any(), (field, value)
            assert (now[:, east] == bare[:, east]).all(), (field, value)
            assert (now[:, west] == red[:, west]).all(), (field, value)
            report = next(f for f in p.functions() if f["name"] == "bad")
            assert report["failed_texels"] > 100, (field, value)
        reference = pictures(p, reference=True)
        assert (reference[:, east] == bare_reference[:, east]).all(), "and so it does in direct shading"
        assert (reference[55:65, 90:95, 0] > bare_reference[55:65, 90:95, 0] + 30).all()
        p.set_function("bad", RED)
        assert "failed_texels" not in next(f for f in p.functions() if f["name"] == "bad")


@pytest.mark.usefixtures("has_device")
@pytest.mark.parametrize("kind", ("decal", "spline", "volume"))
def test_every_kind_is_made_by_functions_and_the_reference_agrees(plain, kind):
    with loam.open(str(plain), validation=True) as p:
        z = float(p.height(128, 128))
        common = {"function": "cracks", "parameters": {"plate": 1.5, "gap": 0.2}, "edge": 0.3, "seed": 4}
        bare = pictures(p)
        if kind == "decal":
            p.decal(128, 128, half_m=[6, -4], heading_rad=0.5, **common)
        elif kind == "spline":
            p.spline([[116, 124, z], [122, 126, z], [130, 132, z], [140, 130, z]], width_m=7, **common)
        else:
            p.volume([128, 128, z], half_m=[6, 4, 5], direction=[0.2, 0.1, -1], **common)
        p.set_function("mine", RED)
        p.decal(120, 134, half_m=[1, 1], function="mine")  # a second function in the one shader of direct shading
        shown, reference = pictures(p), pictures(p, reference=True)
        assert (shown != bare).any(axis=2).mean() > 0.05
        difference = np.abs(shown - reference)
        assert np.sqrt((difference.astype(float) ** 2).mean()) < 6, "texels of pages against a pixel's own"
        p.edit_operator(1, parameters={"plate": 1.5, "gap": 0.2, "dry": 0})
        assert (pictures(p) != shown).any()
        p.undo()
        assert (pictures(p) == shown).all()


@pytest.mark.usefixtures("has_device")
def test_pages_of_functions_are_those_of_nothing_before(plain):
    """Any history of texts and edits: resident pages equal their composition from nothing."""
    texts = (RED, body("  s.cover = ramp(0.0, 0.2, noise(at.p, at.seed)); s.slope += vec2(0.3, 0.0);"),
             "float relief(Place at) { return 0.2 * noise(at.p * 2.0, at.seed); }\n" + body("  s.gloss = 0.9;"))
    with loam.open(str(plain), validation=True) as p:
        p.set_function("mine", RED)
        for i in range(12):
            p.decal(118 + 2 * i, 122 + i, half_m=[3, 2], function=("mine", "gravel", "moss")[i % 3], seed=i)
            p.set_function("mine", texts[i % 3])
            if i % 4 == 3:
                p.undo()
            pictures(p)
            assert p.count_stale_pages() == 0
        before = pictures(p)
    with loam.open(str(plain)) as p:
        assert (pictures(p) == before).all(), "another process composes the same"


def test_the_verb_lists_prints_and_sets(plain, tmp_path):
    listed = json.loads(run_loam("function", plain, "--json").stdout)
    assert {f["name"] for f in listed} >= {"puddle", "cracks", "moss", "gravel", "tyre_marks", "scorch", "leaf_litter",
                                           "sand_ripples", "snow_patch", "footpath", "oil", "frost"}
    assert all(f["says"] and f["steps"] > 0 and len(f["parameters"]) >= 3 for f in listed)
    assert "How full it is" in run_loam("function", plain).stdout
    (tmp_path / "good.glsl").write_text(RED)
    (tmp_path / "bad.glsl").write_text(body("\n  while (true) {}"))
    assert run_loam("function", plain, "--name", "mine", "--set", tmp_path / "good.glsl").returncode == 0
    assert run_loam("function", plain, "--name", "mine").stdout == RED
    for words, sentence in ((("--name", "mine", "--set", tmp_path / "bad.glsl"), "decals/mine.glsl:3: while has no bound"),
                            (("--name", "../mine", "--set", tmp_path / "good.glsl"), "is no name of a decal's function"),
                            (("--name", "none"), 'unknown function "none" (known: '),
                            (("--set", tmp_path / "good.glsl"), "--set needs --name"),
                            (("--name", "mine", "--set", tmp_path / "gone.glsl"), "cannot read")):
        assert sentence in fails_with_one_sentence(run_loam("function", plain, *words))
    assert run_loam("function", plain, "--name", "mine").stdout == RED
    (plain / "decals" / "mine.glsl").write_text(body("\n  s.gloss = gone;"))
    failed = run_loam("verify", plain)
    assert failed.returncode != 0 and "decals/mine.glsl:3: 'gone' : undeclared identifier" in failed.stdout + failed.stderr


def test_another_program_saves_a_text(plain):
    with loam.open(str(plain)) as p:
        p.set_function("mine", RED)
        p.decal(128, 128, half_m=[4, 4], function="mine")
        file = plain / "decals" / "mine.glsl"
        assert p.poll_functions()["texture"] == []
        stamp = file.stat().st_mtime_ns
        file.write_text(body("  s.gloss = gone;"))
        os.utime(file, ns=(stamp + 10**9, stamp + 10**9))
        assert p.poll_functions()["texture"] == []
        assert "'gone' : undeclared" in next(f for f in p.functions() if f["name"] == "mine")["error"]
        file.write_text(RED + "// more\n")
        os.utime(file, ns=(stamp + 2 * 10**9, stamp + 2 * 10**9))
        assert len(p.poll_functions()["texture"]) == 1
        with pytest.raises(loam.Error, match='has no parameter "a" \\(it has: none\\)'):
            p.decal(1, 1, function="mine", parameters={"a": 1})
        with pytest.raises(loam.Error, match="must be a number, found text|must be a number, found string"):
            p.decal(1, 1, function="moss", parameters={"growth": "much"})
        with pytest.raises(loam.Error, match="the parameter growth of moss is 7, must be 0 … 1"):
            p.decal(1, 1, function="moss", parameters={"growth": 7})
