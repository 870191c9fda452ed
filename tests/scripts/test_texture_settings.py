"""The virtual texture's size and format switched live, its named figures, announced teleports, debug views."""
import json

import loam
import numpy as np
import pytest
from conftest import fails_with_one_sentence, run_loam

SIZE, LARGER = (192, 108), (640, 360)
# Ultra and high uncompressed take gigabytes: those are tried as blocks.
LEVELS = [("very_low", "rgba8"), ("low", "bc1"), ("mid", "bc3"), ("high", "bc1"), ("ultra", "bc1"), ("low", "rgba8")]


def eye(project, x=60.0, y=60.0, yaw=40.0, above=3.0, pitch=-12.0):
    return (x, y, float(project.height(x, y)) + above, yaw, pitch)


def texture(project):
    return project.stats()["frame"]["texture"]


@pytest.fixture
def opened(plain, has_device):
    projects = []

    def open_project(**options):
        """read_only: beside another one that writes."""
        projects.append(loam.open(str(plain), validation=True, **options))
        return projects[-1]

    yield open_project
    for project in projects:
        if not project.closed:
            assert project.validation_messages() == 0
            project.close()


def other_layer(project, x, y):
    """A layer that the ground has not got there: painting it changes something."""
    there = int(project.layer(x, y))
    return project.layers[(there + 1) % len(project.layers)]


def worst(a, b):
    return int(np.abs(a.astype(int) - b.astype(int)).max())


def alike(a, b):
    """Settled pictures of one view, made in two ways. A handful of pixels may come from a page beside the one that the other
    shows: which of the sectors that hardly a pixel sees have their root page depends on when they were looked at."""
    return worst(a, b) <= 8 and (a != b).any(axis=2).mean() < 0.005


def test_levels_and_formats_switch_live_without_a_leak(opened):
    project = opened(quality="very_low", format="rgba8")
    camera = eye(project)
    project.render(camera=camera, size=SIZE)
    pictures, memory = {}, {}
    order = LEVELS + LEVELS[::-1] + [LEVELS[i] for i in (3, 0, 5, 2)]
    for step, (quality, page_format) in enumerate(order):
        # Also one that is not waited for: it must leave nothing behind.
        if step % 3 == 1:
            project.set_quality(*order[(step * 5) % len(order)])
            project.step(camera, n=step % 7, size=SIZE)
        project.set_quality(quality, page_format)
        picture = project.render(camera=camera, size=SIZE)
        assert project.stats()["settled"]
        project.step(camera, n=6, size=SIZE)    # what is retired has gone
        key = (quality, page_format)
        held = project.stats()["allocated_bytes"]["device"]
        assert memory.setdefault(key, held) == held, f"{key}: device memory grew"
        assert alike(pictures.setdefault(key, picture), picture), f"{key}: another picture than the last time"
    assert len(set(memory.values())) == len(memory), "every level has its own size"
    assert project.count_stale_pages() == 0
    project.close()
    # A session that begins at that level has the same picture: when still, a picture depends on its view only.
    for quality, page_format in (LEVELS[0], LEVELS[1], LEVELS[4]):
        fresh = opened(quality=quality, format=page_format)
        assert alike(fresh.render(camera=camera, size=SIZE), pictures[quality, page_format])
        fresh.step(camera, n=6, size=SIZE)
        assert fresh.stats()["allocated_bytes"]["device"] == memory[quality, page_format]
        fresh.close()
    assert not alike(pictures[LEVELS[0]], pictures[LEVELS[1]]), "blocks and no blocks cannot be the same"


def test_no_frame_of_a_switch_shows_less_than_before(opened):
    project = opened(quality="low", format="rgba8")
    camera = eye(project)
    before = project.render(camera=camera, size=SIZE).astype(float)
    project.set_quality("mid", "bc1")
    frames = []
    for _ in range(200):
        frames.append(project.render(camera=camera, size=SIZE, max_frames=1).astype(float))
        if project.stats()["settled"] and len(frames) > 8:
            break
    after = frames[-1]
    assert texture(project)["capacity_pages"] == 22 * 22
    both = [min(np.abs(f - before).mean(), np.abs(f - after).mean()) for f in frames]
    assert max(both) < 0.5, "a frame shows neither the old texture nor the new one"
    # What it would look like if the new texture were shown at once: the first frames of a session.
    fresh = opened(quality="mid", format="bc1", read_only=True)
    first = fresh.render(camera=camera, size=SIZE, max_frames=2).astype(float)
    assert np.abs(first - after).mean() > 2


