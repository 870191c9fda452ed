"""The window, driven by a real mouse and keyboard on a display without a screen: what is painted is seen, saved, undone,
there again after a restart; and a window that is left alone draws nothing."""
import json
import os
import pathlib
import subprocess
import sys
import time

import pytest
from PIL import Image

sys.path.insert(0, os.path.dirname(__file__))
from desktop import Display, Window, missing_tools  # noqa: E402

LOAM = os.environ.get("LOAM_EXECUTABLE", "loam")

pytestmark = pytest.mark.skipif(bool(missing_tools()), reason=f"not installed: {', '.join(missing_tools())}")


@pytest.fixture(scope="module")
def display():
    made = Display()
    yield made
    made.close()


@pytest.fixture
def project(tmp_path):
    folder = tmp_path / "small"
    subprocess.run([LOAM, "new", str(folder), "--recipe", "plain", "--size", "256", "--layer-size", "128"], check=True,
                   stdout=subprocess.DEVNULL)
    return folder


@pytest.fixture
def opened(display, project):
    """Opens windows and sees that none is left behind."""
    windows = []

    def open_window(*arguments):
        window = Window(display, LOAM, project, *arguments)
        windows.append(window)
        window.wait_for("ready")
        window.settle()
        return window

    yield open_window
    for window in windows:
        if window.process.poll() is None:
            window.process.kill()
            window.process.wait()


def place(window, share_x, share_y):
    """A point of the viewport, by shares of its width and height."""
    x, y, w, h = window.last("viewport")["rect"]
    return int(x + w * share_x), int(y + h * share_y)


def changed_share(before, after, center, half=12):
    """Share of the pixels around a point that differ visibly."""
    count = changed = 0
    for y in range(center[1] - half, center[1] + half):
        for x in range(center[0] - half, center[0] + half):
            a, b = before.getpixel((x, y)), after.getpixel((x, y))
            count += 1
            changed += max(abs(i - j) for i, j in zip(a, b)) > 6
    return changed / count


def keep(name, picture):
    """In the build folder, to look at when a comparison fails."""
    folder = pathlib.Path(os.environ.get("LOAM_BINARY_DIR", ".")) / "window"
    folder.mkdir(exist_ok=True)
    picture.save(folder / name)


def away(display, window):
    """The cursor off the viewport, so that no brush outline is in the picture."""
    display.xdotool("mousemove", 400, 10)
    window.settle()


def wait_for_command(window, name):
    while True:
        command = window.wait_for("command")["command"]
        if command["cmd"] == name:
            return command


def closed_cleanly(window, display):
    assert window.close(display) == 0, "".join(window.errors)
    assert window.last("closed")["validation_messages"] == 0, "".join(window.errors)


def test_paint_crater_undo_save_close_reopen(display, project, opened, tmp_path):
    record = tmp_path / "session.jsonl"
    window = opened("--record", record)
    away(display, window)
    start = display.screenshot()
    assert len(start.getcolors(1 << 24)) > 200, "the ground is not in the picture"

    # Raise: a drag with the first tool.
    display.key("1")
    a, b = place(window, 0.42, 0.55), place(window, 0.58, 0.55)
    display.drag(*a, *b, pause=0.08)
    away(display, window)
    raised = display.screenshot()
    assert changed_share(start, raised, place(window, 0.5, 0.55)) > 0.5

    # Paint with another layer than the ground has.
    display.key("5", "period", "period", "period", "period")
    a, b = place(window, 0.40, 0.70), place(window, 0.60, 0.70)
    display.drag(*a, *b)
    away(display, window)
    painted = display.screenshot()
    assert changed_share(raised, painted, place(window, 0.5, 0.70)) > 0.5

    # A crater by a click, and back with Ctrl+Z.
    display.key("6")
    spot = place(window, 0.5, 0.85)
    display.click(*spot)
    away(display, window)
    cratered = display.screenshot()
    assert changed_share(painted, cratered, spot) > 0.3
    display.key("ctrl+z")
    window.wait_for("command")
    window.settle()
    undone = display.screenshot()
    assert changed_share(painted, undone, spot) < 0.02
    display.key("ctrl+shift+z")
    window.settle()
    display.key("ctrl+s")
    window.settle()
    # Where a window opens depends on the ground, which has changed: the view that the next one will have.
    display.key("Home")
    away(display, window)
    saved = display.screenshot()

    kinds = [c["cmd"] for c in window.commands()]
    assert {"sculpt", "paint", "crater", "undo", "redo"} <= set(kinds)
    closed_cleanly(window, display)
    recorded = [json.loads(line)["cmd"] for line in record.read_text().splitlines()]
    assert recorded == kinds, "the recording differs from what was done"

    # Everything is there again, and looks the same.
    again = opened()
    away(display, again)
    reopened = display.screenshot()
    keep("saved.png", saved)
    keep("reopened.png", reopened)
    # What is missing would change more than half of the pixels (above). A few may differ: pages that too few feedback samples
    # ask for stay resident in a window that has shown them from nearer, and are not composed in a fresh one.
    for share in ((0.5, 0.55), (0.5, 0.70), (0.5, 0.85)):
        assert changed_share(saved, reopened, place(again, *share), half=30) < 0.05
    closed_cleanly(again, display)
    assert subprocess.run([LOAM, "verify", str(project)], capture_output=True).returncode == 0


