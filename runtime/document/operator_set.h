// The document's operators: by id, and what of them is shown now, by place for each map.
//
// An operator without a life is shown as it is. One with a life is shown in the state of the time, and of an
// event the parts are, each in its own. Moving the time looks only at those whose state ends.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <unordered_map>
#include <vector>

#include "runtime/document/operator.h"
#include "runtime/document/operator_index.h"

namespace loam {

struct Dirt;

class OperatorSet {
  public:
    OperatorSet();
    ~OperatorSet();
    void set(const Operator& op);  // adds or replaces
    void remove(uint64_t id);      // unknown: fine
    [[nodiscard]] const Operator* find(uint64_t id) const;
    [[nodiscard]] size_t size() const { return by_id_.size(); }
    [[nodiscard]] std::vector<Operator> sorted() const;  // ascending (order, id)
    [[nodiscard]] std::vector<Operator> timed() const;   // those that change with the time, the same way

    // Whether the map shows the heat of craters (it has a channel for it): else one that cools changes
    // nothing.
    void set_shows_heat(bool shows) { shows_heat_ = shows; }

    [[nodiscard]] double time_s() const { return time_s_; }
    // What is shown otherwise from now on is appended to the dirt.
    void set_time(double time_s, Dirt& dirt);
    // Appends where an operator is shown now; unknown or hidden: nothing.
    void add_shown(uint64_t id, Dirt& dirt) const;

    [[nodiscard]] const OperatorIndex& over_height() const { return height_; }
    [[nodiscard]] const OperatorIndex& over_index() const { return index_; }
    [[nodiscard]] const OperatorIndex& over_texture() const { return texture_; }
    [[nodiscard]] const OperatorIndex& over_cutout() const { return cutout_; }
    // Of those over the texture the ones that look at the ground: volumes and floods. A change of heights
    // reaches far in coarse pages, and asks for these alone.
    [[nodiscard]] const OperatorIndex& over_ground() const { return ground_; }

    // Prints whose life ends some day, the oldest first.
    [[nodiscard]] const std::set<uint64_t>& passing_prints() const { return passing_prints_; }

    struct Cost {
        size_t parts = 0;  // of events, at any time
        size_t bytes = 0;  // of everything kept for operators with a life and for parts
    };
    [[nodiscard]] Cost cost_of(uint64_t id) const;

  private:
    struct Shown;  // an operator or part that changes with the time
    struct Held;
    using Moments = std::multimap<double, Shown*>;

    void show(Shown& shown);
    void hide(Shown& shown);
    void index(const Operator& op);
    void unindex(const Operator& op);

    std::unordered_map<uint64_t, std::unique_ptr<Held>> by_id_;  // pointers stay valid while the map grows
    OperatorIndex height_, index_, texture_, cutout_, ground_;
    std::set<uint64_t> passing_prints_;
    double time_s_ = 0;
    bool shows_heat_ = false;
    Moments by_since_, by_until_;  // of the states shown now, without those that have no beginning or end
};

}  // namespace loam