def test_edits_during_a_switch_are_in_the_new_texture(opened):
    project = opened(quality="low", format="rgba8")
    camera = eye(project)
    before = project.render(camera=camera, size=SIZE)
    project.set_quality("mid", "rgba8")
    for i in range(6):
        project.step(camera, n=2, size=SIZE)
        project.paint([(66 + i, 68)], layer=other_layer(project, 66 + i, 68), radius_m=2)
    picture = project.render(camera=camera, size=SIZE)
    assert project.count_stale_pages() == 0
    fresh = opened(quality="mid", format="rgba8", read_only=True)
    assert alike(fresh.render(camera=camera, size=SIZE), picture)
    assert not alike(before, picture), "the edits are not in the picture"


def test_settings_do_what_they_say(opened):
    def jump(settings, frames, moving=False, size=SIZE):
        """A session at one place, then at another for some frames; what its texture has done since."""
        project = opened(settings=settings, quality="very_low", format="rgba8")
        project.render(camera=eye(project), size=size)
        before = texture(project)["pages_composed"]
        project.step(eye(project, 190, 180, 200), n=frames, size=size, moving=moving)
        after = texture(project)
        project.close()
        return after["pages_composed"] - before, after

    composed = {n: jump({"texture.budget_pages": n}, 6, size=LARGER)[0] for n in (1, 4)}
    assert 3 <= composed[1] <= 6 and 2 * composed[1] < composed[4] <= 24, composed
    slow, quick = (jump({"texture.budget_ms": ms}, 8, size=LARGER)[0] for ms in (0.01, 200))
    assert slow <= 8 and quick > 1.5 * slow, (slow, quick)
    assert jump({"texture.feedback": "grid"}, 4, moving=True)[1]["feedback_cells"] == 240 * 136
    assert jump({"texture.feedback": "eighth"}, 4, moving=True)[1]["feedback_cells"] == 24 * 14
    few = jump({"texture.cache_divisor": 12}, 60, moving=True, size=LARGER)[1]
    many = jump({"texture.cache_divisor": 3}, 60, moving=True, size=LARGER)[1]
    assert few["requested_pages"] <= 169 // 12 < many["requested_pages"] <= 169 // 3
    assert jump({"texture.max_live_sectors": 2}, 30)[1]["live_sectors"] == 2
    assert jump({"texture.hidden_divisor": 100}, 40)[1]["hidden_pages"] <= 1
    assert jump({"texture.hidden_divisor": 16}, 40)[1]["hidden_pages"] > 1
    strict = jump({"texture.threshold_share": 0.3}, 40, moving=True)[1]
    assert strict["requested_pages"] < jump({}, 40, moving=True)[1]["requested_pages"]
    assert jump({"texture.pages_per_side": 9}, 2)[1]["capacity_pages"] == 81


def test_wrong_settings_are_one_sentence(plain):
    with pytest.raises(loam.Error, match="did you mean texture.budget_pages"):
        loam.open(str(plain), settings={"texture.budget_page": 1})
    with pytest.raises(loam.Error, match="0 … 64"):
        loam.open(str(plain), settings={"texture.budget_pages": 65})
    assert "did you mean" in fails_with_one_sentence(run_loam("render", plain, "--set", "texture.budget_page=3"))
    listed = json.loads(run_loam("info", plain, "--settings", "--json").stdout)["renderer"]
    assert {s["name"] for s in listed} == {s["name"] for s in loam.settings()}
    changed = json.loads(run_loam("info", plain, "--settings", "--json", "--set", "texture.age_frames=9").stdout)["renderer"]
    assert [s["value"] for s in changed if s["name"] == "texture.age_frames"] == ["9"]