def test_an_idle_window_draws_nothing(display, opened):
    window = opened()
    away(display, window)
    before, cpu, count = window.last("idle"), window.cpu_s(), len(window.events)
    time.sleep(4)
    while window._take(0.1):
        pass
    assert window.events[count:] == []
    assert window.last("idle") == before
    assert window.cpu_s() - cpu < 0.15, "an idle window uses the processor"
    closed_cleanly(window, display)


def test_hovering_moves_the_outline_without_a_new_picture(display, opened):
    window = opened()
    away(display, window)
    before = window.last("idle")
    plain = display.screenshot()
    spot = place(window, 0.5, 0.6)
    display.xdotool("mousemove", *spot)
    window.settle()
    after = window.last("idle")
    assert after["scene_frames"] == before["scene_frames"]
    assert after["redraws"] > before["redraws"]
    assert changed_share(plain, display.screenshot(), spot, half=60) > 0.005, "no outline"
    closed_cleanly(window, display)


def test_resize_and_cameras(display, opened):
    window = opened()
    away(display, window)
    old = window.last("viewport")
    display.xdotool("search", "--name", "Loam", "windowsize", 1000, 700)
    window.settle()
    new = window.last("viewport")
    assert new["window"] == [1000, 700] and new["rect"][2] < old["rect"][2]

    still = display.screenshot()
    at = place(window, 0.5, 0.6)
    # Orbit: Alt and the left button. Zoom: the wheel. Fly: right button and W.
    display.xdotool("keydown", "alt")
    display.drag(*at, at[0] + 120, at[1] + 20)
    display.xdotool("keyup", "alt")
    away(display, window)
    orbited = display.screenshot()
    assert changed_share(still, orbited, at, half=60) > 0.05
    display.xdotool("mousemove", *at)
    for _ in range(4):
        display.xdotool("click", 4)
        time.sleep(0.05)
    away(display, window)
    zoomed = display.screenshot()
    assert changed_share(orbited, zoomed, at, half=60) > 0.05
    for _ in range(4):  # on a busy machine a second of flight is few frames
        display.xdotool("mousemove", *at, "mousedown", 3, "keydown", "w")
        time.sleep(1)
        display.xdotool("keyup", "w", "mouseup", 3)
        away(display, window)
        flown = changed_share(zoomed, display.screenshot(), at, half=60)
        if flown > 0.05:
            break
    assert flown > 0.05
    assert window.commands() == [], "moving the camera must not edit"
    motion = window.last("motion")
    assert motion and motion["frames"] > 3
    closed_cleanly(window, display)


def menu_item(display, window, title_x, steps):
    """Opens a menu of the bar and chooses the entry after so many steps down, as a person would by keys."""
    display.click(title_x, 16)
    window.settle(quiet_s=0.4)
    display.key(*["Down"] * steps, "Return")


# Where the titles are: File, Edit, View, Debug, … at the left of the bar.
VIEW_X, DEBUG_X = 104, 153
DEBUG_ENTRIES = ("none", "mips", "sectors")
VIEW_QUALITY_ENTRY = {"very_low": 10, "mid": 12}  # entries before the qualities: camera 3, shading 1, resolution 4, outline 1


def choose_quality(display, window, name, pages_a_side):
    """The next texture is shown once it has what the picture wants: on a busy machine that takes a while."""
    menu_item(display, window, VIEW_X, VIEW_QUALITY_ENTRY[name])
    for _ in range(20):
        away(display, window)
        texture = window.last("texture")
        if texture["quality"] == name:
            break
        time.sleep(1)
    assert texture["quality"] == name and texture["pages"] == pages_a_side**2, texture


