#include "runtime/store/sqlite.h"

#include <array>
#include <cstring>
#include <fstream>

#include <sqlite3.h>
#include <unistd.h>

#include "runtime/base/check.h"

namespace loam {

namespace {

Error sentence(sqlite3* database, int code, std::string_view place) {
    switch (code & 0xff) {
        case SQLITE_FULL:
            return error("the disk is full while writing {}; nothing of this step was kept", place);
        case SQLITE_BUSY:
        case SQLITE_LOCKED:
            return error("{} is locked by another program that writes it; close that one first", place);
        case SQLITE_READONLY:
            return error("{} cannot be written: the file or its folder is read-only", place);
        case SQLITE_NOTADB:
            return error("{} is not a terrain database", place);
        case SQLITE_CORRUPT:
            return error("{} is damaged: {}", place, sqlite3_errmsg(database));
        case SQLITE_CANTOPEN:
            return error("cannot open {}: {}", place, std::strerror(sqlite3_system_errno(database)));
        case SQLITE_IOERR:
            return error("cannot read or write {}: {} ({})", place, sqlite3_errmsg(database),
                         std::strerror(sqlite3_system_errno(database)));
        default:
            return error("{}: {}", place, sqlite3_errmsg(database));
    }
}

// SQLite takes an empty file for a new database and says little about others: look first.
Status check_file_header(const std::filesystem::path& file) {
    std::error_code failure;
    if (!std::filesystem::exists(file, failure)) return error("{} is missing", file.string());
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return error("cannot open {}: {}", file.string(), std::strerror(errno));
    std::array<char, 16> head{};
    stream.read(head.data(), head.size());
    if (stream.gcount() == 0) return error("{} is empty; it is not a terrain database", file.string());
    if (std::memcmp(head.data(), "SQLite format 3", 16) == 0) return {};
    if (head == std::array<char, 16>{})
        return error("{} begins with zeros; it is not a terrain database", file.string());
    return error("{} is not a terrain database", file.string());
}

std::string uri_of(const std::filesystem::path& file, const char* query) {
    std::string uri = "file:";
    for (const char c : std::filesystem::absolute(file).string()) {
        if (c == '?' || c == '#' || c == '%')
            uri += fmt::format("%{:02x}", uint8_t(c));
        else
            uri += c;
    }
    return uri + query;
}

}  // namespace

void Statement::Finalize::operator()(sqlite3_stmt* statement) const {
    sqlite3_finalize(statement);
}
void Statement::bind(int parameter, int64_t value) {
    LOAM_CHECK(sqlite3_bind_int64(handle_.get(), parameter, value) == SQLITE_OK,
               "bad parameter of a statement");
}
void Statement::bind(int parameter, double value) {
    LOAM_CHECK(sqlite3_bind_double(handle_.get(), parameter, value) == SQLITE_OK,
               "bad parameter of a statement");
}
void Statement::bind(int parameter, std::string_view text) {
    LOAM_CHECK(sqlite3_bind_text64(handle_.get(), parameter, text.data(), text.size(), SQLITE_STATIC,
                                   SQLITE_UTF8) == SQLITE_OK,
               "bad parameter of a statement");
}
void Statement::bind(int parameter, std::span<const uint8_t> blob) {
    // A null pointer would bind NULL instead of an empty blob.
    const void* data = blob.empty() ? static_cast<const void*>("") : blob.data();
    LOAM_CHECK(sqlite3_bind_blob64(handle_.get(), parameter, data, blob.size(), SQLITE_STATIC) == SQLITE_OK,
               "bad parameter of a statement");
}

void Statement::bind_null(int parameter) {
    LOAM_CHECK(sqlite3_bind_null(handle_.get(), parameter) == SQLITE_OK, "bad parameter of a statement");
}

Result<bool> Statement::step() {
    const int code = sqlite3_step(handle_.get());
    if (code == SQLITE_ROW) return true;
    if (code == SQLITE_DONE) return false;
    return sentence(sqlite3_db_handle(handle_.get()), code, place_);
}

void Statement::reset() {
    sqlite3_reset(handle_.get());
}

Status Statement::run() {
    Status status;
    while (true) {
        const auto row = step();
        if (!row.ok()) status = row.error();
        if (!row.ok() || !*row) break;
    }
    reset();
    return status;
}

bool Statement::is_null(int column) const {
    return sqlite3_column_type(handle_.get(), column) == SQLITE_NULL;
}
int64_t Statement::integer(int column) const {
    return sqlite3_column_int64(handle_.get(), column);
}
double Statement::real(int column) const {
    return sqlite3_column_double(handle_.get(), column);
}
std::string Statement::text(int column) const {
    const auto* data = reinterpret_cast<const char*>(sqlite3_column_text(handle_.get(), column));
    return data ? std::string(data, size_t(sqlite3_column_bytes(handle_.get(), column))) : std::string();
}
std::span<const uint8_t> Statement::blob(int column) const {
    const auto* data = static_cast<const uint8_t*>(sqlite3_column_blob(handle_.get(), column));
    return data ? std::span(data, size_t(sqlite3_column_bytes(handle_.get(), column)))
                : std::span<const uint8_t>();
}

void Database::Close::operator()(sqlite3* database) const {
    sqlite3_close_v2(database);
}

Result<Database> Database::open(const std::filesystem::path& file, DatabaseMode mode) {
    if (mode != DatabaseMode::create) LOAM_TRY(check_file_header(file));
    int flags = SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE | SQLITE_OPEN_URI;
    flags |= mode == DatabaseMode::read_only ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE;
    if (mode == DatabaseMode::create) flags |= SQLITE_OPEN_CREATE;
    // A database in WAL mode needs its -shm file beside it; where none can be made, nobody can write either.
    const std::string parent = std::filesystem::absolute(file).parent_path().string();
    const bool frozen = mode == DatabaseMode::read_only && access(parent.c_str(), W_OK) != 0;

    Database database;
    database.file_ = file;
    sqlite3* handle = nullptr;
    const int code =
        sqlite3_open_v2(uri_of(file, frozen ? "?immutable=1" : "").c_str(), &handle, flags, nullptr);
    database.handle_.reset(handle);
    if (code != SQLITE_OK) return sentence(handle, code, file.string());
    sqlite3_busy_timeout(handle, 2000);
    return database;
}

void Database::count_wal_frames() {
    wal_frames_ = std::make_unique<int>(0);
    const auto hook = [](void* count, sqlite3*, const char*, int frames) {
        *static_cast<int*>(count) = frames;
        return SQLITE_OK;
    };
    sqlite3_wal_hook(handle_.get(), hook, wal_frames_.get());
}

Status Database::execute(const char* sql) {
    const int code = sqlite3_exec(handle_.get(), sql, nullptr, nullptr, nullptr);
    if (code != SQLITE_OK) return sentence(handle_.get(), code, file_.string());
    return {};
}

Result<Statement> Database::prepare(std::string_view sql) {
    sqlite3_stmt* handle = nullptr;
    const int code = sqlite3_prepare_v3(handle_.get(), sql.data(), int(sql.size()), SQLITE_PREPARE_PERSISTENT,
                                        &handle, nullptr);
    if (code != SQLITE_OK) return sentence(handle_.get(), code, file_.string());
    Statement statement;
    statement.handle_.reset(handle);
    statement.place_ = file_.string();
    return statement;
}

Result<int64_t> Database::query_integer(std::string_view sql) {
    auto statement = prepare(sql);
    if (!statement.ok()) return statement.error();
    const auto row = statement->step();
    if (!row.ok()) return row.error();
    if (!*row) return error("{}: no answer to {}", file_.string(), sql);
    return statement->integer(0);
}

}  // namespace loam
