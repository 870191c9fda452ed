#include "runtime/texture/composer.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/check.h"
#include "runtime/document/document.h"
#include "runtime/texture/distortion.h"
#include "shaders/texture/tile_hiding.h"
#include "shaders/texture/vista.h"

namespace loam {

namespace {

using gpu::Access;

static_assert(kIndexPageBorder == kIndexBorder && 1 << kIndexPageLog2 == kIndexPayload &&
              kIndexPageTexels == kIndexTexels);

constexpr int kBlockTexels = 4;

// Blocks across one mip of a rectangle.
glm::ivec2 blocks_across(const TexelRect& rect, int mip) {
    return glm::ivec2(rect.width(), rect.height()) / (kBlockTexels << mip);
}

// Of both mips of one texture.
uint32_t block_count(const TexelRect& rect) {
    uint32_t blocks = 0;
    for (int mip = 0; mip < 2; ++mip)
        blocks += uint32_t(blocks_across(rect, mip).x * blocks_across(rect, mip).y);
    return blocks;
}

// The texel of the page textures that a rectangle begins at.
glm::ivec2 target_of(const ComposeJob& job) {
    return job.target * kPageTexels + glm::ivec2(job.rect.x0, job.rect.y0);
}

constexpr uint32_t kPageTextureSlot = 4;                               // of mip_rgba8.comp
constexpr int kOneLayerKind = 1, kTransitionKind = 2, kFarKind = 4;    // bits of a square's kind

// Of a place in something that repeats every period_m: 0 … 1.
float phase(double at_m, double period_m) {
    const double repeats = at_m / period_m;
    return float(repeats - std::floor(repeats));
}

}  // namespace

struct Composer::Placed {
    // A square of 8 texels.
    struct Tile {
        uint32_t layer = 0;  // or its key
        int kind = 0;        // of materials_
    };
    ComposeJob job;
    shared::ComposeRect rect{};
    std::vector<Tile> tiles;  // row by row
    [[nodiscard]] bool is_second_mip() const { return rect.target.x < 0; }
};

// What the shaders of a batch read: rectangles, and their squares, run after run: of a tier and a kind.
struct Composer::Work {
    gpu::UploadSlice rects, tiles;
    uint32_t tile_count = 0;
    std::array<uint32_t, 2 * kKinds> run_tiles{};
    static size_t run_of(LayerTier tier, int kind) { return size_t(tier) * kKinds + size_t(kind); }
};

// Where a page lies in its index page.
struct Composer::IndexWindow {
    glm::dvec2 origin;  // of its payload, index texels
    double scale = 1;   // index texels across its payload
    double reach = 0;   // of distortion, index texels