def test_quality_and_debug_views_from_the_menu(display, opened):
    window = opened()
    away(display, window)
    start = display.screenshot()
    x, y, w, h = window.last("viewport")["rect"]
    middle, half = (int(x + w / 2), int(y + h / 2)), int(min(w, h) * 0.3)

    menu_item(display, window, DEBUG_X, 1 + DEBUG_ENTRIES.index("mips"))
    away(display, window)
    mips = display.screenshot()
    keep("debug_mips.png", mips)
    assert changed_share(start, mips, middle, half) > 0.5, "the view of mips looks like the picture"
    menu_item(display, window, DEBUG_X, 1 + DEBUG_ENTRIES.index("sectors"))
    away(display, window)
    sectors = display.screenshot()
    keep("debug_sectors.png", sectors)
    assert changed_share(mips, sectors, middle, half) > 0.3
    legend = (int(x + 60), int(y + h - 30))
    assert changed_share(start, sectors, legend, 10) > 0.3, "no legend"
    menu_item(display, window, DEBUG_X, 1)
    away(display, window)
    assert changed_share(start, display.screenshot(), middle, half) == 0, "the final picture is another one than before"

    # Another size of the texture: reported, the picture is as sharp or sharper, and back again it is the same.
    assert window.last("texture")["quality"] == "low"
    choose_quality(display, window, "mid", 22)
    keep("quality_mid.png", display.screenshot())
    choose_quality(display, window, "very_low", 13)
    keep("quality_very_low.png", display.screenshot())
    assert window.commands() == [], "a view is no edit"
    closed_cleanly(window, display)


def test_a_missing_project_is_one_sentence_and_a_failure(display, tmp_path):
    run = subprocess.run([LOAM, "edit", str(tmp_path / "nowhere")], env=display.environment, capture_output=True, text=True)
    assert run.returncode != 0
    lines = [line for line in run.stderr.splitlines() if line]
    assert len(lines) == 1 and "nowhere" in lines[0]


def test_a_layer_added_while_the_window_is_open_is_painted_with(display, project, opened, tmp_path):
    folder = tmp_path / "blue"
    folder.mkdir()
    Image.new("RGB", (64, 64), (20, 40, 230)).save(folder / "blue_Color.png")
    window = opened()
    away(display, window)
    start = display.screenshot()
    # A folder that does not exist: said, nothing added.
    for path in (tmp_path / "nowhere", folder):
        display.key("ctrl+l")
        display.xdotool("type", "--delay", 20, str(path))
        display.key("Tab", "ctrl+a")
        display.xdotool("type", "--delay", 20, "sky")
        display.key("Tab", "Tab", "Tab", "Return")
        window.wait_message("sky added" if path == folder else "nowhere")
        window.settle()
        added = '[[layer]]\nname = "sky"' in (project / "project.toml").read_text()
        assert added == (path == folder), window.last("message")
    a, b = place(window, 0.40, 0.70), place(window, 0.60, 0.70)
    display.drag(*a, *b)
    away(display, window)
    painted = display.screenshot()
    keep("added_layer.png", painted)
    x, y = place(window, 0.5, 0.70)
    red, _, blue = painted.getpixel((x, y))
    assert blue > red + 40 and changed_share(start, painted, (x, y)) > 0.5
    assert [c["layer"] for c in window.commands() if c["cmd"] == "paint"][-1] == "sky"
    closed_cleanly(window, display)


