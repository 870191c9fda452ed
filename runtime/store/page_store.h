// terrain.db: base pages as blobs, operators as JSON, the command journal. What the blobs and texts mean is
// the document's business; this file knows rows.
//
// | table | columns |
// | --- | --- |
// | page | key INTEGER PRIMARY KEY (PageKey), blob |
// | operator | id INTEGER PRIMARY KEY, json, node (NULL: none), function |
// | journal | sequence INTEGER PRIMARY KEY, grp, applied (0 or 1), json, images, dirt |
// | meta | name TEXT PRIMARY KEY, value (an integer) |
//
// PageKey, packed: | bits 52–57 map | 46–51 mip | 23–45 y | 0–22 x |
//
// `node` and `function` let the document read operators a few at a time (document/operator_nodes.h). Format 1
// had neither: its database is given them when it is opened for writing, and read as if all were NULL when it
// is not.
//
// WAL with synchronous = NORMAL: a killed process loses nothing that was committed; a power cut may lose the
// last commits but never leaves half of one. Foreign keys are off, as there are none. A connection is used by
// one thread at a time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/store/sqlite.h"

namespace loam {

enum class BaseMap : uint8_t { height = 0, index = 1 };

struct PageKey {
    BaseMap map = BaseMap::height;
    int mip = 0, x = 0, y = 0;  // in pages of that mip
    [[nodiscard]] int64_t packed() const {
        return int64_t(map) << 52 | int64_t(mip) << 46 | int64_t(y) << 23 | int64_t(x);
    }
    [[nodiscard]] static PageKey unpacked(int64_t key) {
        return {BaseMap(key >> 52 & 63), int(key >> 46 & 63), int(key & 0x7fffff), int(key >> 23 & 0x7fffff)};
    }
    bool operator==(const PageKey&) const = default;
};

struct JournalRow {
    uint64_t sequence = 0, group = 0;
    bool applied = true;
    std::string json;
    std::vector<uint8_t> images;  // what the command replaced (applied) or what redo will put back (undone)
    std::vector<uint8_t> dirt;
};

class PageStore {
  public:
    static Result<PageStore> open(const std::filesystem::path& file, DatabaseMode mode);
    PageStore() = default;

    // A transaction of several writes. Without one every write is its own.
    Status begin();
    Status commit();  // on an error the transaction is rolled back
    void rollback();
    Status begin_reading();  // from now on this connection sees one state; ends with the connection

    Result<std::optional<std::vector<uint8_t>>> read_page(int64_t key);
    Status write_page(int64_t key, std::span<const uint8_t> blob);
    Status erase_page(int64_t key);  // absent already: fine
    // In ascending order of keys; the visitor's error ends the walk.
    Status for_each_page(const std::function<Status(int64_t key, std::span<const uint8_t> blob)>& visit);
    Result<int64_t> page_count(BaseMap map);

    // Where an operator is found again that is not read at opening, and the function that it shows.
    struct OperatorNode {
        int64_t key = 0;
        std::string function;
        bool operator==(const OperatorNode&) const = default;
    };
    struct OperatorRow {
        uint64_t id = 0;
        std::string json;
        std::optional<int64_t> node;
    };
    using OperatorVisit = std::function<Status(const OperatorRow&)>;
    Result<std::optional<OperatorRow>> read_operator(uint64_t id);
    Status write_operator(uint64_t id, std::string_view json, const std::optional<OperatorNode>& node);
    Status erase_operator(uint64_t id);
    Status for_each_operator(const OperatorVisit& visit);  // ascending, as all of these
    Status for_each_operator_without_node(const OperatorVisit& visit);
    Status for_each_operator_of_node(int64_t node, const OperatorVisit& visit);
    Status for_each_operator_of_function(const std::string& function, const OperatorVisit& visit);
    // How many operators of a function a node has.
    Status for_each_node(const std::function<Status(const OperatorNode& node, uint64_t operators)>& visit);

    Status write_journal(const JournalRow& row);  // inserts or replaces
    Result<JournalRow> read_journal(uint64_t sequence);
    Status erase_undone();
    struct JournalHead {
        uint64_t sequence = 0, group = 0;
        bool applied = true;
    };
    Result<std::vector<JournalHead>> journal_heads();  // ascending
    // Ascending from `first`; images and dirt only if asked for, as they are large.
    enum class JournalColumns { text, all };
    Status for_each_journal(uint64_t first, JournalColumns columns,
                            const std::function<Status(const JournalRow&)>& visit);

    Result<std::optional<int64_t>> read_meta(std::string_view name);
    Status write_meta(std::string_view name, int64_t value);

    Status checkpoint();  // moves the WAL into the database and empties it
    // Moves the WAL into the database when it has grown to 16 MB: call it where waiting for the disk hurts
    // nobody.
    Status checkpoint_when_due();
    Result<std::vector<std::string>> quick_check();  // SQLite's own complaints; none: sound
    [[nodiscard]] uint64_t file_bytes() const;       // database and WAL

  private:
    Status prepare_all(bool writes_operators);

    Database database_;
    bool in_transaction_ = false;
    Statement begin_, commit_, rollback_;
    Statement read_page_, write_page_, erase_page_, read_operator_, read_node_, write_operator_,
        erase_operator_;
    Statement write_journal_, read_journal_, erase_undone_, read_meta_, write_meta_;
};

}  // namespace loam
