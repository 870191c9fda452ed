// The store: page codec, layer files, project.toml, the page store's refusals.
#include <cstring>
#include <fstream>
#include <random>

#include "document_fixture.h"
#include "runtime/base/units.h"
#include "runtime/store/layer_file.h"
#include "runtime/store/page_codec.h"
#include "runtime/store/page_store.h"
#include "runtime/store/project.h"

using namespace loam;
using namespace loam::test;

namespace {

using Heights = std::array<int32_t, kBasePageSamples>;
using Texels = std::array<IndexTexel, kBasePageSamples>;

Heights hills() {
    Heights heights;
    for (int i = 0; i < kBasePageSamples; ++i)
        heights[size_t(i)] =
            int32_t(30000 * std::sin(i % 64 * 0.05) + 20000 * std::cos(i / 64 * 0.07)) + i * 7919 % 13;
    return heights;
}

Texels patches() {
    Texels texels;
    for (int i = 0; i < kBasePageSamples; ++i) {
        texels[size_t(i)].layer = uint16_t((i % 64 / 16 + i / 1024) % 5 * 60);
        texels[size_t(i)].tint[1] = uint8_t(255 - i % 64);
    }
    return texels;
}

void write_file(const std::filesystem::path& file, const std::string& bytes) {
    std::filesystem::remove(file);  // ext4 waits for the disk when a file is cut to nothing and written again
    std::ofstream(file, std::ios::binary) << bytes;
}

std::string read_file(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

// Every cut and `flips` random changed bytes must be refused, or decode to what was encoded.
template <typename Page, typename Decode>
void expect_damage_is_found(const std::vector<uint8_t>& blob, const Page& page, Decode decode, int flips) {
    auto decoded = std::make_unique<Page>();
    for (size_t length = 0; length < blob.size(); ++length)
        ASSERT_FALSE(decode(std::span(blob).first(length), *decoded).ok())
            << "cut to " << length << " of " << blob.size();
    auto longer = blob;
    longer.push_back(0);
    EXPECT_FALSE(decode(longer, *decoded).ok());
    std::mt19937 random(7);
    int found = 0;
    for (int i = 0; i < flips; ++i) {
        auto changed = blob;
        const size_t at = i < int(blob.size()) ? size_t(i) : random() % blob.size();
        changed[at] ^= uint8_t(1 + random() % 255);
        const bool ok = decode(changed, *decoded).ok();
        found += !ok;
        if (ok) {
            ASSERT_TRUE(*decoded == page) << "byte " << at << " changed without notice";
        }
    }
    EXPECT_GT(found, flips * 9 / 10);
}

}  // namespace

TEST(page_codec, height_pages_come_back_as_they_were) {
    std::mt19937 random(1);
    std::vector<Heights> pages(6);
    pages[0].fill(-kHeightLimit_mm);
    pages[1] = hills();
    for (auto& v : pages[2]) v = int32_t(random());
    for (size_t i = 0; i < kBasePageSamples; ++i) pages[3][i] = i % 2 ? INT32_MAX : INT32_MIN;
    pages[4].fill(5);
    pages[4][4095] = 6;
    for (size_t i = 0; i < kBasePageSamples; ++i) pages[5][i] = int32_t(i % 64 * 1000 + i / 64 * 500);
    for (const Heights& page : pages) {
        const auto blob = encode_height_page(page);
        EXPECT_EQ(blob, encode_height_page(page)) << "the same page, the same bytes";
        Heights decoded;
        ASSERT_TRUE(decode_height_page(blob, decoded).ok());
        EXPECT_TRUE(decoded == page);
    }
    EXPECT_EQ(encode_height_page(pages[0]).size(), 9u);
    EXPECT_LT(encode_height_page(pages[5]).size(), 200u) << "a plane is nearly free";
    EXPECT_LT(encode_height_page(pages[1]).size(), 6000u);
}

TEST(page_codec, index_pages_come_back_as_they_were) {
    std::mt19937 random(2);
    std::vector<Texels> pages(3);
    pages[1] = patches();
    for (auto& t : pages[2])
        t = {uint16_t(random()), {uint8_t(random()), uint8_t(random()), uint8_t(random())}, 0};
    for (const Texels& page : pages) {
        Texels decoded;
        ASSERT_TRUE(decode_index_page(encode_index_page(page), decoded).ok());
        EXPECT_TRUE(decoded == page);
    }
    EXPECT_EQ(encode_index_page(pages[0]).size(), 10u);
}

TEST(page_codec, damage_is_found) {
    const auto heights = [](std::span<const uint8_t> blob, Heights& page) {
        return decode_height_page(blob, page);
    };
    const auto texels = [](std::span<const uint8_t> blob, Texels& page) {
        return decode_index_page(blob, page);
    };
    Heights flat;
    flat.fill(123456);
    expect_damage_is_found(encode_height_page(hills()), hills(), heights, 6000);
    expect_damage_is_found(encode_height_page(flat), flat, heights, 500);
    expect_damage_is_found(encode_index_page(patches()), patches(), texels, 3000);
    expect_damage_is_found(encode_index_page(Texels{}), Texels{}, texels, 500);
    Heights decoded;
    EXPECT_FALSE(decode_height_page(encode_index_page(patches()), decoded).ok()) << "a page of the other map";
    std::mt19937 random(3);
    for (int i = 0; i < 2000; ++i) {
        std::vector<uint8_t> noise(random() % 300);
        for (auto& byte : noise) byte = uint8_t(random());
        if (!noise.empty()) noise[0] = uint8_t(random() % 5);
        EXPECT_FALSE(decode_height_page(noise, decoded).ok());
    }
}

TEST(layer_file, comes_back_and_damage_is_found) {
    TemporaryFolder folder;
    LayerTextures layer;
    layer.size_texels = 16;
    std::mt19937 random(4);
    layer.albedo_reveal.emplace_back(16 * 16 * 4);
    layer.normal_gloss_occlusion.emplace_back(16 * 16 * 4);
    layer.metalness.emplace_back(16 * 16);
    for (auto& byte : layer.albedo_reveal[0]) byte = uint8_t(random());
    for (auto& byte : layer.normal_gloss_occlusion[0]) byte = uint8_t(100 + random() % 56);
    layer.metalness[0][3] = 200;
    build_layer_mips(layer);
    EXPECT_EQ(layer.mip_count, 5);
    EXPECT_TRUE(layer.has_metal);
    const auto file = folder.path() / "a.layer";
    ASSERT_TRUE(save_layer(file, layer).ok());
    const auto loaded = take(load_layer(file));
    EXPECT_TRUE(loaded.albedo_reveal == layer.albedo_reveal && loaded.metalness == layer.metalness);
    EXPECT_TRUE(loaded.normal_gloss_occlusion == layer.normal_gloss_occlusion && loaded.has_metal);
    const std::string bytes = read_file(file);
    const auto bad = folder.path() / "b.layer";
    for (size_t length = 0; length < bytes.size(); ++length) {
        write_file(bad, bytes.substr(0, length));
        ASSERT_FALSE(load_layer(bad).ok());
    }
    for (size_t i = 0; i < bytes.size(); ++i) {
        std::string changed = bytes;
        changed[i] = char(changed[i] ^ (1 << (random() % 8)));
        write_file(bad, changed);
        const auto result = load_layer(bad);
        if (result.ok()) {
            ASSERT_TRUE(result->albedo_reveal == layer.albedo_reveal && result->metalness == layer.metalness);
        }
    }
    EXPECT_EQ(take(layer_size(file)), 16);
    for (int first = 0; first < 5; ++first) {
        const auto tail = take(load_layer(file, first));
        EXPECT_TRUE(tail.has_metal) << "one texel of the finest mip says so";
        for (int mip = 0; mip < 5; ++mip) {
            const auto i = size_t(mip);
            const auto want = [&](const std::vector<uint8_t>& whole) {
                return mip < first ? std::vector<uint8_t>() : whole;
            };
            EXPECT_EQ(tail.albedo_reveal[i], want(layer.albedo_reveal[i]));
            EXPECT_EQ(tail.normal_gloss_occlusion[i], want(layer.normal_gloss_occlusion[i]));
            EXPECT_EQ(tail.metalness[i], want(layer.metalness[i]));
        }
    }
    write_file(bad, bytes.substr(0, bytes.size() - 1));
    EXPECT_FALSE(load_layer(bad, 4).ok()) << "cut short, also where the cut is passed over";
    write_file(bad, bytes.substr(0, 11));
    EXPECT_FALSE(layer_size(bad).ok());
    EXPECT_NE(load_layer(folder.path() / "none.layer").message().find("No such file"), std::string::npos);
}

TEST(layer_mips, average_in_linear_light_and_roughen_bumps) {
    LayerTextures layer;
    layer.size_texels = 4;
    layer.albedo_reveal.emplace_back(64);
    layer.normal_gloss_occlusion.emplace_back(64);
    layer.metalness.emplace_back(16);
    for (size_t i = 0; i < 16; ++i) {
        const bool odd = (i % 4 + i / 4) % 2 != 0;
        for (size_t c = 0; c < 3; ++c) layer.albedo_reveal[0][4 * i + c] = odd ? 255 : 0;
        const uint8_t texel[4] = {uint8_t(odd ? 217 : 38), 128, 200, 255};
        std::memcpy(&layer.normal_gloss_occlusion[0][4 * i], texel, 4);
    }
    build_layer_mips(layer);
    EXPECT_NEAR(layer.albedo_reveal[1][0], 188, 1) << "half the light is 188 of 255 in sRGB";
    EXPECT_NEAR(layer.normal_gloss_occlusion[1][0], 128, 1);
    EXPECT_LT(layer.normal_gloss_occlusion[1][2], 120) << "opposed slopes lower the gloss";
    EXPECT_EQ(layer.normal_gloss_occlusion[1][3], 255);
    EXPECT_FALSE(layer.has_metal);
}

TEST(project, comes_back_as_it_was) {
    TemporaryFolder folder;
    ProjectSettings s = small_settings();
    s.name = "quotes \" and \\ and\nlines, é";
    s.height_spacing_m = 0.1 + 0.2;
    s.refine = 3;
    s.sun_elevation_rad = 1e-7;
    s.roles.broken = "grass";
    s.default_layer = 2;
    s.layers[1].tile_m = 1.0 / 3;
    s.layers.push_back({.name = "t", .file = "", .blend = LayerEntry::Blend{s.layers[0].name, s.layers[1].name, 1.0 / 3, true}});
    s.ground = {.distortion_amplitude_m = 0.2,
                .distortion_period_m = 12.5,
                .tile_hiding = true,
                .vista_scale = 7.5,
                .vista_distance_m = 1.0 / 3 + 40};
    s.imagery = {"imagery/a \"b\".imagery", 1.0 / 3, 123.25};
    s.palette = {s.layers[1].name, "t", "no \"such\" layer"};
    s.layers[1].channels = {0, 0.25, 0, 1.0 / 3};
    s.channels = {Channel::glint, Channel::scattering};
    ASSERT_TRUE(save_project(folder.path(), s).ok());
    const auto t = take(load_project(folder.path()));
    EXPECT_EQ(t.name, s.name);
    EXPECT_EQ(t.height_spacing_m, s.height_spacing_m);
    EXPECT_EQ(t.refine, 3);
    EXPECT_EQ(t.sun_elevation_rad, 1e-7);
    EXPECT_EQ(t.roles.broken, "grass");
    EXPECT_EQ(t.default_layer, 2);
    EXPECT_EQ(t.default_height_mm, 12000);
    ASSERT_EQ(t.layers.size(), 4u);
    EXPECT_EQ(t.layers, s.layers);
    EXPECT_EQ(t.layers[1].tile_m, 1.0 / 3);
    EXPECT_EQ(t.layers[1].channels, s.layers[1].channels);
    EXPECT_EQ(t.layers[0].channels, LayerEntry().channels);
    EXPECT_EQ(t.channels, s.channels);
    EXPECT_EQ(t.imagery, s.imagery);
    EXPECT_EQ(t.palette, s.palette);
    EXPECT_EQ(t.height_samples_y, 207);
    EXPECT_EQ(t.ground, s.ground);
}

// The palette's order is its own: names that are gone or twice, removed transitions, layers that it lacks.
TEST(project, palette_shows_every_layer_once_in_its_order) {
    ProjectSettings s;
    for (const char* name : {"a", "b", "c", "gone", "d"})
        s.layers.push_back({name, std::string(name) + ".layer"});
    EXPECT_EQ(palette_order(s), (std::vector<int>{0, 1, 2, 3, 4}));
    s.layers[3].blend = LayerEntry::Blend{"a", "b", 0.5, true};
    s.palette = {"d", "gone", "b", "d", "nowhere"};
    EXPECT_EQ(palette_order(s), (std::vector<int>{4, 1, 0, 2}));
}

TEST(project, errors_are_sentences_with_the_line) {
    TemporaryFolder folder;
    const std::string good = "name = \"x\"\n[terrain]\nheight_samples = [100, 100]\n";
    const std::pair<std::string, std::string> cases[] = {
        {good + "colour = 3\n", ":4: unknown key \"colour\" in [terrain] (known: default_height_mm,"},
        {good + "refine = \"two\"\n", ":4: refine must be a whole number"},
        {good + "refine = 9\n", ":4: refine is 9, must be 0 … 6"},
        {good + "height_spacing_m = nan\n", ":4: height_spacing_m is nan"},
        {good + "height_spacing_m = -1\n", ":4: height_spacing_m is -1"},
        {good + "height_spacing_m = 500\n", "the limit is 16800 m a side"},
        {good + "index_spacing_m = 3\n", "power of two"},
        {good + "[sun]\nazimuth_rad = true\n", ":5: azimuth_rad must be a number"},
        {good + "[[layer]]\nfile = \"a\"\n", "a layer needs a name"},
        {good + "[[layer]]\nname = \"a\"\n[[layer]]\nname = \"a\"\n", "two layers are called \"a\""},
        {good + "[[layer]]\nname = \"a\"\nfile = \"../../etc/passwd\"\n", "outside the project"},
        {good + "[[layer]]\nname = \"a\"\nthreshold = 0.5\n",
         ":6: threshold and removed belong to layers with a blend"},
        {good + "[[layer]]\nname = \"t\"\nblend = [\"a\", \"b\"]\n", "there is no layer \"a\" with textures"},
        {good + "[[layer]]\nname = \"t\"\nblend = \"a\"\n", ":6: blend must be [from, to]"},
        {good + "[[layer]]\nname = \"t\"\nblend = [\"a\", \"b\"]\nthreshold = 2\n", ":7: threshold is 2"},
        {good + "[ground]\ntile_hiding = 1\n", ":5: tile_hiding must be true or false"},
        {good + "[ground]\ndistortion_amplitude_m = 1.5\n", "must be 0 … 1 (index_spacing_m)"},
        {good + "[ground]\ndistortion_amplitude_m = nan\n", ":5: distortion_amplitude_m is nan"},
        {good + "[ground]\nvista_scale = 0.5\n", ":5: vista_scale is 0.5, must be 1 … 64"},
        {good + "[imagery]\nstrength = 1.5\n", ":5: strength is 1.5, must be 0 … 1"},
        {good + "[imagery]\nfile = \"../a\"\n", "outside the project"},
        {good + "[palette]\norder = \"grass\"\n", ":5: order must be a list"},
        {good + "[ground]\nvista_distance_m = inf\n", ":5: vista_distance_m is inf"},
        {good + "[ground]\ndistortion_period_m = 0\n", ":5: distortion_period_m is 0"},
        {good + "[texture]\nchannels = [\"glow\"]\n",
         ":5: unknown channel \"glow\" in [texture] (known: scattering, thermal, emissive, glint, depth)"},
        {good + "[texture]\nchannels = \"glint\"\n", ":5: channels must be a list of names"},
        {good + "[texture]\nchannels = [3]\n", ":5: a channel must be a text in quotes"},
        {good + "[texture]\nchannels = [\"glint\", \"thermal\", \"glint\"]\n",
         "[texture] channels names \"glint\" twice"},
        {good + "[[layer]]\nname = \"a\"\nfile = \"a\"\nglint = 2\n", ":7: glint is 2, must be 0 … 1"},
        {good + "refine = \n", ":4: "},
        {"name = \"x\"\n", "height_samples is missing"},
        {"[terrain]\nheight_samples = 7\n", ":2: height_samples must be [east, north]"},
        {"[terrain]\nheight_samples = [1, 7]\n", ":2: height_samples (x) is 1"},
        {"[terrain]\nheight_samples = [2.5, 7]\n", ":2: height_samples (x) must be a whole number"},
        {"name = 5\n", ":1: name must be a text"},
        {"\xff\xfe\x00", ":1: "},
    };
    for (const auto& [text, expected] : cases) {
        write_file(folder.path() / "project.toml", text);
        const auto result = load_project(folder.path());
        ASSERT_FALSE(result.ok()) << text;
        EXPECT_NE(result.message().find(expected), std::string::npos) << result.message();
        EXPECT_NE(result.message().find("project.toml"), std::string::npos);
    }
    EXPECT_NE(load_project(folder.path() / "none").message().find("there is no folder"), std::string::npos);
    EXPECT_EQ(default_refine(1.0), 2);
    EXPECT_EQ(default_refine(0.25), 0);
    EXPECT_EQ(default_refine(100), 6);
    EXPECT_EQ(default_refine(10), 5);
}

TEST(page_store, refusals_are_sentences) {
    TemporaryFolder folder;
    const auto file = folder.path() / "terrain.db";
    const auto message = [&] {
        const auto store = PageStore::open(file, DatabaseMode::read_write);
        return store.ok() ? std::string("opened") : store.message();
    };
    EXPECT_NE(message().find("is missing"), std::string::npos);
    write_file(file, "");
    EXPECT_NE(message().find("is empty"), std::string::npos);
    write_file(file, std::string(65536, '\0'));
    EXPECT_NE(message().find("begins with zeros"), std::string::npos);
    write_file(file, "hello, this is a text and no database at all");
    EXPECT_NE(message().find("is not a terrain database"), std::string::npos);
    std::filesystem::remove(file);
    take(PageStore::open(file, DatabaseMode::create));
    EXPECT_EQ(message(), "opened");
    EXPECT_TRUE(take(Database::open(file, DatabaseMode::read_write)).execute("PRAGMA user_version = 9").ok());
    EXPECT_NE(message().find("newer Loam (format 9"), std::string::npos) << message();
    EXPECT_TRUE(
        take(Database::open(file, DatabaseMode::read_write)).execute("PRAGMA application_id = 1").ok());
    EXPECT_NE(message().find("another program"), std::string::npos);
}

TEST(page_store, keys_pack_and_a_locked_database_says_so) {
    for (const PageKey key : {PageKey{BaseMap::height, 0, 0, 0}, PageKey{BaseMap::index, 17, 2047, 1},
                              PageKey{BaseMap::index, 3, 1, 70000}})
        EXPECT_EQ(PageKey::unpacked(key.packed()), key);
    TemporaryFolder folder;
    const auto file = folder.path() / "terrain.db";
    auto first = take(PageStore::open(file, DatabaseMode::create));
    auto second = take(PageStore::open(file, DatabaseMode::read_write));
    ASSERT_TRUE(first.begin().ok());
    EXPECT_NE(second.begin().message().find("locked by another program"), std::string::npos);
    const uint8_t bytes[] = {1, 2, 3};
    ASSERT_TRUE(first.write_page(5, bytes).ok());
    first.rollback();
    EXPECT_FALSE(take(first.read_page(5)).has_value());
    ASSERT_TRUE(second.begin().ok());
    ASSERT_TRUE(second.write_page(5, bytes).ok());
    ASSERT_TRUE(second.commit().ok());
    EXPECT_EQ(take(first.read_page(5))->size(), 3u);
}