def test_the_map_is_edited_while_a_layer_is_added(display, project, opened, tmp_path):
    folder = tmp_path / "noise"
    folder.mkdir()
    for suffix in ("Color", "NormalGL", "Roughness", "Displacement"):
        grey = Image.effect_noise((2048, 2048), 40)
        picture = Image.merge("RGB", (grey, grey, Image.new("L", grey.size, 250)))
        picture.save(folder / f"noise_{suffix}.png")
    window = opened()
    away(display, window)
    start = display.screenshot()
    text = project / "project.toml"
    files = sorted((project / "layers").iterdir())

    def add():
        display.key("ctrl+l")
        display.xdotool("type", "--delay", 20, str(folder))
        display.key("Tab", "Tab", "Tab", "Tab", "Return")
        window.wait_message("Adding layer noise")

    add()
    spot = place(window, 0.5, 0.7)
    display.key("1")
    display.drag(*spot, spot[0] + 40, spot[1])
    command = window.wait_for("command")["command"]
    keep("importing.png", display.screenshot())
    assert command["cmd"] == "sculpt" and 'name = "noise"' not in text.read_text(), "the import has not ended yet"
    assert changed_share(start, display.screenshot(), spot, half=30) > 0.2, "the edit shows while it runs"
    # A second one has to wait; the first is taken back with its button.
    display.key("ctrl+l")
    display.xdotool("type", "--delay", 20, str(folder))
    display.key("Tab", "Tab", "Tab", "Tab", "Return")
    window.wait_message("Wait for the import")
    display.click(889, 787)
    window.wait_message("cancelled")
    assert 'name = "noise"' not in text.read_text() and sorted((project / "layers").iterdir()) == files
    add()
    window.wait_message("noise added")
    window.settle()
    assert 'name = "noise"' in text.read_text()
    keep("imported.png", display.screenshot())
    # One that is running when the window is closed leaves nothing behind.
    files = sorted((project / "layers").iterdir())
    display.key("ctrl+l")
    display.xdotool("type", "--delay", 20, str(folder))
    display.key("Tab")
    display.xdotool("type", "--delay", 20, "late")
    display.key("Tab", "Tab", "Tab", "Return")
    window.wait_message("Adding layer late")
    closed_cleanly(window, display)
    assert 'name = "late"' not in text.read_text() and sorted((project / "layers").iterdir()) == files


def test_an_event_is_placed_played_scrubbed_and_undone(display, project, opened):
    window = opened()
    display.key("e")
    window.settle()
    away(display, window)
    start = display.screenshot()
    spot = place(window, 0.5, 0.7)
    x, y, w, h = window.last("viewport")["rect"]
    ruler, left = y + h + 14, 20
    display.xdotool("mousemove", 500, ruler)  # of the timeline, which the tool brings up
    display.xdotool("click", 1)
    scrubbed = window.wait_for("command")
    assert scrubbed["command"]["cmd"] == "time" and 5 < scrubbed["command"]["time_s"] < 15
    display.xdotool("mousemove", *spot)
    window.settle()
    display.xdotool("click", 1)
    event = wait_for_command(window, "event")
    assert event["event"] == "crater" and abs(event["start_s"] - scrubbed["command"]["time_s"]) < 1e-9
    wait_for_command(window, "time")  # it plays
    display.key("space", "Escape")  # stops, and its handles are gone
    away(display, window)
    struck = display.screenshot()
    keep("event.png", struck)
    assert changed_share(start, struck, spot) > 0.5
    display.xdotool("mousemove", left, ruler)
    display.xdotool("click", 1)  # back to the start
    away(display, window)
    assert window.commands()[-1] == {"cmd": "time", "time_s": 0.0}
    assert changed_share(start, display.screenshot(), spot) < 0.02
    display.key("ctrl+z")
    away(display, window)
    display.xdotool("mousemove", 700, ruler)
    display.xdotool("click", 1)
    away(display, window)
    assert changed_share(start, display.screenshot(), spot) < 0.02, "undone at any time"


def test_a_decal_is_made_by_a_function_that_is_written_meanwhile(display, project, opened):
    window = opened()
    display.key("8")
    window.settle()
    away(display, window)
    start = display.screenshot()
    spot = place(window, 0.5, 0.85)
    display.click(1190, 312)  # the tool's function: the first one after "None", cracks
    display.key("Down", "Return")
    window.settle()
    display.xdotool("mousemove", *spot)
    window.settle()
    display.xdotool("click", 1)
    decal = wait_for_command(window, "decal")
    assert decal["function"] == "cracks" and decal["layer"] == ""
    display.key("Escape")
    away(display, window)
    cracked = display.screenshot()
    keep("function_cracks.png", cracked)
    assert changed_share(start, cracked, spot) > 0.5

    display.key("F4")
    window.settle()
    x, y, w, h = window.last("viewport")["rect"]
    display.click(400, y + h + 120)  # into the text
    display.key("ctrl+End", "BackSpace", "BackSpace")  # the last brace
    display.xdotool("type", "    nothing;")
    time.sleep(1)
    window.settle()
    keep("function_wrong.png", display.screenshot())
    file = project / "decals" / "cracks.glsl"
    assert "nothing" not in file.read_text(), "what does not compile is not saved"
    for _ in "nothing;":
        display.key("BackSpace")
    display.xdotool("type", "s.colour = vec3(0.0, 0.0, 1.0); }")
    window.wait_message("Cracks compiles")
    assert file.read_text().rstrip().endswith("s.colour = vec3(0.0, 0.0, 1.0); }")
    display.key("F4")
    away(display, window)
    blue = display.screenshot()
    keep("function_blue.png", blue)
    assert changed_share(cracked, blue, spot) > 0.5
    red, _, strong = blue.getpixel(spot)
    assert strong > 2 * red
    display.key("ctrl+z")
    away(display, window)
    assert changed_share(start, display.screenshot(), spot) < 0.02