    // What a rectangle of the page may look at. One texel more on each side than the filter reads: the
    // shader's floats may fall to the other side of a texel's edge.
    [[nodiscard]] TexelRect seen(const TexelRect& rect) const {
        const auto first = [&](int texel, double from) {
            return std::clamp(int(std::floor(from + (texel - 3.5) / kPagePayload * scale - reach)) - 1, 0,
                              kIndexTexels - 1);
        };
        const auto last = [&](int texel, double from) {
            return std::clamp(int(std::floor(from + (texel - 4.5) / kPagePayload * scale + reach)) + 3, 1,
                              kIndexTexels);
        };
        return {first(rect.x0, origin.x), first(rect.y0, origin.y), last(rect.x1, origin.x),
                last(rect.y1, origin.y)};
    }
};

double far_log2_begin(double distance_m) {
    return std::log2(distance_m / double(kVistaDistance));
}

Composer::Composer(gpu::Device& device, const Document& document, IndexMap& index, LayerSet& layers,
                   const TextureLayout& layout, const PageTextures& textures)
    : device_(device),
      document_(document),
      index_(index),
      layers_(layers),
      layout_(layout),
      textures_(textures) {}

Result<std::unique_ptr<Composer>> Composer::create(gpu::Device& device, const Document& document,
                                                   IndexMap& index, LayerSet& layers,
                                                   const TextureLayout& layout, const PageTextures& textures,
                                                   bool decals) {
    std::unique_ptr<Composer> composer(new Composer(device, document, index, layers, layout, textures));
    auto scratch =
        gpu::Image::create(device, {.name = "page scratch",
                                    .format = VK_FORMAT_R8G8B8A8_UNORM,
                                    .width = kScratchWidth,
                                    .height = kScratchHeight,
                                    .layer_count = uint32_t(textures.scratch_layers),
                                    .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                             VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT});
    if (!scratch.ok()) return scratch.error();
    composer->scratch_ = std::move(*scratch);
    const bool compressed = is_compressed(textures.format);
    if (compressed) {
        const uint64_t blocks = block_count({0, 0, kScratchWidth, kScratchHeight}) * uint64_t(textures.count);
        auto buffer = gpu::Buffer::create(device, {.name = "page blocks",
                                                   .size_bytes = blocks * uint64_t(textures.block_bytes),
                                                   .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT});
        if (!buffer.ok()) return buffer.error();
        composer->blocks_ = std::move(*buffer);
    }
    auto nearest = gpu::Sampler::create(device, {.filter = VK_FILTER_NEAREST});
    if (!nearest.ok()) return nearest.error();
    composer->nearest_ = std::move(*nearest);

    LOAM_TRY(composer->take_settings());
    std::vector<gpu::Binding> bindings{gpu::sampled_image(0), gpu::storage_buffer(2), gpu::storage_buffer(3)};
    if (compressed) bindings.push_back(gpu::storage_buffer(1));
    for (uint32_t i = 0; !compressed && i < kMaxPageTextures; ++i)
        bindings.push_back(gpu::storage_image(kPageTextureSlot + i));
    for (int mip = compressed ? 0 : 1; mip < 2; ++mip) {
        auto encode = gpu::Pipeline::create(
            device, gpu::ComputeDesc{
                        .name = compressed ? "page blocks" : "page mips",
                        .shader = compressed ? "texture/page_blocks.comp" : "texture/mip_rgba8.comp",
                        .bindings = bindings,
                        .push_bytes = sizeof(shared::EncodePush),
                        .constants = {{0, uint32_t(mip)}, {1, textures.count > 3}, {30, textures.layout}}});
        if (!encode.ok()) return encode.error();
        composer->encode_[mip] = std::move(*encode);
    }
    if (decals) {
        composer->decals_.emplace(device, textures);
        LOAM_TRY(composer->decals_->warm_up(document, layers));
    }
    return composer;
}

Result<gpu::Pipeline> Composer::material_pipeline(int kind, bool masks) const {
    const bool one_layer = kind & kOneLayerKind;
    return gpu::Pipeline::create(
        device_,
        gpu::ComputeDesc{.name = one_layer ? "compose, one layer" : "compose",
                         .shader = "texture/compose.comp",
                         .bindings = {gpu::sampled_image(0), gpu::sampled_image(1), gpu::sampled_image(2),
                                      gpu::sampled_image(3), gpu::sampled_image(4), gpu::storage_buffer(5),
                                      gpu::storage_image(6), gpu::storage_buffer(7), gpu::storage_buffer(8),
                                      gpu::sampled_image(9), gpu::sampled_image(10), gpu::sampled_image(11)},
                         .push_bytes = sizeof(shared::ComposePush),
                         .constants = {{0, one_layer},
                                       {1, layers_.has_metal},
                                       {2, layers_.ground.tile_hiding},
                                       {3, bool(layers_.distortion)},
                                       {4, bool(kind & kTransitionKind)},
                                       {5, kind & kFarKind && layers_.ground.has_vista()},
                                       {6, kind & kFarKind && layers_.imagery.is_on()},
                                       {7, masks},
                                       {31, textures_.placement}}});
}

Status Composer::take_settings() {
    const std::array<bool, 5> features{layers_.ground.tile_hiding, bool(layers_.distortion),
                                       layers_.has_transitions, layers_.ground.has_vista(),
                                       layers_.imagery.is_on()};
    if (materials_[0] && features == features_) return {};
    features_ = features;
    for (int kind = 0; kind < int(kKinds); ++kind) {
        materials_[size_t(kind)] = {};
        if ((kind & kTransitionKind) && !layers_.has_transitions) continue;
        if ((kind & kFarKind) && !layers_.changes_afar()) continue;
        auto made = material_pipeline(kind, false);
        if (!made.ok()) return made.error();
        materials_[size_t(kind)] = std::move(*made);
    }
    return {};
}

Status Composer::use_masks(LayerMasks* masks) {
    masks_ = masks;
    if (!masks) return {};
    auto made = material_pipeline(0, true);
    if (!made.ok()) return made.error();
    mask_material_ = std::move(*made);
    return {};
}

shared::LayerPlace Composer::layer_place(double origin_x_m, double origin_y_m, double side_m, double texel_m,
                                         double tile_m, int layer_texels, double vista_scale) {
    const double far_m = tile_m * vista_scale;
    return {.offset = {phase(origin_x_m, tile_m), phase(origin_y_m, tile_m)},
            .scale = float(side_m / tile_m),
            .lod_bias = float(std::log2(texel_m * layer_texels / tile_m)),
            .slot = 0,
            .first = 0,
            .second = 0,
            .threshold = 0,
            .vista_offset = {phase(origin_x_m, far_m), phase(origin_y_m, far_m)},
            .vista_scale = float(side_m / far_m),
            .vista_lod_bias = float(std::log2(texel_m * layer_texels / far_m)),
            .channels = {}};
}

Composer::FarWeights Composer::far_of(const PageId& page) const {
    FarWeights far;
    const float log2_texel = float(std::log2(layout_.texel_m(page)));
    if (layers_.ground.has_vista())
        far.vista = shared::vista_weight(log2_texel, float(far_log2_begin(layers_.ground.vista_distance_m)));
    if (layers_.imagery.is_on())
        far.imagery = float(layers_.imagery.strength) *
                      shared::vista_weight(log2_texel, float(far_log2_begin(layers_.imagery.distance_m)));
    return far;
}

// The texels of the coarser page that lie where the rectangle's second mip does, from the same inputs. None
// where both weigh the magnified lookup and the imagery alike: there the mean is right.
std::optional<ComposeJob> Composer::second_mip(const ComposeJob& job) const {
    const auto page = layers_.changes_afar() ? layout_.coarser(job.page) : std::nullopt;
    if (!page || far_of(*page) == far_of(job.page)) return {};
    const WorldRect own = layout_.square(job.page), square = layout_.square(*page);
    // A mip's border is half the page's.
    const auto first = [&](double from, double to) {
        return kPageBorder / 2 + (to > from ? kPagePayload / 2 : 0);
    };
    const glm::ivec2 at(first(square.min_x, own.min_x), first(square.min_y, own.min_y));
    ComposeJob mip = job;
    mip.page = *page;
    mip.rect = {job.rect.x0 / 2 + at.x, job.rect.y0 / 2 + at.y, job.rect.x1 / 2 + at.x,
                job.rect.y1 / 2 + at.y};
    return mip;
}

Composer::IndexWindow Composer::index_window(const ComposeJob& job) const {
    const VirtualMap& map = index_.map();
    const WorldRect square = layout_.square(job.page), index_square = map.page_rect(job.index_page);
    const double spacing_m = map.spacing_m(job.index_page.level);
    return {.origin = {(square.min_x - index_square.min_x) / spacing_m + kIndexBorder,
                       (square.min_y - index_square.min_y) / spacing_m + kIndexBorder},
            .scale = layout_.page_side_m(job.page) / spacing_m,
            .reach = layers_.ground.distortion_amplitude_m / spacing_m};
}

void Composer::add_needs(const ComposeJob& job, LayerNeeds& needs) const {
    const IndexTexel* texels = index_.resident_page(job.index_page);
    LOAM_CHECK(texels, "a page is composed from a resident index page only");
    const TexelRect seen = index_window(job).seen(job.rect);
    std::vector<bool> met(size_t(layers_.count));
    for (int y = seen.y0; y < seen.y1; ++y)
        for (int x = seen.x0; x < seen.x1; ++x)
            met[std::min(size_t(texels[size_t(y * kIndexTexels + x)].layer), met.size() - 1)] = true;
    const double texel_m = layout_.texel_m(job.page), size = layers_.size_texels;
    const bool vista = far_of(job.page).vista > 0;
    for (uint32_t layer = 0; layer < met.size(); ++layer) {
        if (!met[layer]) continue;
        for (const uint32_t side : layers_.sides_of(layer)) {
            const double scale = vista ? layers_.ground.vista_scale : 1;
            layers_.add_need(side, std::log2(texel_m * size / (layers_.tiles_m[side] * scale)), needs);
        }
    }
    for (const DecalTexture& texture : decal_textures(document_, layers_, layout_, job.page, job.rect))
        layers_.add_need(texture.layer, std::log2(texel_m * size / texture.tile_m), needs);
}

LayerNeeds Composer::needs_of(const ComposeJob& job) const {
    LayerNeeds needs;
    add_needs(job, needs);
    if (const auto mip = second_mip(job)) add_needs(*mip, needs);
    return needs;
}

// Where the page lies in its index page, and what each square of the rectangle holds.
Composer::Placed Composer::prepare(const ComposeJob& job, glm::ivec2 scratch_min) {
    Placed placed{.job = job};
    const IndexWindow window = index_window(job);
    const FarWeights far = far_of(job.page);
    placed.rect = {
        .rect_min = {job.rect.x0, job.rect.y0},
        .rect_size = {job.rect.width(), job.rect.height()},
        .scratch_min = scratch_min,
        .index_origin = glm::vec2(window.origin),
        .index_scale = float(window.scale),
        .index_slot = uint32_t(job.index_slot),
        .index_vertex = glm::ivec2(job.index_page.x, job.index_page.y) * kIndexPayload - kIndexBorder,
        .index_level = job.index_page.level,
        .vista = far.vista,
        .imagery = far.imagery,
        .mip_min = {-1, -1},
        .first_place = 0,
        .last_layer = uint32_t(layers_.count - 1),
        .target = target_of(job),
        .first_block = 0,
        .blocks = block_count(job.rect)};

    const GroundSettings& ground = layers_.ground;
    if (window.reach > 0) {
        const double period_m = ground.distortion_period_m, side_m = layout_.page_side_m(job.page);
        const WorldRect square = layout_.square(job.page);
        placed.rect.distortion_origin = {phase(square.min_x, period_m), phase(square.min_y, period_m)};
        placed.rect.distortion_scale = float(side_m / period_m);
        placed.rect.distortion_reach = float(window.reach);
        placed.rect.distortion_lod =
            float(std::log2(layout_.texel_m(job.page) * kDistortionTexels / period_m));
    }

    const IndexTexel* texels = index_.resident_page(job.index_page);
    LOAM_CHECK(texels, "a page is composed from a resident index page only");
    const auto layer_at = [&](int x, int y) {
        const uint32_t layer =
            std::min<uint32_t>(texels[size_t(y * kIndexTexels + x)].layer, placed.rect.last_layer);
        const glm::ivec2 vertex = placed.rect.index_vertex + glm::ivec2(x, y);
        return ground.tile_hiding ? shared::tile_key(layer, vertex.x, vertex.y, placed.rect.index_level)
                                  : layer;
    };
    const auto tile_of = [&](const TexelRect& range) {
        const uint32_t layer = layer_at(range.x0, range.y0);
        bool one_layer = true, transitions = false;
        for (int y = range.y0; y < range.y1 && (one_layer || layers_.has_transitions); ++y)
            for (int x = range.x0; x < range.x1; ++x) {
                const uint32_t other = layer_at(x, y);
                one_layer &= other == layer;
                transitions |= layers_.is_transition(ground.tile_hiding ? other >> kKeyLayerShift : other);
            }
        return Placed::Tile{layer, (one_layer ? kOneLayerKind : 0) | (transitions ? kTransitionKind : 0) |
                                       (far == FarWeights{} ? 0 : kFarKind)};
    };
    const glm::ivec2 size = placed.rect.rect_size / kTileTexels;
    const Placed::Tile whole = tile_of(window.seen(job.rect));
    placed.tiles.assign(size_t(size.x) * size_t(size.y), whole);
    if (whole.kind & kOneLayerKind) return placed;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const int x0 = job.rect.x0 + x * kTileTexels, y0 = job.rect.y0 + y * kTileTexels;
            placed.tiles[size_t(y) * size_t(size.x) + size_t(x)] =
                tile_of(window.seen({x0, y0, x0 + kTileTexels, y0 + kTileTexels}));
        }
    return placed;
}

