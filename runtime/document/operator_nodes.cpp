#include "runtime/document/operator_nodes.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/check.h"

namespace loam {

namespace {

// What a node's operators are; kGround: they change heights or layers.
enum Kind : int { kTerrain, kSpline, kVolume, kCrater, kFootprint, kSlide, kGround = 8 };

// A node's key: | bits 56–59 kind | 48–55 level | 24–47 y | 0–23 x |, the places with kZero added.
constexpr int64_t kZero = int64_t(1) << 23, kMask = (int64_t(1) << 24) - 1;
constexpr int kShare = 6;  // an operator counts up to steps of 2^-kShare of its node's side
constexpr int kFinest = 6, kCoarsest = 30;

int64_t cell_of(double position_m, int level) {
    return int64_t(std::clamp(std::floor(std::ldexp(position_m, -level)), double(-kZero), double(kZero - 1)));
}
int64_t key_of(int kind, int level, int64_t x, int64_t y) {
    return int64_t(kind) << 56 | int64_t(level) << 48 | (y + kZero) << 24 | (x + kZero);
}
int kind_in(int64_t key) {
    return int(key >> 56);
}
int level_in(int64_t key) {
    return int(key >> 48 & 255);
}
int64_t x_in(int64_t key) {
    return (key & kMask) - kZero;
}
int64_t y_in(int64_t key) {
    return (key >> 24 & kMask) - kZero;
}

// None of a node's operators is wider, is drawn wider or counts at longer steps.
double longest_m(int level) {
    return level == kCoarsest ? INFINITY : std::ldexp(1.0, level - kShare);
}

std::optional<int> kind_of(const OperatorShape& shape) {
    if (std::holds_alternative<TerrainDecal>(shape)) return kTerrain;
    if (std::holds_alternative<SplineDecal>(shape)) return kSpline;
    if (std::holds_alternative<VolumeDecal>(shape)) return kVolume;
    if (std::holds_alternative<Crater>(shape)) return kCrater;
    if (std::holds_alternative<Footprint>(shape)) return kFootprint;
    if (std::holds_alternative<Slide>(shape)) return kSlide;
    return std::nullopt;
}

// The longest spacing * 2^k of which a multiple lies in the rectangle both ways; 0: not even of the spacing.
double longest_step_m(const WorldRect& rect, double spacing_m) {
    // Grids reach a place by sums and spacings of their own (exact_spacing), and samples a little outside may
    // count (samples_in): shares of a step, and of the way there.
    constexpr double kSlack = 1e-5, kWaySlack = 1e-10, kLongest_m = 1 << 24;
    double longest_m = 0;
    for (double step_m = spacing_m; step_m <= kLongest_m; step_m *= 2) {
        const auto hit = [&](double low, double high) {
            const double first = low / step_m, last = high / step_m;
            return std::floor(last + kSlack + kWaySlack * std::abs(last)) >=
                   std::ceil(first - kSlack - kWaySlack * std::abs(first));
        };
        if (!hit(rect.min_x, rect.max_x) || !hit(rect.min_y, rect.max_y)) break;
        longest_m = step_m;
    }
    return longest_m;
}

}  // namespace

OperatorGrids grids_of(const ProjectSettings& settings) {
    constexpr int kMostRefine = 6;
    return {std::ldexp(settings.height_spacing_m, -kMostRefine), settings.index_spacing_m};
}

std::optional<OperatorNode> node_of(const Operator& op, const OperatorGrids& grids) {
    auto kind = kind_of(op.shape);
    if (!kind || op.part != 0 || !op.life.ever()) return std::nullopt;
    WorldRect bounds = op.texture_bounds();
    double longest_m = op.texture_size_m();  // a volume on its side is drawn wider than its bounds
    const auto add = [&](const WorldRect& rect) {
        *kind |= kGround;
        bounds = united(bounds, rect);
        for (const double spacing_m : {grids.height_m, grids.index_m})  // either may ask for heights
            longest_m = std::max(longest_m, longest_step_m(rect, spacing_m));
    };
    for (const WorldRect& rect : op.height_rects()) add(rect);
    for (const WorldRect& rect : op.index_rects()) add(rect);
    if (bounds.empty()) return std::nullopt;
    int exponent = 0;
    std::frexp(std::max({bounds.width(), bounds.height(), longest_m}), &exponent);
    const int level = std::clamp(exponent + kShare, kFinest, kCoarsest);
    const DecalMaterial* material = material_of(op.shape);
    return OperatorNode{key_of(*kind, level, cell_of(bounds.min_x, level), cell_of(bounds.min_y, level)),
                        material ? material->function : std::string()};
}

OperatorNodes::Node& OperatorNodes::node(int64_t key) {
    return tiers_[{kind_in(key), level_in(key)}].nodes[key];
}

void OperatorNodes::count(const OperatorNode& of, int64_t operators) {
    const TierKey tier{kind_in(of.key), level_in(of.key)};
    Node& changed = node(of.key);
    changed.operators += uint64_t(operators);
    total_ += uint64_t(operators);
    if (changed.operators == 0) {
        tiers_[tier].nodes.erase(of.key);
        if (tiers_[tier].nodes.empty()) tiers_.erase(tier);
    }
    const auto function = functions_.try_emplace({tier.first, of.function}).first;
    function->second += uint64_t(operators);
    if (function->second == 0) functions_.erase(function);
}

void OperatorNodes::add_counted(const OperatorNode& of, uint64_t operators) {
    const std::lock_guard lock(mutex_);
    count(of, int64_t(operators));
}

void OperatorNodes::insert(Node& to, const Operator& op) {
    auto& place = loaded_[op.id];
    LOAM_CHECK(!place, "an operator is in two nodes");
    place = std::make_unique<Operator>(op);
    to.ids.push_back(op.id);
    for (const WorldRect& rect : op.height_rects()) height_.add(place.get(), rect);
    for (const WorldRect& rect : op.index_rects()) index_.add(place.get(), rect);
    for (const WorldRect& rect : op.texture_rects()) texture_.add(place.get(), rect);
    if (std::holds_alternative<VolumeDecal>(op.shape)) volumes_.add(place.get(), op.texture_bounds());
    loaded_count_ = loaded_.size();
}

void OperatorNodes::erase(uint64_t id) {
    const auto found = loaded_.find(id);
    const Operator* op = found->second.get();
    for (const WorldRect& rect : op->height_rects()) height_.remove(op, rect);
    for (const WorldRect& rect : op->index_rects()) index_.remove(op, rect);
    for (const WorldRect& rect : op->texture_rects()) texture_.remove(op, rect);
    if (std::holds_alternative<VolumeDecal>(op->shape)) volumes_.remove(op, op->texture_bounds());
    loaded_.erase(found);
    loaded_count_ = loaded_.size();
}

void OperatorNodes::load(int64_t key, Node& to) {
    to.used = ++clock_;
    if (to.loaded) return;
    to.loaded = true;
    ++reads_;
    // A document that only reads may meet one that another program has moved meanwhile: it keeps what it had.
    for (const Operator& op : read_(key))
        if (!loaded_.contains(op.id)) insert(to, op);
}

void OperatorNodes::unload(Node& from) {
    for (const uint64_t id : from.ids) erase(id);
    from.ids.clear();
    from.loaded = false;
}

void OperatorNodes::wake(uint64_t id) {
    const std::lock_guard lock(mutex_);
    if (loaded_.contains(id)) return;
    const auto key = find_(id);
    if (key) load(*key, node(*key));
}

void OperatorNodes::set(const Operator& op) {
    const auto of = node_of(op, grids_);
    LOAM_CHECK(of, "an operator that the document holds was given to the nodes");
    const std::lock_guard lock(mutex_);
    count(*of, 1);
    Node& to = node(of->key);
    if (to.operators == 1) to.loaded = true;  // it is all there is
    to.used = ++clock_;
    if (to.loaded) insert(to, op);
}

void OperatorNodes::remove(uint64_t id) {
    const std::lock_guard lock(mutex_);
    const auto found = loaded_.find(id);
    if (found == loaded_.end()) return;
    const auto of = node_of(*found->second, grids_);
    std::erase(node(of->key).ids, id);
    erase(id);
    count(*of, -1);
}

const Operator* OperatorNodes::find_loaded(uint64_t id) const {
    const std::lock_guard lock(mutex_);
    const auto found = loaded_.find(id);
    return found == loaded_.end() ? nullptr : found->second.get();
}

template <typename Wanted>
void OperatorNodes::load_under(const WorldRect& rect, Wanted&& wanted) {
    for (auto& [tier, of] : tiers_) {
        const auto [kind, level] = tier;
        if (!wanted(kind, longest_m(level))) continue;
        // What begins in a cell before may reach in; of the coarsest level from anywhere.
        const double reach_m = level == kCoarsest ? kZero * std::ldexp(1.0, level) : longest_m(level);
        const int64_t x0 = cell_of(rect.min_x - reach_m, level), x1 = cell_of(rect.max_x, level);
        const int64_t y0 = cell_of(rect.min_y - reach_m, level), y1 = cell_of(rect.max_y, level);
        if (double(x1 - x0 + 1) * double(y1 - y0 + 1) > double(of.nodes.size())) {
            for (auto& [key, at] : of.nodes)
                if (x_in(key) >= x0 && x_in(key) <= x1 && y_in(key) >= y0 && y_in(key) <= y1) load(key, at);
            continue;
        }
        for (int64_t y = y0; y <= y1; ++y)
            for (int64_t x = x0; x <= x1; ++x)
                if (const auto at = of.nodes.find(key_of(kind, level, x, y)); at != of.nodes.end())
                    load(at->first, at->second);
    }
}

void OperatorNodes::query_texture(const WorldRect& rect, double texel_m, std::vector<const Operator*>& out) {
    out.clear();
    if (rect.empty()) return;
    const std::lock_guard lock(mutex_);
    load_under(rect, [&](int, double longest_m) { return 2 * longest_m > texel_m; });
    texture_.query(rect, out, texel_m);
}

void OperatorNodes::query_height(const WorldRect& rect, double step_m, std::vector<const Operator*>& out) {
    out.clear();
    if (rect.empty()) return;
    const std::lock_guard lock(mutex_);
    load_under(rect, [&](int kind, double longest_m) { return (kind & kGround) && longest_m >= step_m; });
    height_.query(rect, out);
}

void OperatorNodes::query_index(const WorldRect& rect, double step_m, std::vector<const Operator*>& out) {
    out.clear();
    if (rect.empty()) return;
    const std::lock_guard lock(mutex_);
    load_under(rect, [&](int kind, double longest_m) {
        return (kind == (kCrater | kGround) || kind == (kSlide | kGround)) && longest_m >= step_m;
    });
    index_.query(rect, out);
}

void OperatorNodes::query_volumes(const WorldRect& rect, std::vector<const Operator*>& out) {
    out.clear();
    if (rect.empty()) return;
    const std::lock_guard lock(mutex_);
    load_under(rect, [](int kind, double) { return kind == kVolume; });
    volumes_.query(rect, out);
}

void OperatorNodes::trim(size_t most) {
    const std::lock_guard lock(mutex_);
    if (loaded_.size() <= most) return;
    std::vector<Node*> oldest;
    for (auto& [tier, of] : tiers_)
        for (auto& [key, at] : of.nodes)
            if (at.loaded) oldest.push_back(&at);
    std::sort(oldest.begin(), oldest.end(), [](const Node* a, const Node* b) { return a->used < b->used; });
    for (Node* at : oldest) {
        if (loaded_.size() <= most / 4 * 3) break;
        unload(*at);
    }
}

OperatorNodes::Counts OperatorNodes::counts() const {
    const std::lock_guard lock(mutex_);
    Counts counts{.operators = total_, .loaded = loaded_.size(), .reads = reads_};
    for (const auto& [tier, of] : tiers_)
        for (const auto& [key, at] : of.nodes) {
            ++counts.nodes;
            counts.loaded_nodes += at.loaded;
        }
    return counts;
}

std::vector<OperatorShape> OperatorNodes::kinds() const {
    const std::lock_guard lock(mutex_);
    std::vector<OperatorShape> shapes;
    for (const auto& [kind, operators] : functions_) {
        DecalMaterial material;
        material.function = kind.second;
        switch (kind.first & ~kGround) {
            case kTerrain:
                shapes.push_back(TerrainDecal{.material = material});
                break;
            case kSpline:
                shapes.push_back(SplineDecal{.material = material});
                break;
            case kVolume:
                shapes.push_back(VolumeDecal{.material = material});
                break;
            case kCrater:
                shapes.push_back(Crater{});
                break;
            case kFootprint:
                shapes.push_back(Footprint{});
        }
    }
    return shapes;
}

}  // namespace loam
