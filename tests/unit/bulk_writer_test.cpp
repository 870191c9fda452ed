// Whole maps written at once, and verify() on sound and damaged projects.
#include <cstring>
#include <fstream>

#include "document_fixture.h"
#include "runtime/store/page_codec.h"
#include "runtime/store/page_store.h"

using namespace loam;
using namespace loam::test;

namespace {

std::vector<int32_t> noise_heights(size_t count, uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<int32_t> heights(count);
    for (auto& height : heights) height = int32_t(random() % 40000);
    return heights;
}

// A project with heights, layers, operators and commands.
void make_project(const std::filesystem::path& folder) {
    auto document = create_small(folder);
    {
        const auto heights = noise_heights(301 * 207, 1);
        BulkWriter writer(*document);
        ASSERT_TRUE(writer.write_height_rows(0, 207, heights).ok());
        ASSERT_TRUE(writer.finish().ok());
    }
    std::mt19937 random(4);
    for (int i = 0; i < 40; ++i) (void)document->apply(random_command(random, 10)).ok();
    ASSERT_TRUE(document->undo().ok());
}

}  // namespace

TEST(bulk_writer, writes_maps_with_their_mips) {
    TemporaryFolder folder;
    const auto path = folder.path() / "p";
    auto document = create_small(path);
    const auto heights = noise_heights(301 * 207, 2);
    std::vector<IndexTexel> texels(601 * 413);
    for (size_t i = 0; i < texels.size(); ++i) texels[i].layer = uint16_t(i / 601 / 100);
    {
        BulkWriter writer(*document);
        for (int row = 0; row < 207;) {
            const int count = std::min(17, 207 - row);
            ASSERT_TRUE(
                writer
                    .write_height_rows(row, count,
                                       std::span(heights).subspan(size_t(row) * 301, size_t(count) * 301))
                    .ok());
            row += count;
        }
        EXPECT_NE(
            document->apply(*parse_command(R"({"cmd":"crater","x":1,"y":1})")).message().find("bulk write"),
            std::string::npos);
        ASSERT_TRUE(writer.write_index_rows(0, 413, texels).ok());
        ASSERT_TRUE(writer.finish().ok());
    }
    std::vector<int32_t> read(301 * 207);
    std::vector<IndexTexel> read_texels(601 * 413);
    const auto check = [&] {
        const auto lock = document->read_lock();
        document->read_heights_mm(0, 0, 0, 301, 207, read.data());
        EXPECT_EQ(read, heights);
        document->read_index(0, 0, 0, 601, 413, read_texels.data());
        EXPECT_TRUE(read_texels == texels);
        std::vector<int32_t> coarse(38 * 26);
        document->read_heights_mm(3, 0, 0, 38, 26, coarse.data());
        for (int y = 0; y < 26; ++y)
            for (int x = 0; x < 38; ++x)
                ASSERT_EQ(coarse[size_t(y * 38 + x)], heights[size_t(y * 8 * 301 + x * 8)]);
    };
    check();
    EXPECT_EQ(take(Document::verify(path)), std::vector<std::string>());
    EXPECT_EQ(document->statistics().height_pages, 5u * 4 + 3 * 2 + 2 + 1);
    document.reset();
    document = take(Document::open(path));
    check();
    // Over what is there: back to default, and the rows are gone.
    BulkWriter writer(*document);
    ASSERT_TRUE(writer.write_height_rows(0, 207, std::vector<int32_t>(301 * 207, 12000)).ok());
    ASSERT_TRUE(writer.finish().ok());
    EXPECT_EQ(document->statistics().height_pages, 0u);
    EXPECT_EQ(take(Document::verify(path)), std::vector<std::string>());
}

TEST(bulk_writer, changes_nothing_unless_finished) {
    TemporaryFolder folder;
    const auto document = create_small(folder.path() / "p");
    const uint64_t digest = take(document->content_digest());
    const auto heights = noise_heights(301 * 207, 3);
    {
        BulkWriter writer(*document);
        ASSERT_TRUE(writer.write_height_rows(0, 207, heights).ok());
    }
    {
        BulkWriter writer(*document);
        ASSERT_TRUE(writer.write_height_rows(0, 100, std::span(heights).first(30100)).ok());
        EXPECT_EQ(writer.finish().message(), "only 100 of 207 height rows were written");
    }
    {
        BulkWriter writer(*document);
        EXPECT_FALSE(writer.write_height_rows(5, 1, std::span(heights).first(301)).ok());
        EXPECT_FALSE(writer.finish().ok());
    }
    {
        BulkWriter writer(*document);
        EXPECT_FALSE(writer.write_height_rows(0, 2, std::span(heights).first(301)).ok());
    }
    EXPECT_EQ(take(document->content_digest()), digest);
    // What leaves the maps alone can be undone afterwards.
    ASSERT_TRUE(document->apply(*parse_command(R"({"cmd":"crater","x":1,"y":1})")).ok());
    {
        BulkWriter writer(*document);
        EXPECT_TRUE(writer.write_height_rows(0, 207, heights).ok());
    }
    ASSERT_TRUE(document
                    ->apply(*parse_command(
                        R"({"cmd":"sculpt","mode":"raise","dabs":[[20,20]],"radius_m":9,"strength_m":3})"))
                    .ok());
    BulkWriter writer(*document);
    EXPECT_NE(writer.write_height_rows(0, 207, heights).message().find("the journal holds edits of the maps"),
              std::string::npos);
}

