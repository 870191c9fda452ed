"""Painted weights, one picture a layer or a channel a layer, made the map's index and colour."""
import json

import loam
import numpy as np
import pytest
from conftest import fails_with_one_sentence, run_loam
from PIL import Image


def save(folder, name, weights):
    folder.mkdir(exist_ok=True)
    Image.fromarray(np.round(np.asarray(weights) * 255).astype(np.uint8)).save(folder / name)


@pytest.fixture
def slopes(tmp_path):
    """Three layers of 200 x 160 pixels: grass gives way to dirt from west to east, rock lies in the north."""
    y, x = np.mgrid[0:160, 0:200]
    rock = np.clip((40 - y) / 20, 0, 1)
    dirt = np.clip((x - 60) / 80, 0, 1) * (1 - rock)
    folder = tmp_path / "weights"
    save(folder, "rock.png", rock)
    save(folder, "grass+dirt.png", np.stack([1 - rock - dirt, dirt, dirt * 0], -1))
    return folder


def test_each_texel_takes_the_heaviest_layer(plain, slopes):
    made = run_loam("weights", plain, slopes, "--json", "--no-transitions")
    assert made.returncode == 0, made.stderr
    report = json.loads(made.stdout)
    assert {s["layer"] for s in report["layers"]} == {"rock", "grass", "dirt"} and report["unweighted"] == 0
    masks = {"rock": np.asarray(Image.open(slopes / "rock.png")) / 255}
    both = np.asarray(Image.open(slopes / "grass+dirt.png")) / 255
    masks["grass"], masks["dirt"] = both[..., 0], both[..., 1]
    with loam.open(str(plain)) as p:
        names = p.layers
        found = dict.fromkeys(masks, 0)
        for i in range(7, 200, 11):
            for j in range(5, 160, 9):
                weights = {n: m[j, i] for n, m in masks.items()}
                order = sorted(weights, key=weights.get)
                if weights[order[-1]] - weights[order[-2]] < 0.1:  # a vertex lies beside the pixel
                    continue
                at = ((i + 0.5) / 200 * 256, (1 - (j + 0.5) / 160) * 256)  # row 0 is north
                assert names[int(p.layer(*at))] == order[-1], (at, weights)
                found[order[-1]] += 1
        assert min(found.values()) > 20, found
        kept = sum(max(m[j, i] for m in masks.values()) for i in range(200) for j in range(160)) / 32000
        assert abs(report["kept"] - kept) < 0.01
        # A tint takes away most of what colour was lost, and what it cannot is said.
        assert 0 < report["color_rms"] < report["color_rms_plain"]
        assert p.render(size=(64, 36)) is not None
        # Edited since, it is not replaced: that could not be undone.
        p.paint([(128, 128)], layer="rock")
        with pytest.raises(loam.Error):
            p.import_weights(str(slopes))
    assert run_loam("verify", plain).returncode == 0


def test_transitions_and_tint_lose_less(plain, tmp_path, slopes):
    with loam.open(str(plain)) as p:
        bare = p.import_weights(str(slopes), tint=False, transitions=False)
        assert bare["color_rms"] == bare["color_rms_plain"]
        for k in (1, 2, 3):
            p.transition(f"grass to dirt {k}", "grass", "dirt", k / 4)
        mixed = p.import_weights(str(slopes))
        assert mixed["kept"] > bare["kept"] + 0.02
        assert mixed["color_rms_plain"] < bare["color_rms"] and mixed["color_rms"] < mixed["color_rms_plain"]
        assert any(p.layer(x, 60.0) >= p.layers.index("grass to dirt 1") for x in np.linspace(90, 160, 40))


def test_one_layer_of_full_weight_loses_nothing(plain, tmp_path):
    save(tmp_path / "w", "dirt.png", np.ones((1, 1)))
    save(tmp_path / "w", "rock.png", np.zeros((3, 5)))
    with loam.open(str(plain)) as p:
        report = p.import_weights(str(tmp_path / "w"))
        assert report["kept"] == 1 and report["color_rms"] == 0 and report["notes"] == []
        assert (np.asarray(p.layer(np.linspace(0, 256, 50), np.linspace(0, 256, 50))) == p.layers.index("dirt")).all()
        # No weight anywhere: the default layer, and it is said.
        save(tmp_path / "w", "dirt.png", np.zeros((9, 9)))
        report = p.import_weights(str(tmp_path / "w"))
        assert report["unweighted"] == 1 and "no weights" in report["notes"][0]


def test_bad_input_is_one_sentence(plain, tmp_path, slopes):
    with loam.open(str(plain)) as p:
        before = p.digest()
    save(tmp_path / "unknown", "lava.png", np.ones((4, 4)))
    save(tmp_path / "twice", "rock.png", np.ones((4, 4)))
    save(tmp_path / "twice", "dirt+rock.png", np.ones((4, 4, 3)))
    save(tmp_path / "few", "dirt+rock.png", np.ones((4, 4)))
    (tmp_path / "empty").mkdir()
    (tmp_path / "cut").mkdir()
    whole = (slopes / "rock.png").read_bytes()
    (tmp_path / "cut" / "rock.png").write_bytes(whole[:-20])
    for name, said in (("unknown", 'no layer "lava"'), ("twice", 'weights of "rock" already'), ("few", "2 layers and has 1"),
                       ("empty", "holds no pictures"), ("nowhere", "there is no folder"), ("cut", "cut short")):
        assert said in fails_with_one_sentence(run_loam("weights", plain, tmp_path / name)), name
    with loam.open(str(plain)) as p:
        assert p.digest() == before
