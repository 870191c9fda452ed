// Every row of a project read and checked against what it must be. Works on a read-only connection and takes
// no lock.
#include <algorithm>
#include <functional>
#include <map>

#include "runtime/base/units.h"
#include "runtime/document/dirt.h"
#include "runtime/document/document_impl.h"
#include "runtime/document/function_library.h"
#include "runtime/document/laid_layer.h"
#include "runtime/document/operator_json.h"

namespace loam {

namespace {

constexpr size_t kMostFaults = 1000;  // of a wrecked file, no more than anybody reads

class Verifier {
  public:
    Verifier(const std::filesystem::path& folder, const ProjectSettings& settings, PageStore& store)
        : folder_(folder),
          stamps_(folder),
          functions_(folder),
          settings_(settings),
          store_(store),
          height_(height_shape(settings)),
          index_(index_shape(settings)) {}

    Result<std::vector<std::string>> run() {
        auto sound = store_.quick_check();
        if (!sound.ok()) return sound.error();
        for (const std::string& fault : *sound) fail("terrain.db: {}", fault);
        LOAM_TRY(read_keys());
        LOAM_TRY(check_map<int32_t>(height_, settings_.default_height_mm));
        LOAM_TRY(check_map<IndexTexel>(index_, default_texel(settings_)));
        LOAM_TRY(check_counts());
        check_imagery();
        check_functions();
        LOAM_TRY(check_operators());
        LOAM_TRY(check_journal());
        return std::move(faults_);
    }

  private:
    template <typename... Args>
    void fail(fmt::format_string<Args...> format, Args&&... args) {
        if (faults_.size() < kMostFaults) faults_.push_back(fmt::format(format, std::forward<Args>(args)...));
    }
    [[nodiscard]] bool has_layer(const std::string& name) const {
        return std::any_of(settings_.layers.begin(), settings_.layers.end(),
                           [&](const LayerEntry& layer) { return layer.name == name; });
    }
    static std::string name_of(const PageKey& key) {
        return fmt::format("page {}, {} of mip {} of the {} map", key.x, key.y, key.mip,
                           key.map == BaseMap::height ? "height" : "index");
    }

    Status read_keys() {
        return store_.for_each_page([&](int64_t packed, std::span<const uint8_t>) {
            const PageKey key = PageKey::unpacked(packed);
            const MapShape& shape = key.map == BaseMap::height ? height_ : index_;
            if (key.packed() != packed || (key.map != BaseMap::height && key.map != BaseMap::index) ||
                key.mip >= shape.mip_count || key.x >= shape.pages_x(key.mip) ||
                key.y >= shape.pages_y(key.mip))
                fail("terrain.db has a page with the key {}, which lies outside the map", packed);
            else
                (key.map == BaseMap::height ? height_keys_ : index_keys_).push_back(key);
            return Status();
        });
    }

    // Null: all default, or damaged (reported by the walk over all pages).
    template <typename Sample>
    Result<PageHandle<Sample>> load(const PageKey& key) {
        auto& cache = cache_of<Sample>();
        const int64_t packed = key.packed();
        if (const auto found = cache.find(packed); found != cache.end()) return found->second;
        const auto blob = store_.read_page(packed);
        if (!blob.ok()) return blob.error();
        PageHandle<Sample> handle;
        if (blob->has_value()) {
            auto page = std::make_shared<BasePage<Sample>>();
            if (decode_page<Sample>(**blob, *page).ok()) handle = std::move(page);
        }
        if (cache.size() > 4096) cache.clear();
        cache.emplace(packed, handle);
        return handle;
    }

    template <typename Sample>
    Status check_map(const MapShape& shape, const Sample& fallback) {
        const auto& keys = shape.map == BaseMap::height ? height_keys_ : index_keys_;
        for (const PageKey& key : keys) {
            const auto blob = store_.read_page(key.packed());
            if (!blob.ok()) return blob.error();
            BasePage<Sample> page;
            const Status decoded =
                blob->has_value() ? decode_page<Sample>(**blob, page) : error("it is gone");
            if (!decoded.ok()) {
                fail("{}: {}", name_of(key), decoded.message());
                continue;
            }
            check_samples(key, page, shape, fallback);
            if (key.mip > 0) LOAM_TRY(check_against_finer(key, page, shape, fallback));
            if (key.mip + 1 < shape.mip_count) LOAM_TRY(check_coarser_present(key, page, fallback));
        }
        return {};
    }