Status Composer::cmd_compose(gpu::FrameRing& ring, gpu::Commands& commands, std::span<const ComposeJob> jobs,
                             PageAtlas& atlas) {
    std::vector<Placed> batch;
    glm::ivec2 at(0);
    int shelf_height = 0;
    const int step = layers_.rect_texels();
    for (const ComposeJob& job : jobs) {
        LOAM_CHECK(!masks_ || masks_->index_page == job.index_page, "masks are of one index page");
        const std::optional<ComposeJob> mip = second_mip(job);
        // Side by side, the second mip on the right.
        const int own_width = job.rect.width(), height = job.rect.height();
        const int width = own_width + (mip ? own_width / 2 : 0);
        LOAM_CHECK(own_width > 0 && height > 0 && own_width % step == 0 && height % step == 0 &&
                       job.rect.x0 % step == 0 && job.rect.y0 % step == 0,
                   "a page rectangle is aligned to the blocks of both mips");
        if (at.x + width > kScratchWidth) at = {0, at.y + shelf_height}, shelf_height = 0;
        if (at.y + height > kScratchHeight) {
            LOAM_TRY(cmd_batch(ring, commands, batch, atlas));
            batch.clear();
            at = {0, 0};
            shelf_height = 0;
        }
        batch.push_back(prepare(job, at));
        if (mip) {
            batch.back().rect.mip_min = {at.x + own_width, at.y};
            batch.push_back(prepare(*mip, {at.x + own_width, at.y}));
            batch.back().rect.target = {-1, -1};
        }
        at.x += width;
        shelf_height = std::max(shelf_height, height);
    }
    if (!batch.empty()) LOAM_TRY(cmd_batch(ring, commands, batch, atlas));
    return {};
}