def test_an_edit_in_view_is_composed_before_a_backlog(opened):
    project = opened(settings={"texture.budget_pages": 1}, quality="low", format="rgba8")
    project.render(camera=eye(project), size=LARGER)
    there = eye(project, 190, 180, 200)
    project.step(there, n=8, size=LARGER)
    assert texture(project)["missing_pages"] > 10, "there is no backlog"
    for i in range(5):
        project.paint([(188 - i, 172)], layer=other_layer(project, 188 - i, 172), radius_m=1.0)
        assert texture(project)["dirty_pages"] > 0
        project.step(there, n=2, size=LARGER)
        left = texture(project)
        assert left["dirty_pages"] == 0 and left["missing_pages"] > 0, left


def test_an_announced_teleport_is_sharp_at_once(opened):
    size = (480, 270)
    shares = {}
    for announced in (0, 90):
        project = opened(quality="low", format="rgba8")
        here, there = eye(project), eye(project, 190, 180, 200)
        project.render(camera=here, size=size)
        if announced:
            project.announce(there)
            project.step(here, n=announced, size=size)
            assert texture(project)["announced_missing"] == 0
            project.announce(None)
        project.step(there, n=4, size=size)     # the first frame's feedback is read three frames later
        shares[announced] = texture(project)["sharp_share"]
        project.close()
    assert shares[90] >= 0.95 and shares[0] < 0.8, shares


def test_the_command_line_announces(plain, has_device, tmp_path):
    with loam.open(str(plain), read_only=True) as project:
        here, there = (",".join(map(str, e)) for e in (eye(project), eye(project, 190, 180, 200)))
    words = ["render", plain, "--size", "480x270", "--from", here, "--camera", there, "--json", "--max-frames", "4",
             "-o", tmp_path / "p.png"]
    cold = json.loads(run_loam(*words).stdout)["texture"]["sharp_share"]
    warm = json.loads(run_loam(*words, "--announce", "80").stdout)["texture"]["sharp_share"]
    assert warm > cold
    assert "--from" in fails_with_one_sentence(run_loam("render", plain, "--announce", "3"))


def test_every_debug_view_is_a_picture_of_its_own(opened):
    project = opened(quality="very_low", format="rgba8")
    camera = eye(project)
    project.crater(66, 70, radius_m=3)
    pictures = {}
    for view in loam.debug_views():
        picture = project.render(camera=camera, size=SIZE, debug=view)
        assert picture[..., :3].std() > 1, f"{view} is empty"
        for other, seen in pictures.items():
            assert worst(picture, seen) > 8, f"{view} shows the same as {other}"
        pictures[view] = picture
    assert len(pictures) >= 18
    # Looking must change nothing.
    assert np.array_equal(project.render(camera=camera, size=SIZE), pictures["none"])
    listed = run_loam("render", "--help").stdout
    assert all(f"  {view} " in listed for view in pictures)
    with pytest.raises(loam.Error, match="unknown debug view"):
        project.render(camera=camera, size=SIZE, debug="mip")


def test_dirt_and_cost_show_where_an_edit_was(opened):
    project = opened(quality="very_low", format="rgba8")
    camera = eye(project)
    project.render(camera=camera, size=SIZE)
    clean = project.render(camera=camera, size=SIZE, debug="dirt", max_frames=1).astype(int)
    project.paint([(66, 68)], layer=other_layer(project, 66, 68), radius_m=1)
    project.step(camera, n=1, size=SIZE)
    dirty = project.render(camera=camera, size=SIZE, debug="dirt", max_frames=1).astype(int)
    red = (dirty[..., 0] - dirty[..., 2]) - (clean[..., 0] - clean[..., 2]) > 40
    assert 0.001 < red.mean() < 0.6, "the edit is not where the view shows dirt"
    project.step(camera, n=130, size=SIZE)
    faded = project.render(camera=camera, size=SIZE, debug="dirt", max_frames=1).astype(int)
    assert ((faded[..., 0] - faded[..., 2]) - (clean[..., 0] - clean[..., 2]) > 40).mean() == 0