def test_a_hole_is_cut_closed_and_undone(display, project, opened):
    window = opened()
    away(display, window)
    start = display.screenshot()
    spot = place(window, 0.5, 0.7)
    display.key("c")
    display.drag(*spot, spot[0] + 50, spot[1])
    window.wait_for("command")
    away(display, window)
    cut = display.screenshot()
    keep("cutout.png", cut)
    assert changed_share(start, cut, spot) > 0.9
    commands = window.commands()
    assert {c["cmd"] for c in commands} == {"cutout"} and len({c["group"] for c in commands}) == 1
    # Taking up the tool over the hole, the mouse at rest: Ctrl closes a spot of it, although nothing is there.
    display.key("1")
    display.xdotool("mousemove", *spot)
    window.settle()
    display.key("c")
    display.xdotool("keydown", "ctrl")
    display.xdotool("click", 1)
    display.xdotool("keyup", "ctrl")
    window.wait_for("command")
    assert window.commands()[-1]["fill"] is True
    display.key("ctrl+z")
    away(display, window)
    assert changed_share(cut, display.screenshot(), spot) < 0.02
    # The same along the stroke.
    display.xdotool("keydown", "ctrl")
    display.drag(*spot, spot[0] + 50, spot[1])
    display.xdotool("keyup", "ctrl")
    window.wait_for("command")
    away(display, window)
    assert window.commands()[-1]["fill"] is True
    assert changed_share(start, display.screenshot(), spot) < 0.02
    display.key("ctrl+z")
    away(display, window)
    assert changed_share(cut, display.screenshot(), spot) < 0.02
    display.key("ctrl+z")
    away(display, window)
    assert changed_share(start, display.screenshot(), spot) < 0.02
    closed_cleanly(window, display)


def test_objects_are_listed_hidden_and_removed(display, project, opened):
    window = opened()
    away(display, window)
    start = display.screenshot()
    spot, other = place(window, 0.35, 0.75), place(window, 0.65, 0.75)
    display.key("6")
    display.click(*spot)
    window.wait_for("command")
    display.key("c")
    display.click(*other)
    window.wait_for("command")
    away(display, window)
    made = display.screenshot()
    display.key("1")
    for heading in (178, 274, 338, 370):  # Layers, Ground and Sun close, Objects opens
        display.click(1140, heading)
        window.settle()
    display.click(1140, 430)  # the newest on top: the cutout
    window.settle()
    keep("objects.png", display.screenshot())
    display.drag(*other, other[0] + 60, other[1] + 20)  # by its handle, although another tool is in hand
    assert wait_for_command(window, "edit")["kind"] == "cutout"
    away(display, window)
    dragged = display.screenshot()
    keep("dragged.png", dragged)
    assert changed_share(start, dragged, (other[0] + 60, other[1] + 20), 4) > 0.9
    groups = {c.get("group") for c in window.commands() if c["cmd"] == "edit"}
    assert len(groups) == 1, "one step of the history"
    display.key("ctrl+z")
    away(display, window)
    display.key("Delete")
    away(display, window)
    removed = display.screenshot()
    assert window.commands()[-1]["cmd"] == "remove"
    assert changed_share(start, removed, other) < 0.02 and changed_share(made, removed, spot) < 0.02
    display.click(1033, 430)  # the eye of the crater, the only one now
    away(display, window)
    assert window.commands()[-1] == {"cmd": "operator", "id": 1, "enabled": False}
    assert changed_share(start, display.screenshot(), spot) < 0.02
    display.key("ctrl+z", "ctrl+z")
    away(display, window)
    assert changed_share(made, display.screenshot(), spot) < 0.02
    assert changed_share(made, display.screenshot(), other) < 0.02
    closed_cleanly(window, display)


def test_the_map_is_filled_and_taken_back(display, project, opened):
    window = opened()
    away(display, window)
    start = display.screenshot()
    display.key("5", "period", "period", "period", "ctrl+f")
    window.wait_for("command")
    away(display, window)
    filled = display.screenshot()
    keep("filled.png", filled)
    spots = [place(window, x, y) for x, y in ((0.3, 0.6), (0.5, 0.8), (0.7, 0.6))]
    assert all(changed_share(start, filled, spot) > 0.5 for spot in spots)
    assert {c["cmd"] for c in window.commands()} == {"fill"} and len({c["group"] for c in window.commands()}) == 1
    display.key("ctrl+z")
    window.wait_for("command")
    away(display, window)
    undone = display.screenshot()
    keep("fill_undone.png", undone)
    assert all(changed_share(start, undone, spot) < 0.02 for spot in spots)
    closed_cleanly(window, display)