Status Composer::cmd_batch(gpu::FrameRing& ring, gpu::Commands& commands, std::vector<Placed>& batch,
                           PageAtlas& atlas) {
    const Work work = upload(ring, batch);
    cmd_materials(ring, commands, batch, work);
    if (decals_) LOAM_TRY(cmd_decals(ring, commands, batch));
    if (is_compressed(textures_.format)) {
        cmd_encode_blocks(commands, work);
        cmd_copy_blocks(commands, batch, atlas);
    } else {
        cmd_copy_texels(commands, batch, atlas);
        cmd_write_mips(commands, work, atlas);
    }
    return {};
}

// Fills in where each rectangle's places and output begin.
Composer::Work Composer::upload(gpu::FrameRing& ring, std::span<Placed> batch) {
    Work work;
    uint32_t blocks = 0;
    for (size_t i = 0; i < batch.size(); ++i) {
        shared::ComposeRect& rect = batch[i].rect;
        rect.first_place = uint32_t(i * size_t(layers_.count));
        rect.first_block = blocks;
        if (!batch[i].is_second_mip()) blocks += rect.blocks * uint32_t(textures_.count);
        work.tile_count += uint32_t(batch[i].tiles.size());
        for (const Placed::Tile& tile : batch[i].tiles)
            ++work.run_tiles[Work::run_of(batch[i].job.tier, tile.kind)];
    }
    work.rects = ring.upload(batch.size() * sizeof(shared::ComposeRect));
    work.tiles = ring.upload(work.tile_count * sizeof(shared::ComposeTile));
    auto* rects = work.rects.as<shared::ComposeRect>();
    for (size_t i = 0; i < batch.size(); ++i) rects[i] = batch[i].rect;
    std::array<shared::ComposeTile*, 2 * kKinds> next{};
    auto* tiles = work.tiles.as<shared::ComposeTile>();
    for (size_t run = 0; run < next.size(); tiles += work.run_tiles[run++]) next[run] = tiles;
    for (size_t i = 0; i < batch.size(); ++i) {
        const glm::ivec2 size = batch[i].rect.rect_size / kTileTexels;
        const Placed::Tile* tile = batch[i].tiles.data();
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x, ++tile)
                *next[Work::run_of(batch[i].job.tier, tile->kind)]++ = {
                    shared::compose_tile_place(uint32_t(i), uint32_t(x), uint32_t(y)), tile->layer};
    }
    return work;
}

