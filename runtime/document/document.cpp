#include "runtime/document/document.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <set>
#include <string_view>

#include "runtime/base/check.h"
#include "runtime/base/log.h"
#include "runtime/document/document_impl.h"
#include "runtime/document/operator_json.h"

namespace loam {

namespace {

std::vector<std::pair<std::string, int64_t>> identity_of(const ProjectSettings& s) {
    return {{"height_samples_x", s.height_samples_x},
            {"height_samples_y", s.height_samples_y},
            {"height_spacing_m", std::bit_cast<int64_t>(s.height_spacing_m)},
            {"index_spacing_m", std::bit_cast<int64_t>(s.index_spacing_m)},
            {"default_height_mm", s.default_height_mm},
            {"default_layer", s.default_layer}};
}

template <typename Sample>
void read_base(BasePages& pages, const MapShape& shape, const Sample& fallback, int mip,
               const TexelRect& window, Sample* out) {
    LOAM_CHECK(mip >= 0 && mip < shape.mip_count, fmt::format("mip {} of {}", mip, shape.mip_count));
    PageHandle<Sample> keep;
    read_window(
        shape, mip, window.x0, window.y0, window.width(), window.height(), fallback,
        [&](int page_x, int page_y) -> const BasePage<Sample>* {
            auto page = pages.load<Sample>({shape.map, mip, page_x, page_y});
            // A damaged page reads as default; commands that would overwrite it are refused (PageEdits).
            if (!page.ok()) log(LogLevel::error, "{}", page.message());
            keep = page.ok() ? *page : nullptr;
            return keep.get();
        },
        out);
}

Result<uint64_t> meta_or(PageStore& store, const char* name, uint64_t otherwise) {
    const auto value = store.read_meta(name);
    if (!value.ok()) return value.error();
    return value->has_value() ? uint64_t(**value) : otherwise;
}

bool shows_heat(const ProjectSettings& settings) {
    return std::any_of(settings.channels.begin(), settings.channels.end(),
                       [](Channel c) { return c == Channel::thermal || c == Channel::emissive; });
}

uint64_t digest_of(uint64_t hash, std::span<const uint8_t> bytes) {
    for (const uint8_t byte : bytes) hash = (hash ^ byte) * 0x100000001b3ull;  // FNV-1a
    return hash;
}
uint64_t digest_of(uint64_t hash, uint64_t number) {
    for (int i = 0; i < 8; ++i) hash = (hash ^ (number >> (8 * i) & 255)) * 0x100000001b3ull;
    return hash;
}

}  // namespace

Status write_identity(PageStore& store, const ProjectSettings& settings) {
    for (const auto& [name, value] : identity_of(settings)) LOAM_TRY(store.write_meta(name, value));
    return {};
}

Status check_identity(PageStore& store, const ProjectSettings& settings) {
    for (const auto& [name, value] : identity_of(settings)) {
        const auto stored = store.read_meta(name);
        if (!stored.ok()) return stored.error();
        if (!stored->has_value()) return error("terrain.db does not say its {}; it is damaged", name);
        if (**stored != value)
            return error(
                "project.toml and terrain.db disagree about {}: the terrain was made with another value; "
                "restore project.toml",
                name);
    }
    return {};
}

Result<std::unique_ptr<Document>> Document::create(const std::filesystem::path& folder,
                                                   const ProjectSettings& settings) {
    LOAM_TRY(check_settings(settings));
    std::error_code failure;
    for (const char* file : {"project.toml", "terrain.db"})
        if (std::filesystem::exists(folder / file, failure))
            return error("{} already holds a project ({}); choose another folder", folder.string(), file);
    std::filesystem::create_directories(folder, failure);
    if (failure) return error("cannot make the folder {}: {}", folder.string(), failure.message());

    const auto fill = [&]() -> Status {
        auto lock = WriterLock::acquire(folder);
        if (!lock.ok()) return lock.error();
        auto store = PageStore::open(folder / "terrain.db", DatabaseMode::create);
        if (!store.ok()) return store.error();
        LOAM_TRY(store->begin());
        const Status identity = write_identity(*store, settings);
        if (!identity.ok()) {
            store->rollback();
            return identity;
        }
        LOAM_TRY(store->commit());
        return save_project(folder, settings);  // last: a folder with a project.toml has a database
    };
    const Status status = fill();
    if (!status.ok()) {
        for (const char* file : {"terrain.db", "terrain.db-wal", "terrain.db-shm", "project.toml.new"})
            std::filesystem::remove(folder / file, failure);
        return status.error();
    }
    return open(folder, OpenMode::read_write);
}

Result<std::unique_ptr<Document>> Document::open(const std::filesystem::path& folder, OpenMode mode) {
    auto settings = load_project(folder);
    if (!settings.ok()) return settings.error();
    auto impl = std::make_unique<Impl>();
    impl->folder = folder;
    impl->settings = std::move(*settings);
    impl->mode = mode;
    impl->stamps = std::make_unique<StampLibrary>(folder);
    impl->functions = std::make_unique<FunctionLibrary>(folder);
    if (!impl->settings.imagery.file.empty()) {
        auto imagery = Imagery::open(folder / impl->settings.imagery.file, impl->settings);
        // It may come back; nothing that is saved depends on it.
        if (imagery.ok())
            impl->imagery = std::move(*imagery);
        else
            log(LogLevel::warning, "the imagery is not shown: {}", imagery.message());
    }
    if (mode == OpenMode::read_write) {
        auto lock = WriterLock::acquire(folder);
        if (!lock.ok()) return lock.error();
        impl->lock = std::move(lock).value();
        auto store = PageStore::open(folder / "terrain.db", DatabaseMode::read_write);
        if (!store.ok()) return store.error();
        impl->store = std::move(store).value();
    }
    auto reader = PageStore::open(folder / "terrain.db", DatabaseMode::read_only);
    if (!reader.ok()) return reader.error();
    impl->pages = std::make_unique<BasePages>(std::move(reader).value(), kPageCacheBytes);
    LOAM_TRY(impl->load());
    return std::unique_ptr<Document>(new Document(std::move(impl)));
}

Status Document::Impl::load() {
    height = height_shape(settings);
    index = index_shape(settings);
    operators.set_shows_heat(shows_heat(settings));
    LOAM_TRY(pages->with_store([&](PageStore& reader) -> Status {
        LOAM_TRY(check_identity(reader, settings));
        auto time = reader.read_meta(kTimeMeta);
        if (!time.ok()) return time.error();
        if (const double time_s = std::bit_cast<double>(time->value_or(0)); std::isfinite(time_s)) {
            Dirt nothing;
            operators.set_time(time_s, nothing);
        }
        LOAM_TRY(load_operators(reader));
        auto journal = reader.journal_heads();
        if (!journal.ok()) return journal.error();
        heads = std::move(*journal);
        for (const auto& head : heads) next_group = std::max(next_group, head.group + 1);
        for (const auto& [name, value] : {std::pair<const char*, uint64_t*>{"next_operator", &next_operator},
                                          {"next_sequence", &next_sequence}}) {
            const auto stored = meta_or(reader, name, 1);
            if (!stored.ok()) return stored.error();
            *value = *stored;
        }
        for (const auto& [name, value] :
             {std::pair<const char*, int64_t*>{"height_pages", &page_count.height},
              {"index_pages", &page_count.index}}) {
            const auto stored = meta_or(reader, name, 0);
            if (!stored.ok()) return stored.error();
            *value = int64_t(*stored);
        }
        return {};
    }));
    if (mode == OpenMode::read_write) LOAM_TRY(give_nodes());
    return {};
}

Status Document::Impl::load_operators(PageStore& reader) {
    grids = grids_of(settings);
    nodes = std::make_unique<OperatorNodes>(
        grids, [this](int64_t node) { return read_node(node); },
        [this](uint64_t id) -> std::optional<int64_t> {
            const auto row = pages->with_store([&](PageStore& from) { return from.read_operator(id); });
            return row.ok() && row->has_value() ? (*row)->node : std::nullopt;
        });
    size_t without_parts = 0;
    std::string missing;  // of the first
    // What is missing may come back; nothing that is saved depends on it.
    const auto note = [&](const Status& given, uint64_t operators) {
        if (given.ok()) return;
        if (without_parts == 0) missing = given.message();
        without_parts += operators;
    };
    LOAM_TRY(reader.for_each_operator_without_node([&](const PageStore::OperatorRow& row) -> Status {
        auto op = parse_operator(row.id, row.json);
        if (!op.ok()) return error("terrain.db: {}", op.message());
        note(give_parts(*op), 1);
        operators.set(*op);
        return {};
    }));
    LOAM_TRY(reader.for_each_node([&](const OperatorNode& node, uint64_t count) -> Status {
        nodes->add_counted(node, count);
        if (node.function.empty()) return {};
        const auto function = functions->find(node.function);
        if (!function.ok()) note(function.error(), count);
        return {};
    }));
    if (without_parts > 0)
        log(LogLevel::warning, "stamps and decals that show nothing: {}; {}", without_parts, missing);
    return {};
}

Status Document::Impl::give_nodes() {
    std::vector<Operator> moved;
    for (const Operator& op : operators.sorted())
        if (node_of(op, grids)) moved.push_back(op);
    if (moved.empty()) return {};
    LOAM_TRY(store.begin());
    for (const Operator& op : moved)
        if (const Status status = store.write_operator(op.id, operator_json(op), node_of(op, grids));
            !status.ok()) {
            store.rollback();
            return status;
        }
    LOAM_TRY(store.commit());
    for (const Operator& op : moved) {
        operators.remove(op.id);
        nodes->add_counted(*node_of(op, grids), 1);
    }
    return {};
}

Result<Operator> Document::Impl::read_operator(const PageStore::OperatorRow& row) {
    auto op = parse_operator(row.id, row.json);
    if (op.ok()) (void)give_parts(*op);  // it shows nothing then, which was said at opening
    return op;
}

std::vector<Operator> Document::Impl::read_node(int64_t node) {
    std::vector<PageStore::OperatorRow> rows;
    const Status status = pages->with_store([&](PageStore& reader) {
        return reader.for_each_operator_of_node(node, [&](const PageStore::OperatorRow& row) {
            rows.push_back(row);
            return Status();
        });
    });
    if (!status.ok()) log(LogLevel::error, "operators are not shown: {}", status.message());
    std::vector<Operator> read;
    for (const PageStore::OperatorRow& row : rows) {
        auto op = read_operator(row);
        if (const auto of = op.ok() ? node_of(*op, grids) : std::nullopt; op.ok() && (!of || of->key != node))
            op =
                error("operator {}: kept at another place than it has; `loam verify` finds all such", row.id);
        if (op.ok())
            read.push_back(std::move(*op));
        else
            log(LogLevel::error, "not shown: {}", op.message());
    }
    return read;
}

std::optional<Operator> Document::Impl::find_operator(uint64_t id) {
    if (const Operator* op = operators.find(id)) return *op;
    const auto row = pages->with_store([&](PageStore& reader) { return reader.read_operator(id); });
    if (!row.ok()) log(LogLevel::error, "operator {} cannot be read: {}", id, row.message());
    if (!row.ok() || !row->has_value()) return std::nullopt;
    auto op = read_operator(**row);
    if (!op.ok()) log(LogLevel::error, "terrain.db: {}", op.message());
    return op.ok() ? std::optional(std::move(*op)) : std::nullopt;
}

Status Document::Impl::may_write() const {
    if (mode == OpenMode::read_only) return error("{} is open read-only", folder.string());
    if (bulk_writing) return error("a bulk write is going on; finish it first");
    return {};
}

size_t Document::Impl::applied_count() const {
    size_t count = heads.size();
    while (count > 0 && !heads[count - 1].applied) --count;
    return count;
}

Document::Document(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

// The time is kept as a view is: written with every change, and here; losing it loses nothing that was made.
Document::~Document() {
    if (impl_->mode == OpenMode::read_only) return;
    const Status status =
        impl_->store.write_meta(kTimeMeta, std::bit_cast<int64_t>(impl_->operators.time_s()));
    if (!status.ok()) log(LogLevel::warning, "the time of the map was not kept: {}", status.message());
}

const std::filesystem::path& Document::folder() const {
    return impl_->folder;
}
const ProjectSettings& Document::settings() const {
    return impl_->settings;
}
uint64_t Document::revision() const {
    return impl_->revision;
}

bool Document::can_undo() const {
    return impl_->mode == OpenMode::read_write && impl_->applied_count() > 0;
}
bool Document::can_redo() const {
    return impl_->mode == OpenMode::read_write && impl_->applied_count() < impl_->heads.size();
}
uint64_t Document::next_group() {
    return impl_->next_group++;
}

Result<std::vector<Document::HistoryEntry>> Document::history(int newest_count) const {
    const ReadLock lock(impl_->mutex);
    const auto& heads = impl_->heads;
    std::vector<HistoryEntry> entries;
    if (heads.empty() || newest_count <= 0) return entries;
    const size_t count = std::min(heads.size(), size_t(newest_count));
    const Status status = impl_->pages->with_store([&](PageStore& reader) {
        return reader.for_each_journal(
            heads[heads.size() - count].sequence, PageStore::JournalColumns::text,
            [&](const JournalRow& row) {
                entries.push_back({row.sequence, row.group, row.applied, row.json});
                return Status();
            });
    });
    if (!status.ok()) return status.error();
    std::reverse(entries.begin(), entries.end());
    return entries;
}

Status Document::change_settings(const ProjectSettings& settings) {
    LOAM_TRY(impl_->may_write());
    LOAM_TRY(check_settings(settings));
    const auto before = identity_of(impl_->settings), after = identity_of(settings);
    for (size_t i = 0; i < before.size(); ++i)
        if (before[i] != after[i]) return error("{} cannot change once a project exists", before[i].first);
    std::shared_ptr<const Imagery> imagery = impl_->imagery;
    if (settings.imagery.file != impl_->settings.imagery.file) {
        imagery = nullptr;
        if (!settings.imagery.file.empty()) {
            auto opened = Imagery::open(impl_->folder / settings.imagery.file, settings);
            if (!opened.ok()) return opened.error();
            imagery = std::move(*opened);
        }
    }
    LOAM_TRY(save_project(impl_->folder, settings));
    const Impl::Exclusive lock(*impl_);
    impl_->settings = settings;
    impl_->operators.set_shows_heat(shows_heat(settings));
    impl_->imagery = std::move(imagery);
    ++impl_->revision;
    return {};
}

Status Document::check_writable() const {
    return impl_->may_write();
}

Document::ReadLock Document::read_lock() const {
    const std::unique_lock after_writers(impl_->gate, std::chrono::milliseconds(20));
    return ReadLock(impl_->mutex);
}
void Document::read_heights_mm(int mip, int x0, int y0, int width, int height, int32_t* out) const {
    read_base(*impl_->pages, impl_->height, impl_->settings.default_height_mm, mip,
              TexelRect{x0, y0, x0 + width, y0 + height}, out);
}
void Document::read_index(int mip, int x0, int y0, int width, int height, IndexTexel* out) const {
    read_base(*impl_->pages, impl_->index, default_texel(impl_->settings), mip,
              TexelRect{x0, y0, x0 + width, y0 + height}, out);
}
int Document::height_mip_count() const {
    return impl_->height.mip_count;
}
int Document::index_mip_count() const {
    return impl_->index.mip_count;
}
TexelRect Document::fill_texels(const FillCommand& command) const {
    return loam::fill_texels(command, impl_->index);
}

glm::ivec2 Document::index_size_texels() const {
    return {impl_->index.samples_x, impl_->index.samples_y};
}
namespace {

// Of what is held, and behind it of what was read: in order of evaluation.
void merge_into(std::vector<const Operator*>& out, const std::vector<const Operator*>& more) {
    const auto middle = ptrdiff_t(out.size());
    out.insert(out.end(), more.begin(), more.end());
    std::inplace_merge(out.begin(), out.begin() + middle, out.end(),
                       [](const Operator* a, const Operator* b) { return evaluated_before(*a, *b); });
}

}  // namespace

void Document::operators_over_height(const WorldRect& rect, double step_m,
                                     std::vector<const Operator*>& out) const {
    impl_->operators.over_height().query(rect, out);
    thread_local std::vector<const Operator*> read;
    impl_->nodes->query_height(rect, step_m, read);
    merge_into(out, read);
}
void Document::operators_over_index(const WorldRect& rect, double step_m,
                                    std::vector<const Operator*>& out) const {
    impl_->operators.over_index().query(rect, out);
    thread_local std::vector<const Operator*> read;
    impl_->nodes->query_index(rect, step_m, read);
    merge_into(out, read);
}
void Document::operators_over_texture(const WorldRect& rect, double texel_m,
                                      std::vector<const Operator*>& out) const {
    impl_->operators.over_texture().query(rect, out, texel_m);
    thread_local std::vector<const Operator*> read;
    impl_->nodes->query_texture(rect, texel_m, read);
    merge_into(out, read);
}
void Document::operators_over_cutout(const WorldRect& rect, std::vector<const Operator*>& out) const {
    impl_->operators.over_cutout().query(rect, out);
}
void Document::operators_over_ground(const WorldRect& rect, std::vector<const Operator*>& out) const {
    impl_->operators.over_ground().query(rect, out);
    thread_local std::vector<const Operator*> read;
    impl_->nodes->query_volumes(rect, read);
    merge_into(out, read);
}

std::vector<OperatorShape> Document::drawn_kinds() const {
    const ReadLock lock(impl_->mutex);
    std::vector<const Operator*> held;
    constexpr double kEverywhere_m = 1.0e7;
    impl_->operators.over_texture().query({-kEverywhere_m, -kEverywhere_m, kEverywhere_m, kEverywhere_m},
                                          held);
    std::vector<OperatorShape> kinds = impl_->nodes->kinds();
    const auto function_of = [](const OperatorShape& shape) {
        const DecalMaterial* material = material_of(shape);
        return material ? std::string_view(material->function) : std::string_view();
    };
    std::set<std::pair<size_t, std::string_view>> seen;  // of what outlives it
    for (const Operator* op : held)
        if (seen.emplace(op->shape.index(), function_of(op->shape)).second) kinds.push_back(op->shape);
    return kinds;
}

std::vector<Operator> Document::operators() const {
    const ReadLock lock(impl_->mutex);
    std::vector<Operator> all = impl_->operators.sorted();
    if (impl_->nodes->counts().operators == 0) return all;
    std::vector<PageStore::OperatorRow> rows;
    const Status status = impl_->pages->with_store([&](PageStore& reader) {
        return reader.for_each_operator([&](const PageStore::OperatorRow& row) {
            if (row.node) rows.push_back(row);
            return Status();
        });
    });
    if (!status.ok()) log(LogLevel::error, "operators cannot be read: {}", status.message());
    for (const PageStore::OperatorRow& row : rows) {
        auto op = impl_->read_operator(row);
        if (op.ok())
            all.push_back(std::move(*op));
        else
            log(LogLevel::error, "terrain.db: {}", op.message());
    }
    std::sort(all.begin(), all.end(), evaluated_before);
    return all;
}

std::vector<Operator> Document::timed_operators() const {
    const ReadLock lock(impl_->mutex);
    return impl_->operators.timed();
}

std::optional<std::vector<uint64_t>> Document::changed_operators(uint64_t since_revision) const {
    const ReadLock lock(impl_->mutex);
    if (since_revision < impl_->forgotten_revision) return std::nullopt;
    std::vector<uint64_t> ids;
    const auto& changes = impl_->changed_operators;
    for (auto change = changes.rbegin(); change != changes.rend() && change->revision > since_revision;
         ++change)
        ids.push_back(change->id);
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    return ids;
}

void Document::trim_operators(size_t most) {
    if (impl_->nodes->loaded() <= most) return;
    const Impl::Exclusive lock(*impl_);
    impl_->nodes->trim(most);
}

std::optional<Operator> Document::find_operator(uint64_t id) const {
    const ReadLock lock(impl_->mutex);
    return impl_->find_operator(id);
}

ResolvedRoles Document::roles() const {
    const auto resolved = [&](const std::string& name) { return uint16_t(std::max(0, layer_index(name))); };
    return {resolved(impl_->settings.roles.scorched), resolved(impl_->settings.roles.broken)};
}
void Document::read_imagery(int level, int x0, int y0, int width, int height, uint32_t* rgba) const {
    if (impl_->imagery)
        impl_->imagery->read(level, x0, y0, width, height, rgba);
    else
        std::fill_n(rgba, size_t(width) * size_t(height), 0u);
}

std::vector<std::string> Document::stamps() const {
    return impl_->stamps->names();
}
FunctionLibrary& Document::functions() const {
    return *impl_->functions;
}
int Document::layer_index(std::string_view name) const {
    const auto& layers = impl_->settings.layers;
    for (size_t i = 0; i < layers.size(); ++i)
        if (layers[i].name == name) return int(i);
    return -1;
}

double Document::time_s() const {
    const ReadLock lock(impl_->mutex);
    return impl_->operators.time_s();
}

Document::EventCost Document::event_cost(uint64_t id) const {
    const ReadLock lock(impl_->mutex);
    const auto op = impl_->find_operator(id);
    if (!op) return {};
    const auto cost = impl_->operators.cost_of(id);
    return {operator_json(*op).size(), cost.parts, cost.bytes};
}

Document::Statistics Document::statistics() const {
    const ReadLock lock(impl_->mutex);
    Statistics s;
    s.height_pages = uint64_t(impl_->page_count.height);
    s.index_pages = uint64_t(impl_->page_count.index);
    s.database_bytes = impl_->pages->with_store([](PageStore& reader) { return reader.file_bytes(); });
    const auto nodes = impl_->nodes->counts();
    s.operators = impl_->operators.size() + nodes.operators;
    s.loaded_operators = impl_->operators.size() + nodes.loaded;
    s.operator_nodes = nodes.nodes;
    s.loaded_nodes = nodes.loaded_nodes;
    s.node_reads = nodes.reads;
    s.commands = impl_->heads.size();
    s.cached_pages = impl_->pages->cached_pages();
    s.cache_bytes = impl_->pages->cached_bytes();
    return s;
}

Result<uint64_t> Document::content_digest() const {
    const ReadLock lock(impl_->mutex);
    uint64_t digest = 0xcbf29ce484222325ull;
    const Status status = impl_->pages->with_store([&](PageStore& reader) -> Status {
        LOAM_TRY(reader.for_each_page([&](int64_t key, std::span<const uint8_t> blob) {
            digest = digest_of(digest_of(digest, uint64_t(key)), blob);
            return Status();
        }));
        return reader.for_each_operator([&](const PageStore::OperatorRow& row) {
            digest = digest_of(digest_of(digest, row.id),
                               {reinterpret_cast<const uint8_t*>(row.json.data()), row.json.size()});
            return Status();
        });
    });
    if (!status.ok()) return status.error();
    return digest;
}

}  // namespace loam