    template <typename Sample>
    void check_samples(const PageKey& key, const BasePage<Sample>& page, const MapShape& shape,
                       const Sample& fallback) {
        const int columns = shape.width(key.mip) - key.x * kBasePageSide,
                  rows = shape.height(key.mip) - key.y * kBasePageSide;
        bool all_default = true, outside_default = true, in_range = true;
        for (int y = 0; y < kBasePageSide; ++y)
            for (int x = 0; x < kBasePageSide; ++x) {
                const Sample& sample = page[size_t(y * kBasePageSide + x)];
                const bool is_default = sample == fallback;
                all_default &= is_default;
                if (x >= columns || y >= rows) outside_default &= is_default;
                if constexpr (std::is_same_v<Sample, int32_t>)
                    in_range &= sample == saturate_height_mm(sample);
            }
        if (all_default) fail("{} is all default and should not be stored", name_of(key));
        if (!outside_default) fail("{} has samples beyond the edge of the map", name_of(key));
        if (!in_range) fail("{} has heights beyond ±{} m", name_of(key), height_m_from_mm(kHeightLimit_mm));
    }

    // By induction over mips, every mip then equals the samples of mip 0.
    template <typename Sample>
    Status check_against_finer(const PageKey& key, const BasePage<Sample>& page, const MapShape& shape,
                               const Sample& fallback) {
        for (int quarter = 0; quarter < 4; ++quarter) {
            const PageKey fine{key.map, key.mip - 1, 2 * key.x + quarter % 2, 2 * key.y + quarter / 2};
            if (fine.x >= shape.pages_x(fine.mip) || fine.y >= shape.pages_y(fine.mip)) continue;
            const auto finer = load<Sample>(fine);
            if (!finer.ok()) return finer.error();
            constexpr int kHalf = kBasePageSide / 2;
            for (int y = 0; y < kHalf; ++y)
                for (int x = 0; x < kHalf; ++x) {
                    const Sample& have =
                        page[size_t((y + quarter / 2 * kHalf) * kBasePageSide + x + quarter % 2 * kHalf)];
                    const Sample& want = *finer ? (**finer)[size_t(2 * y * kBasePageSide + 2 * x)] : fallback;
                    if (have == want) continue;
                    fail("{} does not equal the samples of mip {} at its sample {}, {}", name_of(key),
                         fine.mip, x + quarter % 2 * kHalf, y + quarter / 2 * kHalf);
                    return {};
                }
        }
        return {};
    }

    // A page whose coarser page is not stored must be default where that one has samples.
    template <typename Sample>
    Status check_coarser_present(const PageKey& key, const BasePage<Sample>& page, const Sample& fallback) {
        const PageKey coarse{key.map, key.mip + 1, key.x / 2, key.y / 2};
        const auto blob = store_.read_page(coarse.packed());
        if (!blob.ok()) return blob.error();
        if (blob->has_value()) return {};
        for (int y = 0; y < kBasePageSide; y += 2)
            for (int x = 0; x < kBasePageSide; x += 2)
                if (!(page[size_t(y * kBasePageSide + x)] == fallback)) {
                    fail("{} is missing", name_of(coarse));
                    return {};
                }
        return {};
    }

    Status check_counts() {
        for (const auto& [name, keys] :
             {std::pair{"height_pages", &height_keys_}, {"index_pages", &index_keys_}}) {
            const auto stored = store_.read_meta(name);
            if (!stored.ok()) return stored.error();
            if (stored->value_or(0) != int64_t(keys->size()))
                fail("terrain.db counts {} {}, there are {}", stored->value_or(0), name, keys->size());
        }
        return {};
    }

    void check_imagery() {
        if (settings_.imagery.file.empty()) return;
        const auto file = folder_ / settings_.imagery.file;
        if (const auto imagery = Imagery::open(file, settings_); !imagery.ok())
            return fail("imagery: {}", imagery.message());
        const auto opened = ImageryFile::open(file);
        if (!opened.ok()) return fail("imagery: {}", opened.message());
        const ImageryShape& shape = (*opened)->shape();
        std::vector<uint8_t> tile(size_t(4) * kImageryTile * kImageryTile);
        for (int level = 0; level < shape.level_count(); ++level)
            for (int y = 0; y * kImageryTile < shape.height_at(level); ++y)
                for (int x = 0; x * kImageryTile < shape.width_at(level); ++x)
                    if (const Status read = (*opened)->read_tile(level, x, y, tile); !read.ok())
                        fail("imagery: {}", read.message());
    }

    // Those of the project's own folder, whether a decal shows them or not.
    void check_functions() {
        for (const std::string& name : functions_.names()) {
            std::error_code none;
            if (!std::filesystem::exists(functions_.file_of(name), none)) continue;
            if (const auto function = functions_.find(name); !function.ok()) fail("{}", function.message());
        }
    }

    // One whose text is at fault is among those above.
    void check_function(uint64_t id, const DecalMaterial& material) {
        if (const auto text = functions_.text(material.function); !text.ok())
            return fail("operator {}: {}", id, text.message());
        if (const auto function = functions_.find(material.function); function.ok())
            if (const Status known = check_parameters(**function, material.parameters); !known.ok())
                fail("operator {}: {}", id, known.message());
    }

