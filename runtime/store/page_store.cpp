#include "runtime/store/page_store.h"

#include <limits>
#include <utility>

#include "runtime/base/check.h"

namespace loam {

namespace {

constexpr int64_t kApplicationId = 0x4C6F616D;  // "Loam"
constexpr int64_t kVersion = 2, kVersionWithoutNodes = 1;

// 8 KiB pages: most blobs (1–6 KiB) fit one without an overflow chain, and a small command rewrites few of
// them.
constexpr const char* kSetUp = R"(
PRAGMA page_size = 8192;
PRAGMA journal_mode = WAL;
PRAGMA application_id = 0x4C6F616D;
BEGIN IMMEDIATE;
CREATE TABLE page (key INTEGER PRIMARY KEY, blob BLOB NOT NULL);
CREATE TABLE operator (id INTEGER PRIMARY KEY, json TEXT NOT NULL, node INTEGER, function TEXT);
CREATE INDEX operator_node ON operator (node, function);
CREATE TABLE journal (sequence INTEGER PRIMARY KEY, grp INTEGER NOT NULL, applied INTEGER NOT NULL,
                      json TEXT NOT NULL, images BLOB NOT NULL, dirt BLOB NOT NULL);
CREATE TABLE meta (name TEXT PRIMARY KEY, value INTEGER NOT NULL) WITHOUT ROWID;
PRAGMA user_version = 2;
COMMIT;
)";

constexpr const char* kGiveNodes = R"(
BEGIN IMMEDIATE;
ALTER TABLE operator ADD COLUMN node INTEGER;
ALTER TABLE operator ADD COLUMN function TEXT;
CREATE INDEX operator_node ON operator (node, function);
PRAGMA user_version = 2;
COMMIT;
)";

// The same to the eye of a connection that may not write.
constexpr const char* kShowNoNodes = R"(
CREATE TEMP VIEW operator AS SELECT id, json, NULL AS node, NULL AS function FROM main.operator;
)";

constexpr const char* kConfigure = R"(
PRAGMA synchronous = NORMAL;
PRAGMA foreign_keys = OFF;
PRAGMA trusted_schema = OFF;
PRAGMA cell_size_check = ON;
PRAGMA journal_size_limit = 67108864;
PRAGMA cache_size = -16384;
)";

// Of 8 KiB: 16 MB of log. Checkpoints are the only time that writing waits for the disk, about 50 ms.
constexpr int kDueFrames = 2000;

// The database's format.
Result<int64_t> check_identity(Database& database) {
    const auto application = database.query_integer("PRAGMA application_id");
    if (!application.ok()) return application.error();
    if (*application != kApplicationId)
        return error("{} is not a terrain database: it is a SQLite file of another program",
                     database.file().string());
    const auto version = database.query_integer("PRAGMA user_version");
    if (!version.ok()) return version.error();
    if (*version > kVersion)
        return error("{} was written by a newer Loam (format {}, this one reads up to {}); update Loam",
                     database.file().string(), *version, kVersion);
    if (*version != kVersion && *version != kVersionWithoutNodes)
        return error("{} has the unknown format {}, {} expected", database.file().string(), *version,
                     kVersion);
    return *version;
}

// Walks the rows of a statement of its own.
template <typename... Parameters>
Status for_each_row(Database& database, std::string_view sql, const std::function<Status(Statement&)>& visit,
                    const Parameters&... parameters) {
    auto statement = database.prepare(sql);
    if (!statement.ok()) return statement.error();
    int parameter = 0;
    (statement->bind(++parameter, parameters), ...);
    while (true) {
        const auto row = statement->step();
        if (!row.ok()) return row.error();
        if (!*row) return {};
        LOAM_TRY(visit(*statement));
    }
}

// Resets on every way out of a function that reads a row.
struct ResetOnExit {
    Statement& statement;
    ~ResetOnExit() { statement.reset(); }
};

}  // namespace

