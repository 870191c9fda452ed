"""Cost follows the edit, not the map: memory and the work of a crater are those of a small map on the largest one."""
import loam
import pytest
from conftest import make_flat

SIZE = (320, 180)
VIEW = (300, 455, 130, 0, -30)
pytestmark = pytest.mark.usefixtures("has_device")
# What may grow with the map: tables of a word a page.
TABLES_BYTES = 4 << 20


def counters(frame):
    """Work so far, as counts."""
    out = {}
    for part in ("height", "index", "texture"):
        for name in ("pages_composed", "texels_composed", "pages_dirtied"):
            out[part, name] = frame[part][name]
    return out


def crater_work(path):
    """Counts of one crater in the middle of the view, and the statistics afterwards."""
    with loam.open(str(path)) as p:
        # One filter for which new slopes want no other pages.
        p.render(VIEW, size=SIZE, filter="trilinear")
        before = counters(p.stats()["frame"])
        p.crater(300, 500, radius_m=10, seed=7)
        p.render(VIEW, size=SIZE, filter="trilinear")
        stats = p.stats()
        assert stats["settled"]
        after = counters(stats["frame"])
        return {key: after[key] - before[key] for key in after}, stats


def test_a_crater_and_memory_cost_the_same_on_1_km_and_16_km(plain_template, tmp_path):
    work, memory, allocated, cache, pages = {}, {}, {}, {}, {}
    for side_m in (1024, 16384):
        work[side_m], stats = crater_work(make_flat(plain_template, tmp_path / str(side_m), side_m))
        memory[side_m] = stats["frame"]["memory_bytes"]
        allocated[side_m] = stats["allocated_bytes"]["device"]
        pages[side_m] = stats["frame"]["height_pages"]
        cache[side_m] = stats["document"]["cache_bytes"]
    small, large = 1024, 16384
    print({"/".join(key): (value, work[large][key]) for key, value in work[small].items()})
    for name in memory[small]:
        print(f"{name}: {memory[small][name]:,} and {memory[large][name]:,} bytes")
    print(f"all device memory: {allocated[small]:,} and {allocated[large]:,}; document cache: {cache[small]:,} and {cache[large]:,} bytes")
    assert all(work[small][part, "pages_dirtied"] > 0 for part in ("height", "index", "texture"))
    assert all(work[side][part, "pages_composed"] == 0 for side in work for part in ("height", "index", "texture"))
    for part in ("height", "index", "texture"):
        # The larger map has four more levels above; a crater touches at most four pages of a level.
        more = work[large][part, "pages_dirtied"] - work[small][part, "pages_dirtied"]
        assert 0 <= more <= 16, part
        assert work[large][part, "texels_composed"] == pytest.approx(work[small][part, "texels_composed"], rel=0.05), part
    # Heights kept by the CPU follow the pages resident, of which the larger view's horizon has more; slots bound them.
    name = "height pages (CPU)"
    assert memory[large].pop(name) / pages[large] == pytest.approx(memory[small].pop(name) / pages[small], rel=0.01)
    for name in memory[small]:
        assert memory[large][name] - memory[small][name] <= TABLES_BYTES, name
    assert abs(allocated[large] - allocated[small]) <= TABLES_BYTES
    assert cache[large] <= cache[small] + (1 << 20)


def test_an_edit_far_from_the_view_costs_almost_nothing(plain_template, tmp_path):
    """Of pages near the eye none is dirtied; of the whole map's coarse pages a few texels are."""
    with loam.open(str(make_flat(plain_template, tmp_path / "flat", 2048))) as p:
        p.render(VIEW, size=SIZE)
        before = p.stats()
        p.crater(1500, 1500, radius_m=3, seed=1)
        p.render(VIEW, size=SIZE)
        after = p.stats()
        assert after["frame"]["texture"]["pages_composed"] == before["frame"]["texture"]["pages_composed"]
        texels = after["frame"]["texture"]["texels_composed"] - before["frame"]["texture"]["texels_composed"]
        assert texels <= 4096, texels
        assert after["frame"]["memory_bytes"] == before["frame"]["memory_bytes"]
        assert after["allocated_bytes"]["device"] == before["allocated_bytes"]["device"]
