// A thin wrapper of SQLite: handles that close themselves, and error codes turned into sentences.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"

struct sqlite3;
struct sqlite3_stmt;

namespace loam {

class Statement {
  public:
    Statement() = default;
    // Positional parameters, from 1. Bound memory must live until the next reset.
    void bind(int parameter, int64_t value);
    void bind(int parameter, double value);
    void bind(int parameter, std::string_view text);
    void bind(int parameter, std::span<const uint8_t> blob);
    void bind_null(int parameter);
    // True: a row is ready to be read. False: done. Call reset() before binding again.
    Result<bool> step();
    void reset();
    // Binds nothing more, runs to the end and resets.
    Status run();

    [[nodiscard]] bool is_null(int column) const;
    [[nodiscard]] int64_t integer(int column) const;  // NULL: 0
    [[nodiscard]] double real(int column) const;
    [[nodiscard]] std::string text(int column) const;
    [[nodiscard]] std::span<const uint8_t> blob(int column) const;  // valid until the next step or reset

  private:
    friend class Database;
    struct Finalize {
        void operator()(sqlite3_stmt* statement) const;
    };
    std::unique_ptr<sqlite3_stmt, Finalize> handle_;
    std::string place_;  // the database's file, for messages
};

enum class DatabaseMode { read_only, read_write, create };

class Database {
  public:
    static Result<Database> open(const std::filesystem::path& file, DatabaseMode mode);
    Database() = default;

    Status execute(const char* sql);
    Result<Statement> prepare(std::string_view sql);
    Result<int64_t> query_integer(std::string_view sql);
    [[nodiscard]] const std::filesystem::path& file() const { return file_; }
    // Frames in the write-ahead log after this connection's last commit. Turns SQLite's own checkpoints off
    // when called first.
    void count_wal_frames();
    [[nodiscard]] int wal_frames() const { return wal_frames_ ? *wal_frames_ : 0; }

  private:
    struct Close {
        void operator()(sqlite3* database) const;
    };
    std::unique_ptr<int> wal_frames_;  // on the heap, where SQLite's hook finds it after a move
    std::unique_ptr<sqlite3, Close> handle_;
    std::filesystem::path file_;
};

}  // namespace loam