TEST(verify, finds_what_is_wrong) {
    TemporaryFolder folder;
    const auto path = folder.path() / "p";
    make_project(path);
    ASSERT_EQ(take(Document::verify(path)), std::vector<std::string>());
    const auto with_store = [&](auto&& body) {
        auto store = take(PageStore::open(path / "terrain.db", DatabaseMode::read_write));
        body(store);
    };
    const auto expect_fault = [&](const char* text) {
        const auto faults = Document::verify(path);
        ASSERT_TRUE(faults.ok()) << faults.message();
        bool found = false;
        for (const std::string& fault : *faults) found |= fault.find(text) != std::string::npos;
        EXPECT_TRUE(found) << text << " is not among " << faults->size() << " faults"
                           << (faults->empty() ? "" : ", first: " + faults->front());
    };
    const PageKey fine{BaseMap::height, 0, 1, 1}, coarse{BaseMap::height, 1, 0, 0};
    std::vector<uint8_t> blob;
    with_store([&](PageStore& store) {
        blob = *take(store.read_page(fine.packed()));
        auto changed = blob;
        changed[changed.size() / 2] ^= 4;
        ASSERT_TRUE(store.write_page(fine.packed(), changed).ok());
    });
    expect_fault("page 1, 1 of mip 0 of the height map: damaged data");
    with_store([&](PageStore& store) {
        std::array<int32_t, kBasePageSamples> page;
        ASSERT_TRUE(decode_height_page(blob, page).ok());
        page[2 * 64 + 2] += 1;
        ASSERT_TRUE(store.write_page(fine.packed(), encode_height_page(page)).ok());
    });
    expect_fault(
        "page 0, 0 of mip 1 of the height map does not equal the samples of mip 0 at its sample 33, 33");
    with_store([&](PageStore& store) {
        ASSERT_TRUE(store.write_page(fine.packed(), blob).ok());
        blob = *take(store.read_page(coarse.packed()));
        ASSERT_TRUE(store.erase_page(coarse.packed()).ok());
    });
    expect_fault("page 0, 0 of mip 1 of the height map is missing");
    expect_fault("terrain.db counts");
    with_store([&](PageStore& store) {
        ASSERT_TRUE(store.write_page(coarse.packed(), blob).ok());
        ASSERT_TRUE(store.write_page(PageKey{BaseMap::height, 0, 900, 1}.packed(), blob).ok());
    });
    expect_fault("lies outside the map");
    with_store([&](PageStore& store) {
        ASSERT_TRUE(store.erase_page(PageKey{BaseMap::height, 0, 900, 1}.packed()).ok());
        ASSERT_TRUE(store.write_operator(1, "{\"kind\":\"volcano\"", std::nullopt).ok());
    });
    expect_fault("not valid JSON");
    with_store([&](PageStore& store) {
        ASSERT_TRUE(store.erase_operator(1).ok());
        JournalRow row = take(store.read_journal(2));
        row.images.pop_back();
        row.json = "{}";
        ASSERT_TRUE(store.write_journal(row).ok());
    });
    expect_fault("command 2 of the journal: a command: \"cmd\" is missing");
    expect_fault("cut short");
}

TEST(verify, says_what_is_no_project) {
    TemporaryFolder folder;
    EXPECT_NE(Document::verify(folder.path() / "none").message().find("there is no folder"),
              std::string::npos);
    EXPECT_NE(Document::verify(folder.path()).message().find("is it a project"), std::string::npos);
    const auto path = folder.path() / "p";
    make_project(path);
    std::ifstream stream(path / "terrain.db", std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    const auto overwrite = [&](const std::string& with) {
        std::ofstream(path / "terrain.db", std::ios::binary) << with;
    };
    overwrite(std::string(bytes.size(), '\0'));
    EXPECT_NE(Document::verify(path).message().find("begins with zeros"), std::string::npos);
    EXPECT_FALSE(Document::open(path).ok());
    // Cut short anywhere: an error or faults, never silence, never a crash; opening and editing neither.
    for (size_t part = 0; part < 16; ++part) {
        overwrite(bytes.substr(0, bytes.size() * part / 16));
        const auto faults = Document::verify(path);
        EXPECT_TRUE(!faults.ok() || !faults->empty()) << part << "/16 of the file";
        auto document = Document::open(path);
        if (document.ok())
            (void)(*document)
                ->apply(*parse_command(R"({"cmd":"sculpt","mode":"raise","dabs":[[99,99]]})"))
                .ok();
    }
    std::mt19937 random(6);
    for (int i = 0; i < 60; ++i) {
        std::string changed = bytes;
        for (int k = 0; k < 8; ++k) changed[random() % changed.size()] = char(random());
        overwrite(changed);
        (void)Document::verify(path).ok();
        auto document = Document::open(path);
        if (document.ok())
            (void)(*document)
                ->apply(*parse_command(R"({"cmd":"sculpt","mode":"raise","dabs":[[99,99]]})"))
                .ok();
    }
    std::filesystem::remove(path / "terrain.db");
    EXPECT_NE(Document::verify(path).message().find("is missing"), std::string::npos);
}

TEST(verify, disagreement_about_the_map_is_found) {
    TemporaryFolder folder;
    const auto path = folder.path() / "p";
    make_project(path);
    ProjectSettings settings = small_settings();
    settings.height_samples_x = 400;
    ASSERT_TRUE(save_project(path, settings).ok());
    EXPECT_NE(Document::open(path).message().find("disagree about height_samples_x"), std::string::npos);
    ASSERT_EQ(take(Document::verify(path)).size(), 1u);
}
