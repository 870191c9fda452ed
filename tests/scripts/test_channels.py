"""Optional channels of the texture and formats of its pages: what a map chooses is seen, what it does not costs nothing."""
import loam
import numpy as np
import pytest
from conftest import fails_with_one_sentence, run_loam

pytestmark = pytest.mark.usefixtures("has_device")
VIEW = (128, 96, 40, 0, -40)
SIZE = (160, 90)


def choose(project, *channels, layer=""):
    """Writes the map's channels, and amounts into every layer."""
    text = (project / "project.toml").read_text()
    text = text.replace("[[layer]]\n", "[[layer]]\n" + layer)
    names = ", ".join(f'"{c}"' for c in channels)
    first = text.index("[[layer]]")
    (project / "project.toml").write_text(text[:first] + f"[texture]\nchannels = [{names}]\n\n" + text[first:])


def without_amounts(project):
    lines = (project / "project.toml").read_text().splitlines(keepends=True)
    names = ("scattering", "thermal", "emissive", "glint")
    (project / "project.toml").write_text("".join(line for line in lines if not line.startswith(names)))


def picture(project, **settings):
    with loam.open(str(project), read_only=True, validation=True, **settings) as p:
        shown = p.render(VIEW, size=SIZE).astype(int)[..., :3]
        memory = p.stats()["frame"]["memory_bytes"]
        assert p.validation_messages() == 0
    return shown, memory


def psnr(a, b):
    return 10 * np.log10(255**2 / max(1e-9, ((a - b) ** 2).mean()))


@pytest.mark.parametrize("form", ["bc1", "bc3", "bc1x4", "rgba8"])
def test_every_format_shows_the_same_ground_and_stays_fresh(plain, form):
    best, _ = picture(plain, format="rgba8")
    with loam.open(str(plain), format=form, validation=True) as p:
        shown = p.render(VIEW, size=SIZE).astype(int)[..., :3]
        p.crater(128, 120, radius_m=6, seed=2, heat=0.5)
        p.footprints([(126 + i * 0.3, 105, 1.5) for i in range(6)])
        p.step(VIEW, 3, size=SIZE)
        p.render(VIEW, size=SIZE)
        assert p.count_stale_pages() == 0
        assert p.validation_messages() == 0
    assert psnr(shown, best) > (60 if form == "rgba8" else 34)


@pytest.mark.parametrize("form,channels", [("bc1", ["emissive"]), ("bc1x4", ["thermal", "emissive", "scattering", "glint"]),
                                           ("rgba8", ["glint", "scattering", "emissive"])])
def test_channels_stay_fresh_and_agree_with_the_reference(plain, form, channels):
    without_amounts(plain)
    choose(plain, *channels, layer="".join(f"{c} = 0.3\n" for c in channels if c != "glint"))
    with loam.open(str(plain), format=form, validation=True) as p:
        p.render(VIEW, size=SIZE)
        p.crater(128, 120, radius_m=6, seed=2, heat=0.9)
        p.footprints([(126 + i * 0.3, 105, 1.5) for i in range(6)])
        p.step(VIEW, 3, size=SIZE)
        shown = p.render(VIEW, size=SIZE, supersample=2).astype(int)[..., :3]
        assert p.count_stale_pages() == 0
        reference = p.render(VIEW, size=SIZE, reference=True).astype(int)[..., :3]
        assert p.validation_messages() == 0
    assert psnr(shown, reference) > 25


def test_each_channel_changes_the_picture_and_amounts_of_nothing_do_not(plain):
    without_amounts(plain)
    plainly, memory = picture(plain)
    choose(plain, "scattering", "emissive")
    nothing, _ = picture(plain)
    assert np.array_equal(nothing, plainly), "a channel that no layer has is black"
    text = (plain / "project.toml").read_text()
    # Levels that a share of the picture changes by at least. Under a high sun scattering moves grass by 2 to 6 levels, nearly
    # everywhere; sparkles are few and bright (0.2 % by more than 8 levels).
    for channel, level, share in (("scattering", 1, 0.5), ("emissive", 8, 0.5), ("glint", 8, 0.0005)):
        (plain / "project.toml").write_text(text.replace("[[layer]]\n", f"[[layer]]\n{channel} = 0.8\n").replace(
            'channels = ["scattering", "emissive"]', f'channels = ["{channel}"]'))
        shown, with_one = picture(plain)
        assert (np.abs(shown - plainly).max(axis=2) > level).mean() > share, channel
        assert with_one["virtual texture"] == memory["virtual texture"], "one channel has room in the third texture"


def test_a_map_without_channels_pays_nothing_whatever_its_layers_say(plain):
    without_amounts(plain)
    plainly, memory = picture(plain)
    text = (plain / "project.toml").read_text()
    (plain / "project.toml").write_text(text.replace("[[layer]]\n", "[[layer]]\nglint = 0.9\nemissive = 0.9\n"))
    shown, same = picture(plain)
    assert np.array_equal(shown, plainly)
    assert same == memory
    choose(plain, "thermal", "glint")
    _, more = picture(plain)
    assert more["virtual texture"] > memory["virtual texture"] * 1.3, "a second channel takes a fourth texture"


def test_a_hot_crater_is_seen_by_heat_and_glows(plain):
    choose(plain, "thermal", "emissive")
    with loam.open(str(plain), validation=True) as p:
        # The same crater cold and hot.
        p.crater(128, 116, radius_m=8, seed=4)
        cold = p.render(VIEW, size=SIZE).astype(int), p.render(VIEW, size=SIZE, debug="thermal").astype(int)
        p.undo()
        p.crater(128, 116, radius_m=8, seed=4, heat=1.0)
        hot = p.render(VIEW, size=SIZE).astype(int), p.render(VIEW, size=SIZE, debug="thermal").astype(int)
        assert [op["heat"] for op in p.operators()] == [1.0]
        assert p.history()[0]["command"]["heat"] == 1.0
        assert p.validation_messages() == 0
    for before, after in zip(cold, hot):
        redder = (after[..., 0] - before[..., 0] > 30).mean()
        assert redder > 0.01, redder
    with loam.open(str(plain)) as p:
        assert [op["heat"] for op in p.operators()] == [1.0], "it survives closing"


def test_what_a_format_cannot_hold_is_refused(plain):
    choose(plain, "scattering", "glint")
    for form in ("bc1", "bc3"):
        done = run_loam("render", plain, "-o", plain / "x.png", "--size", "64x36", "--format", form)
        assert "use bc1x4 or rgba8" in fails_with_one_sentence(done)
    with pytest.raises(loam.Error, match="expected one of bc1, bc3, bc1x4, rgba8"):
        loam.open(str(plain), format="bc7")


def test_an_unknown_channel_is_refused(plain):
    choose(plain, "sparkle")
    done = run_loam("info", plain)
    assert 'unknown channel "sparkle" in [texture] (known: scattering, thermal, emissive, glint, depth)' in fails_with_one_sentence(done)