Result<PageStore> PageStore::open(const std::filesystem::path& file, DatabaseMode mode) {
    auto database = Database::open(file, mode);
    if (!database.ok()) return database.error();
    PageStore store;
    store.database_ = std::move(database).value();
    if (mode == DatabaseMode::create) LOAM_TRY(store.database_.execute(kSetUp));
    const auto version = check_identity(store.database_);
    if (!version.ok()) return version.error();
    LOAM_TRY(store.database_.execute(kConfigure));
    const bool without_nodes = *version == kVersionWithoutNodes, reads = mode == DatabaseMode::read_only;
    if (without_nodes) LOAM_TRY(store.database_.execute(reads ? kShowNoNodes : kGiveNodes));
    LOAM_TRY(store.prepare_all(!(without_nodes && reads)));  // a view cannot be written
    store.database_.count_wal_frames();
    return store;
}

Status PageStore::prepare_all(bool writes_operators) {
    const std::pair<Statement*, const char*> all[] = {
        {&begin_, "BEGIN IMMEDIATE"},
        {&commit_, "COMMIT"},
        {&rollback_, "ROLLBACK"},
        {&read_page_, "SELECT blob FROM page WHERE key = ?"},
        {&write_page_, "INSERT INTO page VALUES (?, ?) ON CONFLICT (key) DO UPDATE SET blob = excluded.blob"},
        {&erase_page_, "DELETE FROM page WHERE key = ?"},
        {&read_operator_, "SELECT id, json, node FROM operator WHERE id = ?"},
        {&read_node_, "SELECT id, json, node FROM operator WHERE node = ? ORDER BY id"},
        {writes_operators ? &write_operator_ : nullptr,
         "INSERT INTO operator VALUES (?, ?, ?, ?) ON CONFLICT (id) DO UPDATE SET json = excluded.json, "
         "node = excluded.node, function = excluded.function"},
        {writes_operators ? &erase_operator_ : nullptr, "DELETE FROM operator WHERE id = ?"},
        {&write_journal_, "INSERT OR REPLACE INTO journal VALUES (?, ?, ?, ?, ?, ?)"},
        {&read_journal_, "SELECT grp, applied, json, images, dirt FROM journal WHERE sequence = ?"},
        {&erase_undone_, "DELETE FROM journal WHERE applied = 0"},
        {&read_meta_, "SELECT value FROM meta WHERE name = ?"},
        {&write_meta_,
         "INSERT INTO meta VALUES (?, ?) ON CONFLICT (name) DO UPDATE SET value = excluded.value"},
    };
    for (const auto& [statement, sql] : all) {
        if (!statement) continue;
        auto prepared = database_.prepare(sql);
        if (!prepared.ok()) return prepared.error();
        *statement = std::move(prepared).value();
    }
    return {};
}

Status PageStore::begin() {
    LOAM_CHECK(!in_transaction_, "a transaction in a transaction");
    LOAM_TRY(begin_.run());
    in_transaction_ = true;
    return {};
}

Status PageStore::commit() {
    LOAM_CHECK(in_transaction_, "commit without begin");
    const Status status = commit_.run();
    if (!status.ok()) {
        rollback();
        return status;
    }
    in_transaction_ = false;
    return {};
}

void PageStore::rollback() {
    if (!in_transaction_) return;
    in_transaction_ = false;
    // Fails where SQLite has rolled back by itself already (disk full, I/O error), which is as good.
    (void)rollback_.run();
}

Status PageStore::begin_reading() {
    return database_.execute("BEGIN");
}

Result<std::optional<std::vector<uint8_t>>> PageStore::read_page(int64_t key) {
    const ResetOnExit reset{read_page_};
    read_page_.bind(1, key);
    const auto row = read_page_.step();
    if (!row.ok()) return row.error();
    if (!*row) return std::optional<std::vector<uint8_t>>();
    const auto blob = read_page_.blob(0);
    return std::optional(std::vector<uint8_t>(blob.begin(), blob.end()));
}

Status PageStore::write_page(int64_t key, std::span<const uint8_t> blob) {
    write_page_.bind(1, key);
    write_page_.bind(2, blob);
    return write_page_.run();
}