void Composer::cmd_materials(gpu::FrameRing& ring, gpu::Commands& commands, std::span<const Placed> batch,
                             const Work& work) {
    const size_t layer_count = size_t(layers_.count);
    const gpu::UploadSlice places = ring.upload(batch.size() * layer_count * sizeof(shared::LayerPlace));
    auto* out = places.as<shared::LayerPlace>();
    for (const Placed& placed : batch) {
        const PageId& page = placed.job.page;
        const WorldRect square = layout_.square(page);
        for (size_t layer = 0; layer < layer_count; ++layer, ++out) {
            *out = layer_place(square.min_x, square.min_y, layout_.page_side_m(page), layout_.texel_m(page),
                               layers_.tiles_m[layer], layers_.size_texels, layers_.ground.vista_scale);
            layers_.fill_place(int(layer), placed.job.tier, *out);
        }
    }
    gpu::Image& masks = masks_ ? masks_->pages : index_.tints();
    for (const LayerTier tier : {LayerTier::whole, LayerTier::tail}) {
        LayerArrays& arrays = layers_.arrays(tier);
        commands.use({{arrays.albedo_reveal, Access::compute_sampled},
                      {arrays.normal_gloss_occlusion, Access::compute_sampled},
                      {arrays.metalness, Access::compute_sampled}});
    }
    auto pass = commands.pass("texture compose", {{scratch_, Access::compute_storage},
                                                  {index_.indices(), Access::compute_sampled},
                                                  {index_.tints(), Access::compute_sampled},
                                                  {index_.imagery(), Access::compute_sampled},
                                                  {layers_.distortion_map(), Access::compute_sampled},
                                                  {masks, Access::compute_sampled}});
    uint32_t first_tile = 0;
    for (size_t run = 0; run < work.run_tiles.size(); first_tile += work.run_tiles[run++]) {
        const uint32_t tiles = work.run_tiles[run];
        if (tiles == 0) continue;
        const gpu::Pipeline& pipeline = masks_ ? mask_material_ : materials_[run % kKinds];
        const LayerArrays& arrays = layers_.arrays(LayerTier(run / kKinds));
        commands.bind(pipeline, {{0, arrays.albedo_reveal.view(), layers_.sampler},
                                 {1, arrays.normal_gloss_occlusion.view(), layers_.sampler},
                                 {2, arrays.metalness.view(), layers_.sampler},
                                 {3, index_.indices().view(), nearest_},
                                 {4, index_.tints().view(), nearest_},
                                 {5, *places.buffer, places.offset, places.size_bytes},
                                 {6, scratch_.mip_view(0)},
                                 {7, *work.rects.buffer, work.rects.offset, work.rects.size_bytes},
                                 {8, *work.tiles.buffer, work.tiles.offset, work.tiles.size_bytes},
                                 {9, layers_.distortion_map().view(), layers_.sampler},
                                 {10, index_.imagery().view(), nearest_},
                                 {11, masks.view(), nearest_}});
        commands.push(pipeline, shared::ComposePush{first_tile});
        commands.dispatch(tiles);
    }
}