def test_the_palette_is_searched_and_put_in_order(display, project, opened):
    window = opened()
    away(display, window)
    x, y = 1180, 214  # the search field, under the head of the section Layers
    display.click(x, y)
    display.xdotool("type", "--delay", 20, "GRASS")
    window.settle()
    found = display.screenshot()
    keep("palette_search.png", found)
    display.click(1140, 375)  # the section Layer
    window.settle()
    display.click(x, y)
    display.key("ctrl+a", "BackSpace")
    window.settle()
    keep("palette_layer.png", display.screenshot())
    before = display.screenshot()
    display.drag(1184, 629, 1230, 629)  # its tile: the ground follows
    window.settle()
    away(display, window)
    assert changed_share(before, display.screenshot(), place(window, 0.5, 0.9), half=30) > 0.1
    display.click(1145, 713)  # later in the palette
    window.settle()
    text = (project / "project.toml").read_text()
    assert 'order = ["dry_grass", "grass", "forest_floor",' in text
    assert text.index('name = "grass"') < text.index('name = "dry_grass"'), "the map's numbers mean the same layers"
    display.click(1060, 275)  # the first one now, dry_grass
    window.settle()
    away(display, window)
    display.click(*place(window, 0.5, 0.7))
    window.wait_for("command")
    (command,) = window.commands()
    assert command["cmd"] == "paint" and command["layer"] == "dry_grass"
    closed_cleanly(window, display)


def test_imagery_is_laid_over_the_map(display, project, opened, tmp_path):
    Image.new("RGB", (64, 64), (200, 30, 200)).save(tmp_path / "pink.png")
    window = opened()
    away(display, window)
    start = display.screenshot()
    far = place(window, 0.5, 0.45)
    for path in (tmp_path / "nowhere.png", tmp_path / "pink.png"):
        display.key("ctrl+i")
        display.xdotool("type", "--delay", 20, str(path))
        display.key("Tab", "Tab", "Return")
        window.wait_message("Imagery added" if path.stem == "pink" else "nowhere.png")
        window.settle()
        assert (project / "imagery" / "pink.imagery").exists() == (path.stem == "pink"), window.last("message")
    away(display, window)
    laid = display.screenshot()
    keep("imagery.png", laid)
    assert changed_share(start, laid, far, half=30) > 0.5
    assert 'file = "imagery/pink.imagery"' in (project / "project.toml").read_text()
    closed_cleanly(window, display)


def test_a_picture_becomes_a_stamp_and_is_laid(display, project, opened, tmp_path):
    bumps = Image.new("L", (64, 64))
    for y in range(64):
        for x in range(64):
            bumps.putpixel((x, y), 255 if (x // 16 + y // 16) % 2 else 0)
    bumps.save(tmp_path / "bumps.png")
    window = opened()
    away(display, window)
    start = display.screenshot()
    display.key("0")
    spot = place(window, 0.5, 0.7)
    display.click(*spot)  # there is none yet: nothing happens
    window.settle()
    assert window.commands() == []
    # Ctrl+T: a picture that does not exist is said, then one that does.
    for path in (tmp_path / "nowhere.png", tmp_path / "bumps.png"):
        display.key("ctrl+t")
        display.xdotool("type", "--delay", 20, str(path))
        display.key("Tab", "Tab", "Tab", "Return")
        window.wait_message("bumps added" if path.stem == "bumps" else "nowhere.png")
        window.settle()
        assert (project / "stamps" / "bumps.stamp").exists() == (path.stem == "bumps"), window.last("message")
    display.click(*spot)
    window.wait_for("command")
    away(display, window)
    stamped = display.screenshot()
    keep("stamped.png", stamped)
    assert changed_share(start, stamped, spot, half=30) > 0.5
    (command,) = window.commands()
    assert command["cmd"] == "stamp" and command["image"] == "bumps" and command["mode"] == "add"
    display.key("ctrl+z")
    window.settle()
    away(display, window)
    undone = display.screenshot()
    assert changed_share(start, undone, spot, half=30) < 0.02
    closed_cleanly(window, display)