Status PageStore::erase_page(int64_t key) {
    erase_page_.bind(1, key);
    return erase_page_.run();
}

Status PageStore::for_each_page(const std::function<Status(int64_t, std::span<const uint8_t>)>& visit) {
    return for_each_row(database_, "SELECT key, blob FROM page ORDER BY key",
                        [&](Statement& row) { return visit(row.integer(0), row.blob(1)); });
}

Result<int64_t> PageStore::page_count(BaseMap map) {
    const PageKey first{map, 0, 0, 0}, end{BaseMap(int(map) + 1), 0, 0, 0};
    return database_.query_integer(
        fmt::format("SELECT count(*) FROM page WHERE key >= {} AND key < {}", first.packed(), end.packed()));
}

namespace {

PageStore::OperatorRow operator_row(const Statement& row) {
    PageStore::OperatorRow result{uint64_t(row.integer(0)), row.text(1), std::nullopt};
    if (!row.is_null(2)) result.node = row.integer(2);
    return result;
}

}  // namespace

Result<std::optional<PageStore::OperatorRow>> PageStore::read_operator(uint64_t id) {
    const ResetOnExit reset{read_operator_};
    read_operator_.bind(1, int64_t(id));
    const auto row = read_operator_.step();
    if (!row.ok()) return row.error();
    if (!*row) return std::optional<OperatorRow>();
    return std::optional(operator_row(read_operator_));
}

Status PageStore::write_operator(uint64_t id, std::string_view json,
                                 const std::optional<OperatorNode>& node) {
    write_operator_.bind(1, int64_t(id));
    write_operator_.bind(2, json);
    if (node) {
        write_operator_.bind(3, node->key);
        write_operator_.bind(4, std::string_view(node->function));
    } else {
        write_operator_.bind_null(3);
        write_operator_.bind_null(4);
    }
    return write_operator_.run();
}

Status PageStore::erase_operator(uint64_t id) {
    erase_operator_.bind(1, int64_t(id));
    return erase_operator_.run();
}

Status PageStore::for_each_operator(const OperatorVisit& visit) {
    return for_each_row(database_, "SELECT id, json, node FROM operator ORDER BY id",
                        [&](Statement& row) { return visit(operator_row(row)); });
}

Status PageStore::for_each_operator_without_node(const OperatorVisit& visit) {
    return for_each_row(database_, "SELECT id, json, node FROM operator WHERE node IS NULL ORDER BY id",
                        [&](Statement& row) { return visit(operator_row(row)); });
}

Status PageStore::for_each_operator_of_node(int64_t node, const OperatorVisit& visit) {
    const ResetOnExit reset{read_node_};
    read_node_.bind(1, node);
    while (true) {
        const auto row = read_node_.step();
        if (!row.ok()) return row.error();
        if (!*row) return {};
        LOAM_TRY(visit(operator_row(read_node_)));
    }
}

Status PageStore::for_each_operator_of_function(const std::string& function, const OperatorVisit& visit) {
    return for_each_row(
        database_, "SELECT id, json, node FROM operator WHERE node IS NOT NULL AND function = ? ORDER BY id",
        [&](Statement& row) { return visit(operator_row(row)); }, std::string_view(function));
}

Status PageStore::for_each_node(const std::function<Status(const OperatorNode&, uint64_t)>& visit) {
    return for_each_row(database_,
                        "SELECT node, function, count(*) FROM operator WHERE node IS NOT NULL "
                        "GROUP BY node, function",
                        [&](Statement& row) {
                            return visit({row.integer(0), row.text(1)}, uint64_t(row.integer(2)));
                        });
}

Status PageStore::write_journal(const JournalRow& row) {
    write_journal_.bind(1, int64_t(row.sequence));
    write_journal_.bind(2, int64_t(row.group));
    write_journal_.bind(3, int64_t(row.applied));
    write_journal_.bind(4, std::string_view(row.json));
    write_journal_.bind(5, std::span<const uint8_t>(row.images));
    write_journal_.bind(6, std::span<const uint8_t>(row.dirt));
    return write_journal_.run();
}