Status Composer::cmd_decals(gpu::FrameRing& ring, gpu::Commands& commands, std::span<const Placed> batch) {
    DecalList list;
    glm::ivec2 used(0);
    {
        const auto lock = document_.read_lock();
        for (const Placed& placed : batch) {
            add_decals(document_, layers_, placed.job.tier, layout_, placed.job.page, placed.job.rect,
                       placed.rect.scratch_min, list);
            used = glm::max(used, placed.rect.scratch_min + placed.rect.rect_size);
        }
    }
    return decals_->cmd_record(ring, commands, document_, list, layers_, scratch_,
                               {uint32_t(used.x), uint32_t(used.y)});
}

void Composer::cmd_encode_blocks(gpu::Commands& commands, const Work& work) {
    auto pass = commands.pass("texture encode",
                              {{scratch_, Access::compute_sampled}, {blocks_, Access::compute_storage}});
    shared::EncodePush push{.tile_count = work.tile_count, .weights = {}};
    std::copy_n(textures_.layout == kPagePairs ? kPairWeights : kRowWeights, kMaxPageTextures, push.weights);
    for (int mip = 0; mip < 2; ++mip) {
        commands.bind(encode_[mip], {{0, scratch_.view(), nearest_},
                                     {1, blocks_},
                                     {2, *work.rects.buffer, work.rects.offset, work.rects.size_bytes},
                                     {3, *work.tiles.buffer, work.tiles.offset, work.tiles.size_bytes}});
        commands.push(encode_[mip], push);
        // Threads a group and blocks a tile, as the shader has them.
        const uint32_t threads = 8, blocks = mip == 0 ? 4 : 1;
        commands.dispatch((work.tile_count * blocks + threads - 1) / threads, uint32_t(textures_.count));
    }
}

