// Operators that are read when somebody looks: a quad tree of nodes, each of which lists the operators of its
// square and coarseness in terrain.db. Only how many a node has is known from the start.
//
// Whoever composes asks for a rectangle at a step: texels see no decal less than half as wide, and of an
// operator that changes heights or layers a grid of samples sees nothing where none of its samples lies in
// the operator's bounds. Grids nest (all samples are at multiples of spacing * 2^k), so that every operator
// has a coarsest step at which it counts, and one that most small ones reach by chance only. A node of level
// L is 2^L m wide and has the operators that count up to steps of 2^(L-6) m and are at most so wide, whose
// bounds begin in it; so a page of any level looks at a few nodes of every level that counts for it, and at
// none of the small ones that its samples miss.
//
// What has a life must be there when its time comes, and events, stamps, cutouts and floods are few and made
// of more: the document holds these from its opening on (operator_set.h).
//
// Any thread may call; operators stay where they are until `trim` or a change.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "runtime/document/operator.h"
#include "runtime/document/operator_index.h"
#include "runtime/store/page_store.h"
#include "runtime/store/project.h"

namespace loam {

using OperatorNode = PageStore::OperatorNode;

// The grids that ask for heights and layers: of the finest level there may be, whatever `refine` is now;
// metres.
struct OperatorGrids {
    double height_m = 1, index_m = 1;
};
[[nodiscard]] OperatorGrids grids_of(const ProjectSettings& settings);

// None: the document holds it from its opening on.
[[nodiscard]] std::optional<OperatorNode> node_of(const Operator& op, const OperatorGrids& grids);

class OperatorNodes {
  public:
    // What a node has in terrain.db now, ready for a document; and where an operator is, none: nowhere.
    using Read = std::function<std::vector<Operator>(int64_t node)>;
    using Find = std::function<std::optional<int64_t>(uint64_t id)>;
    OperatorNodes(const OperatorGrids& grids, Read read, Find find)
        : grids_(grids), read_(std::move(read)), find_(std::move(find)) {}

    void add_counted(const OperatorNode& node, uint64_t operators);  // of what the database has at opening
    // Reads the node of an operator whose row is about to change.
    void wake(uint64_t id);
    void set(const Operator& op);  // that has a node, and whose row has been written
    void remove(uint64_t id);      // that was woken; unknown: fine
    [[nodiscard]] const Operator* find_loaded(uint64_t id) const;

    // As OperatorIndex::query, for texels or a grid of this step (0: all there are).
    void query_texture(const WorldRect& rect, double texel_m, std::vector<const Operator*>& out);
    void query_height(const WorldRect& rect, double step_m, std::vector<const Operator*>& out);
    void query_index(const WorldRect& rect, double step_m, std::vector<const Operator*>& out);
    void query_volumes(const WorldRect& rect, std::vector<const Operator*>& out);

    // Forgets nodes that nobody has asked for the longest, down to three quarters of so many operators.
    void trim(size_t most);

    struct Counts {
        uint64_t operators = 0, loaded = 0;
        uint64_t nodes = 0, loaded_nodes = 0;
        uint64_t reads = 0;  // of nodes, so far
    };
    [[nodiscard]] Counts counts() const;
    [[nodiscard]] size_t loaded() const { return loaded_count_; }
    // A shape of every kind and function there is, of which nothing else counts.
    [[nodiscard]] std::vector<OperatorShape> kinds() const;

  private:
    struct Node {
        uint64_t operators = 0;
        bool loaded = false;
        uint64_t used = 0;
        std::vector<uint64_t> ids;  // of what is loaded
    };
    struct Tier {  // of one kind and level
        std::unordered_map<int64_t, Node> nodes;
    };
    using TierKey = std::pair<int, int>;

    Node& node(int64_t key);
    void count(const OperatorNode& node, int64_t operators);
    void load(int64_t key, Node& node);
    void unload(Node& node);
    void insert(Node& node, const Operator& op);
    void erase(uint64_t id);
    template <typename Wanted>  // by kind, and the longest step or size of a level's
    void load_under(const WorldRect& rect, Wanted&& wanted);

    OperatorGrids grids_;
    Read read_;
    Find find_;
    mutable std::mutex mutex_;
    std::map<TierKey, Tier> tiers_;
    std::unordered_map<uint64_t, std::unique_ptr<Operator>> loaded_;
    std::map<std::pair<int, std::string>, uint64_t> functions_;  // operators by kind and function
    OperatorIndex height_, index_, texture_, volumes_;
    std::atomic<size_t> loaded_count_ = 0;
    uint64_t total_ = 0, clock_ = 0, reads_ = 0;
};

}  // namespace loam