Result<JournalRow> PageStore::read_journal(uint64_t sequence) {
    const ResetOnExit reset{read_journal_};
    read_journal_.bind(1, int64_t(sequence));
    const auto row = read_journal_.step();
    if (!row.ok()) return row.error();
    if (!*row) return error("{}: command {} is missing in the journal", database_.file().string(), sequence);
    JournalRow result{.sequence = sequence,
                      .group = uint64_t(read_journal_.integer(0)),
                      .applied = read_journal_.integer(1) != 0,
                      .json = read_journal_.text(2),
                      .images = {},
                      .dirt = {}};
    const auto images = read_journal_.blob(3);
    result.images.assign(images.begin(), images.end());
    const auto dirt = read_journal_.blob(4);
    result.dirt.assign(dirt.begin(), dirt.end());
    return result;
}

Status PageStore::erase_undone() {
    return erase_undone_.run();
}

Result<std::vector<PageStore::JournalHead>> PageStore::journal_heads() {
    std::vector<JournalHead> heads;
    const Status status = for_each_row(
        database_, "SELECT sequence, grp, applied FROM journal ORDER BY sequence", [&](Statement& row) {
            heads.push_back({uint64_t(row.integer(0)), uint64_t(row.integer(1)), row.integer(2) != 0});
            return Status();
        });
    if (!status.ok()) return status.error();
    return heads;
}

Status PageStore::for_each_journal(uint64_t first, JournalColumns columns,
                                   const std::function<Status(const JournalRow&)>& visit) {
    const bool all = columns == JournalColumns::all;
    const char* sql =
        all ? "SELECT sequence, grp, applied, json, images, dirt FROM journal WHERE sequence >= ? ORDER BY "
              "sequence"
            : "SELECT sequence, grp, applied, json FROM journal WHERE sequence >= ? ORDER BY sequence";
    return for_each_row(
        database_, sql,
        [&](Statement& from) {
            JournalRow row{.sequence = uint64_t(from.integer(0)),
                           .group = uint64_t(from.integer(1)),
                           .applied = from.integer(2) != 0,
                           .json = from.text(3),
                           .images = {},
                           .dirt = {}};
            if (all) {
                const auto images = from.blob(4), dirt = from.blob(5);
                row.images.assign(images.begin(), images.end());
                row.dirt.assign(dirt.begin(), dirt.end());
            }
            return visit(row);
        },
        int64_t(first));
}

Result<std::optional<int64_t>> PageStore::read_meta(std::string_view name) {
    const ResetOnExit reset{read_meta_};
    read_meta_.bind(1, name);
    const auto row = read_meta_.step();
    if (!row.ok()) return row.error();
    if (!*row) return std::optional<int64_t>();
    return std::optional(read_meta_.integer(0));
}

Status PageStore::write_meta(std::string_view name, int64_t value) {
    write_meta_.bind(1, name);
    write_meta_.bind(2, value);
    return write_meta_.run();
}

Status PageStore::checkpoint() {
    return database_.execute("PRAGMA wal_checkpoint(TRUNCATE)");
}

Status PageStore::checkpoint_when_due() {
    if (database_.wal_frames() < kDueFrames) return {};
    return database_.execute("PRAGMA wal_checkpoint(PASSIVE)");
}

Result<std::vector<std::string>> PageStore::quick_check() {
    std::vector<std::string> faults;
    const Status status = for_each_row(database_, "PRAGMA quick_check", [&](Statement& row) {
        if (row.text(0) != "ok") faults.push_back(row.text(0));
        return Status();
    });
    if (!status.ok()) return status.error();
    return faults;
}

uint64_t PageStore::file_bytes() const {
    uint64_t bytes = 0;
    for (const char* suffix : {"", "-wal"}) {
        std::error_code failure;
        const auto size = std::filesystem::file_size(database_.file().string() + suffix, failure);
        if (!failure) bytes += size;
    }
    return bytes;
}

}  // namespace loam