void Composer::cmd_copy_blocks(gpu::Commands& commands, std::span<const Placed> batch, PageAtlas& atlas) {
    std::vector<gpu::Use> uses = {{blocks_, Access::copy_source}};
    for (gpu::Image& image : atlas) uses.emplace_back(image, Access::copy_target);
    auto pass = commands.pass("texture copy", uses);
    std::vector<VkBufferImageCopy> copies;
    for (uint32_t which = 0; which < uint32_t(textures_.count); ++which) {
        copies.clear();
        for (const Placed& placed : batch) {
            if (placed.is_second_mip()) continue;
            const TexelRect& rect = placed.job.rect;
            const glm::ivec2 at = placed.rect.target;
            uint64_t block = placed.rect.first_block + uint64_t(which) * placed.rect.blocks;
            for (int mip = 0; mip < 2; ++mip) {
                copies.push_back(
                    {.bufferOffset = block * uint64_t(textures_.block_bytes),
                     .bufferRowLength = 0,
                     .bufferImageHeight = 0,
                     .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, uint32_t(mip), 0, 1},
                     .imageOffset = {at.x >> mip, at.y >> mip, 0},
                     .imageExtent = {uint32_t(rect.width()) >> mip, uint32_t(rect.height()) >> mip, 1}});
                const glm::ivec2 size = blocks_across(rect, mip);
                block += uint64_t(size.x) * uint64_t(size.y);
            }
        }
        vkCmdCopyBufferToImage(commands.handle(), blocks_.handle(), atlas[which].handle(),
                               VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, uint32_t(copies.size()), copies.data());
    }
}

void Composer::cmd_copy_texels(gpu::Commands& commands, std::span<const Placed> batch, PageAtlas& atlas) {
    std::vector<gpu::Use> uses = {{scratch_, Access::copy_source}};
    for (gpu::Image& image : atlas) uses.emplace_back(image, Access::copy_target);
    auto pass = commands.pass("texture copy", uses);
    std::vector<VkImageCopy> copies;
    for (uint32_t which = 0; which < uint32_t(textures_.count); ++which) {
        copies.clear();
        for (const Placed& placed : batch) {
            if (placed.is_second_mip()) continue;
            const glm::ivec2 from = placed.rect.scratch_min, to = placed.rect.target;
            const glm::uvec2 size(placed.rect.rect_size);
            copies.push_back({.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, which, 1},
                              .srcOffset = {from.x, from.y, 0},
                              .dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                              .dstOffset = {to.x, to.y, 0},
                              .extent = {size.x, size.y, 1}});
        }
        vkCmdCopyImage(commands.handle(), scratch_.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                       atlas[which].handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, uint32_t(copies.size()),
                       copies.data());
    }
}

void Composer::cmd_write_mips(gpu::Commands& commands, const Work& work, PageAtlas& atlas) {
    std::vector<gpu::Use> uses = {{scratch_, Access::compute_sampled}};
    for (gpu::Image& image : atlas) uses.emplace_back(image, Access::compute_storage);
    auto pass = commands.pass("texture encode", uses);
    const gpu::Pipeline& pipeline = encode_[1];
    std::vector<gpu::Bound> bound{{0, scratch_.view(), nearest_},
                                  {2, *work.rects.buffer, work.rects.offset, work.rects.size_bytes},
                                  {3, *work.tiles.buffer, work.tiles.offset, work.tiles.size_bytes}};
    for (size_t i = 0; i < kMaxPageTextures; ++i)
        bound.emplace_back(kPageTextureSlot + uint32_t(i), atlas[std::min(i, atlas.size() - 1)].mip_view(1));
    commands.bind(pipeline, bound);
    commands.push(pipeline, shared::EncodePush{.tile_count = work.tile_count, .weights = {}});
    const uint32_t threads = 64, texels = 16;  // a group's, and a tile's of mip 1
    commands.dispatch((work.tile_count * texels + threads - 1) / threads);
}

uint64_t Composer::gpu_bytes() const {
    return scratch_.bytes() + (blocks_ ? blocks_.size_bytes() : 0);
}

}  // namespace loam