    Status check_operators() {
        const auto next = store_.read_meta("next_operator");
        if (!next.ok()) return next.error();
        return store_.for_each_operator([&](const PageStore::OperatorRow& row) {
            const uint64_t id = row.id;
            const auto op = parse_operator(id, row.json);
            if (!op.ok())
                fail("{}", op.message());
            else if (int64_t(id) >= next->value_or(1))
                fail("operator {} has an id that has not been given out yet", id);
            // None of an older format's have a node before it is opened for writing.
            const auto of = op.ok() ? node_of(*op, grids_of(settings_)) : std::nullopt;
            if (op.ok() && row.node && (!of || of->key != *row.node))
                fail(
                    "operator {} is kept at another place than it has: move it and undo that, or restore "
                    "terrain.db",
                    id);
            const DecalMaterial* material = op.ok() ? material_of(op->shape) : nullptr;
            if (material && !material->layer.empty() && !has_layer(material->layer))
                fail("operator {} is made of the layer \"{}\", which the project does not have", id,
                     material->layer);
            if (material && !material->function.empty()) check_function(id, *material);
            if (op.ok()) {
                OperatorShape shape = op->shape;
                if (const LaidLayer laid = laid_layer(shape); laid.chosen() && !has_layer(*laid.name))
                    fail("operator {} lays the layer \"{}\", which the project does not have", id,
                         *laid.name);
            }
            if (const auto* stamp = op.ok() ? std::get_if<Stamp>(&op->shape) : nullptr) {
                if (const auto picture = stamps_.find(stamp->image); !picture.ok())
                    fail("operator {}: {}", id, picture.message());
            }
            return Status();
        });
    }

    Status check_journal() {
        const auto next = store_.read_meta("next_sequence");
        if (!next.ok()) return next.error();
        bool undone = false;
        return store_.for_each_journal(0, PageStore::JournalColumns::all, [&](const JournalRow& row) {
            const auto command = parse_command(row.json);
            if (!command.ok()) fail("command {} of the journal: {}", row.sequence, command.message());
            if (row.applied && undone)
                fail("command {} of the journal is applied after one that is undone", row.sequence);
            undone |= !row.applied;
            if (int64_t(row.sequence) >= next->value_or(1))
                fail("command {} of the journal has a number of the future", row.sequence);
            if (const auto dirt = dirt_of(row.dirt); !dirt.ok())
                fail("command {}: {}", row.sequence, dirt.message());
            check_images(row);
            return Status();
        });
    }

    void check_images(const JournalRow& row) {
        const auto images = images_of(row.images);
        if (!images.ok()) return fail("command {}: {}", row.sequence, images.message());
        for (const RowImage& image : *images) {
            if (!image.bytes) continue;
            Status status;
            if (image.kind == RowImage::Kind::op) {
                const auto op =
                    parse_operator(uint64_t(image.key),
                                   {reinterpret_cast<const char*>(image.bytes->data()), image.bytes->size()});
                if (!op.ok()) status = op.error();
            } else if (image.kind == RowImage::Kind::transition) {
                const auto entry = parse_transition(
                    {reinterpret_cast<const char*>(image.bytes->data()), image.bytes->size()});
                if (!entry.ok()) status = entry.error();
            } else if (PageKey::unpacked(image.key).map == BaseMap::height) {
                BasePage<int32_t> page;
                status = decode_page<int32_t>(*image.bytes, page);
            } else {
                BasePage<IndexTexel> page;
                status = decode_page<IndexTexel>(*image.bytes, page);
            }
            if (!status.ok())
                fail("command {} of the journal, an image of it: {}", row.sequence, status.message());
        }
    }

    template <typename Sample>
    auto& cache_of() {
        if constexpr (std::is_same_v<Sample, int32_t>)
            return height_cache_;
        else
            return index_cache_;
    }

    std::filesystem::path folder_;
    StampLibrary stamps_;
    FunctionLibrary functions_;
    const ProjectSettings& settings_;
    PageStore& store_;
    const MapShape height_, index_;
    std::vector<PageKey> height_keys_, index_keys_;
    std::map<int64_t, PageHandle<int32_t>> height_cache_;
    std::map<int64_t, PageHandle<IndexTexel>> index_cache_;
    std::vector<std::string> faults_;
};

}  // namespace

Result<std::vector<std::string>> Document::verify(const std::filesystem::path& folder) {
    const auto settings = load_project(folder);
    if (!settings.ok()) return settings.error();
    auto store = PageStore::open(folder / "terrain.db", DatabaseMode::read_only);
    if (!store.ok()) return store.error();
    LOAM_TRY(store->begin_reading());
    const Status identity = check_identity(*store, *settings);
    if (!identity.ok()) return std::vector<std::string>{identity.message()};
    return Verifier(folder, *settings, *store).run();
}

}  // namespace loam
